#!/usr/bin/env python3
"""hermes-vector.exe, cross-compiled by MinGW-w64 (docs/windows.md), under Wine: every command gives what the program of this system
gives, and what differs on Windows does no harm. Needs MinGW-w64 with its zlib, and wine64; skipped without."""
import glob
import gzip
import math
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = os.environ["HERMES_SOURCE"]
NATIVE = os.path.join(os.environ["HERMES_BIN"], "hermes-vector")
BUILD = os.path.join(SOURCE, "build", "windows")
EXE = os.path.join(BUILD, "bin", "hermes-vector.exe")
DATA = os.path.join(SOURCE, "tests", "data", "vector")
LOGS = os.environ.get("HERMES_DATA", os.path.join(SOURCE, "..", "shared", "data", "public"))
WINE = shutil.which("wine64") or shutil.which("wine64", path="/usr/lib/wine")
SKIPPED = 77
TOLERANCE = 1e-9
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
# Times that a run took.
TIMES = re.compile(r'"(ms|ms_per_scan|seconds|closures_seconds)": (\{[^}]*\}|[-\d.e]+)')
ENVIRONMENT = dict(os.environ, WINEDEBUG="-all", WINEPREFIX=os.path.join(BUILD, "wine"), WINEDLLOVERRIDES="mscoree,mshtml=", DISPLAY="",
                   PATH="/usr/lib/wine")


def missing():
    found = {"x86_64-w64-mingw32-g++-posix": shutil.which("x86_64-w64-mingw32-g++-posix"), "wine64": WINE,
             "zlib of MinGW-w64": os.path.exists("/usr/x86_64-w64-mingw32/lib/libz.a")}
    return [name for name, is_here in found.items() if not is_here]


def build():
    for command in (["cmake", "--preset", "windows"], ["cmake", "--build", "--preset", "windows"]):
        done = subprocess.run(command, cwd=SOURCE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit(done.stdout[-4000:])


class Run:
    """What a program left: status, what it said, and the files of its folder."""

    def __init__(self, program, folder, arguments, stdin=b"", environment=None):
        done = subprocess.run(program + arguments, cwd=folder, input=stdin, env=dict(ENVIRONMENT, **(environment or {})),
                              capture_output=True, timeout=600)
        self.status, self.out, self.err = done.returncode, done.stdout, done.stderr
        self.files = {}
        for place, _, names in os.walk(folder):
            for name in names:
                path = os.path.join(place, name)
                with open(path, "rb") as file:
                    self.files[os.path.relpath(path, folder)] = file.read()


def native(folder, *arguments, stdin=b""):
    return Run([NATIVE], folder, list(arguments), stdin)


def windows(folder, *arguments, stdin=b"", environment=None):
    return Run([WINE, EXE], folder, list(arguments), stdin, environment)


def difference(expected, found, tolerance=TOLERANCE):
    """Where two texts differ by more than the rounding of their numbers; nothing: they do not."""
    if expected == found:
        return None
    left, right = (TIMES.sub("", text.decode()) for text in (expected, found))
    if NUMBER.sub("#", left) != NUMBER.sub("#", right):
        for number, (one, other) in enumerate(zip(left.splitlines() + [""], right.splitlines() + [""]), 1):
            if NUMBER.sub("#", one) != NUMBER.sub("#", other):
                return f"line {number}: {one[:200]!r}, {other[:200]!r}"
    for one, other in zip(NUMBER.findall(left), NUMBER.findall(right)):
        if not math.isclose(float(one), float(other), rel_tol=tolerance, abs_tol=tolerance):
            return f"{one}, {other}"
    return None


def write(path, content):
    with open(path, "wb") as file:
        file.write(content)


def capture(turns):
    """A pcap of an HDL-32E in the middle of a round room."""
    records = b""
    for number in range(turns * 180):
        blocks = b""
        for block in range(12):
            azimuth = (number * 12 + block) * 36000 // 2160 % 36000
            reach = int((5 + math.cos(math.radians(azimuth / 50))) / 0.002)
            blocks += struct.pack("<HH", 0xEEFF, azimuth) + struct.pack("<HB", reach, 100) * 32
        data = blocks + struct.pack("<IBB", number * 553, 0x37, 0x21)
        udp = struct.pack(">HHHH", 2368, 2368, 8 + len(data), 0) + data
        ip = struct.pack(">BBHHHBBH4s4s", 0x45, 0, 20 + len(udp), 0, 0x4000, 64, 17, 0, bytes([192, 168, 1, 201]), b"\xff" * 4) + udp
        frame = b"\xff" * 6 + b"\x02" * 6 + b"\x08\x00" + ip
        records += struct.pack("<IIII", 1700000000 + number // 1808, number % 1808 * 553, len(frame), len(frame)) + frame
    return struct.pack("<IHHIIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 1) + records


class Commands(unittest.TestCase):
    """Each command, with the same inputs as here."""

    def same(self, *arguments, stdin=b"", status=0, prepare=(), tolerance=TOLERANCE, has_times=False, has_plots=False):
        """Runs both in folders of their own; gives what the program for Windows left. has_times: its tables are of nothing else.
        has_plots: they are drawn here, if at all."""
        runs = []
        for run in (native, windows):
            with tempfile.TemporaryDirectory() as folder:
                for file in os.listdir(DATA):
                    shutil.copy(os.path.join(DATA, file), folder)
                write(os.path.join(folder, "drive.pcap"), capture(3))
                for before in prepare:
                    self.assertEqual(native(folder, *before).status, 0, before)
                runs.append(run(folder, *arguments, stdin=stdin))
        here, there = runs
        self.assertEqual((here.status, there.status), (status, status), (arguments, here.err, there.err))
        if has_plots:
            self.assertIn(b"the plots are not drawn", there.err)
            here.err = there.err = b""
            here.files = {name: content for name, content in here.files.items() if name[:-3] + "pdf" not in here.files}
        self.assertEqual(set(here.files), set(there.files), arguments)
        for what, one, other in [("stdout", here.out, there.out), ("stderr", here.err, there.err)] + \
                [(name, here.files[name], there.files[name]) for name in here.files]:
            if what == "drive.pcap" or (has_times and what.endswith((".csv", ".tex"))):
                continue
            self.assertNotIn(b"\r", other, (arguments, what))
            self.assertIsNone(difference(one, other.replace(b"\\", b"/") if what == "stderr" else other, tolerance), (arguments, what))
        return there

    def test_segment(self):
        self.same("segment", "room.csv", "--svg", "room.svg", "--out", "clusters.csv")

    def test_vectorize(self):
        for algorithm in ("tls", "ftls", "aftls", "inc", "dp", "rw", "sam"):
            self.same("vectorize", "room.csv", "--algorithm", algorithm, "--svg", "room.svg")
        self.same("vectorize", "room.csv", "--polyline")

    def test_register_and_similarity(self):
        self.same("register", "pairs.csv", "--weights", "length")
        self.same("register", "pairs.csv", "--rotation", "wahba", "--weights", "column")
        self.same("similarity", "pairs.csv", "--pose", "0,0,0", "--pose", "1,-2,0.3")

    def scans(self):
        return [("observe", "world.json", "--pose", "0,0,0", "--scan", "720", "--noise", "0.01", "--out", "first.csv"),
                ("observe", "world.json", "--pose", "0.3,0.2,0.1", "--scan", "720", "--noise", "0.01", "--seed", "2", "--out", "second.csv")]

    def test_match_and_relocalize(self):
        prepare = self.scans() + [("map", "corrected.log", "--out-map", "map.csv", "--out", "summary.json")]
        self.same("match", "first.csv", "second.csv", "--svg", "match.svg", prepare=prepare)
        self.same("match", "first.csv", "second.csv", "--expected", "0.25,0.2,0.1", prepare=prepare)
        for method in ("finder", "relations"):
            self.same("match", "first.csv", "second.csv", "--method", method, prepare=prepare)
        self.same("relocalize", "map.csv", "first.csv", "--svg", "place.svg", prepare=prepare)

    def test_observe(self):
        self.same("observe", "world.json", "--pose", "0.5,0.5,1", "--svg", "view.svg")
        self.same("observe", "world.json", "--pose", "0.5,0.5,1", "--scan", "360", "--noise", "0.02", "--outliers", "0.1")

    def test_ring(self):
        self.same("ring", "drive.pcap", "--turn", "1")
        self.same("ring", "drive.pcap", "--all", "--out", "points.csv")
        self.same("ring", "room.csv", status=1)

    def test_map(self):
        for end in ("csv", "svg", "geojson", "dxf", "pgm"):
            self.same("map", "raw.log", "--out-map", f"map.{end}", "--out-trajectory", "way.tum", "--out-trust", "trust.csv")
        self.same("map", "corrected.log", "--corrected", "--loops", "close", "--out-graph", "way.g2o")
        self.same("map", "drive.pcap", "--out-map", "map.csv")
        self.same("map", "raw.log", "--scan", "3", "--out", "scan.csv")

    def test_map_of_a_folder_and_two_maps(self):
        prepare = []
        for i in range(8):
            prepare.append(("observe", "world.json", "--pose", f"{0.1 * i},{0.05 * i},{0.02 * i}", "--scan", "720", "--noise", "0.01",
                            "--seed", str(i + 1), "--out", f"drive/{i}.csv"))
        with tempfile.TemporaryDirectory() as made:
            os.mkdir(os.path.join(made, "drive"))
            for file in ("world.json", "corrected.log"):
                shutil.copy(os.path.join(DATA, file), made)
            for before in prepare + [("map", "corrected.log", "--out-map", "a.csv", "--out", "a.json"),
                                     ("map", "drive", "--out-map", "b.csv", "--out", "b.json")]:
                self.assertEqual(native(made, *before).status, 0, before)
            for arguments in (["map", "drive", "--out-map", "map.csv", "--out-trajectory", "way.tum"],
                              ["map-merge", "a.csv", "b.csv", "--out", "both.csv", "--at", "0,0,0"],
                              ["map", "corrected.log", "--localize", "a.csv", "--out-trajectory", "found.tum"]):
                runs = []
                for run in (native, windows):
                    with tempfile.TemporaryDirectory() as folder:
                        shutil.copytree(made, folder, dirs_exist_ok=True)
                        runs.append(run(folder, *arguments))
                here, there = runs
                self.assertEqual(here.status, there.status, (arguments, here.err, there.err))
                self.assertEqual(set(here.files), set(there.files), arguments)
                for name in here.files:
                    self.assertIsNone(difference(here.files[name], there.files[name]), (arguments, name))
                self.assertIsNone(difference(here.out, there.out), arguments)

    def test_evaluate(self):
        self.same("evaluate", "corrected.log", "way.tum", "--svg", "errors.svg",
                  prepare=[("map", "corrected.log", "--out-trajectory", "way.tum", "--out", "summary.json")])

    def test_report(self):
        for kind in ("json", "csv", "svg", "latex"):
            self.same("report", "pillars", "--case", "0", "--format", kind)
        self.same("report", "oblique", "--overall", "--format", "csv")

    def test_experiments(self):
        self.same("experiment", "segmentation-room", "--out", "results")
        for name in ("weighting", "reliability"):
            self.same("experiment", name, "--runs", "2", "--max-points", "500", "--out", "results", has_plots=True)
        # Its ratios of tiny spreads make more of how the C libraries round.
        self.same("experiment", "dispersion", "--runs", "2", "--max-points", "500", "--out", "results", tolerance=1e-6, has_plots=True)
        self.same("experiment", "empty-room", "--log", "raw.log", "--out", "results", has_times=True)

    def test_real_log(self):
        logs = glob.glob(os.path.join(LOGS, "fhw*.log.gz"))
        if not logs:
            self.skipTest("the logs of real robots are not here; HERMES_DATA names their folder")
        self.same("map", logs[0], "--out-map", "map.csv", "--out-trajectory", "way.tum", "--every", "4")


class Differences(unittest.TestCase):
    """What Windows does otherwise."""

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = self.temporary.name
        for file in os.listdir(DATA):
            shutil.copy(os.path.join(DATA, file), self.folder)
        with open(os.path.join(DATA, "room.csv"), "rb") as file:
            self.room = file.read()
        self.clusters = native(self.folder, "segment", "room.csv").out

    def tearDown(self):
        self.temporary.cleanup()

    def path(self, name):
        return os.path.join(self.folder, name)

    def segments(self, *arguments, stdin=b""):
        run = windows(self.folder, "segment", *arguments, stdin=stdin)
        self.assertEqual((run.status, run.err, run.out), (0, b"", self.clusters), arguments)

    def test_lines_end_by_either_convention(self):
        write(self.path("dos.csv"), self.room.replace(b"\n", b"\r\n"))
        self.segments("dos.csv")
        with open(self.path("raw.log"), "rb") as log:
            write(self.path("dos.log"), log.read().replace(b"\n", b"\r\n"))
        expected = native(self.folder, "map", "raw.log").out
        self.assertIsNone(difference(expected, windows(self.folder, "map", "dos.log").out))

    def test_standard_input_is_bytes(self):
        self.segments("-", stdin=self.room)
        for level in range(10): # some of them have 0x1A, 0x0D and 0x0A within
            self.segments("-", stdin=gzip.compress(self.room, level))

    def test_compressed_files(self):
        packed = gzip.compress(self.room)
        write(self.path("room.csv.gz"), packed)
        self.segments("room.csv.gz")
        write(self.path("cut.csv.gz"), packed[:-20])
        cut = windows(self.folder, "segment", "cut.csv.gz")
        self.assertEqual((cut.status, cut.out), (1, b""))
        self.assertIn(b"breaks off", cut.err)
        whole = capture(3)
        write(self.path("a.pcap"), whole)
        write(self.path("b.pcap.gz"), gzip.compress(whole))
        self.assertIsNone(difference(native(self.folder, "ring", "a.pcap").out, windows(self.folder, "ring", "b.pcap.gz").out))

    def test_names(self):
        drive = "Z:" + self.folder.replace("/", "\\")
        os.mkdir(self.path("two words"))
        names = ["two words/room.csv", "two words\\room.csv", ".\\two words\\..\\two words\\room.csv", drive + "\\room.csv",
                 "Z:" + self.folder + "/room.csv", "za\u017c\u00f3\u0142\u0107 \u90e8\u5c4b \U0001f916.csv"]
        for name in names[:2] + names[5:]:
            write(self.path(name.replace("\\", "/")), self.room)
        for name in names:
            self.segments(name)
        for name in ("two words\\\u00fc \u90e8.csv", drive + "\\out \u017c.csv", "plain.csv"):
            run = windows(self.folder, "segment", "room.csv", "--out", name)
            self.assertEqual((run.status, run.err), (0, b""), name)
            local = name.replace(drive + "\\", "").replace("\\", "/")
            self.assertEqual(run.files.get(local), self.clusters, (name, sorted(run.files)))
        absent = windows(self.folder, "segment", "\u90e8 absent.csv")
        self.assertEqual(absent.status, 1)
        self.assertIn("\u90e8 absent.csv: cannot be opened: No such file or directory".encode(), absent.err)

    def test_folders_are_made(self):
        run = windows(self.folder, "experiment", "weighting", "--runs", "1", "--out", "new \u90e8\\deep")
        self.assertEqual(run.status, 0, run.err)
        self.assertIn("new \u90e8/deep/weighting.csv", run.files)
        drive = "Z:" + self.folder.replace("/", "\\") + "\\other"
        self.assertEqual(windows(self.folder, "experiment", "weighting", "--runs", "1", "--out", drive).status, 0)
        refused = windows(self.folder, "experiment", "weighting", "--runs", "1", "--out", "room.csv\\deep")
        self.assertEqual(refused.status, 1)
        self.assertIn(b"cannot be made", refused.err)

    def test_files_are_replaced_only_by_force(self):
        write(self.path("out.csv"), b"precious")
        refused = windows(self.folder, "segment", "room.csv", "--out", "out.csv")
        self.assertEqual((refused.status, refused.files["out.csv"]), (1, b"precious"))
        self.assertIn(b"exists already", refused.err)
        done = windows(self.folder, "segment", "room.csv", "--out", "out.csv", "--force")
        self.assertEqual((done.status, done.err, done.files["out.csv"]), (0, b"", self.clusters))

    def test_what_fails_leaves_nothing(self):
        before = set(os.listdir(self.folder))
        for arguments in (["segment", "raw.log", "--out", "out.csv"], ["segment", "room.csv", "--out", "absent\\out.csv"],
                          ["map", "raw.log", "--out-map", "a.csv", "--out-trajectory", "absent/way.tum"],
                          ["segment", "room.csv", "--out", "."], ["map", "raw.log", "--out-map", "a.csv", "--out-trajectory", "A.CSV"]):
            run = windows(self.folder, *arguments)
            self.assertEqual(run.status, 1, (arguments, run.err))
            self.assertNotEqual(run.err, b"")
            self.assertEqual(set(os.listdir(self.folder)), before, (arguments, run.err))

    def test_a_killed_program_leaves_nothing(self):
        before = set(os.listdir(self.folder))
        child = subprocess.Popen([WINE, EXE, "segment", "-", "--out", "out.csv", "--svg", "out.svg"], cwd=self.folder,
                                 env=ENVIRONMENT, stdin=subprocess.PIPE, stderr=subprocess.DEVNULL)
        child.stdin.write(self.room)
        child.stdin.flush()
        deadline = time.monotonic() + 60
        while not glob.glob(self.path("out.csv.part-*")) and time.monotonic() < deadline: # then it waits for the rest
            time.sleep(0.05)
        self.assertNotEqual(glob.glob(self.path("out.csv.part-*")), [], "nothing was begun")
        child.send_signal(signal.SIGKILL)
        child.wait()
        child.stdin.close()
        deadline = time.monotonic() + 30
        while set(os.listdir(self.folder)) != before and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertEqual(set(os.listdir(self.folder)), before)

    def test_devices(self):
        before = set(os.listdir(self.folder))
        for name in ("NUL", "nul.csv", "NUL.tar.gz", "NUL .csv", "NUL "):
            run = windows(self.folder, "segment", "room.csv", "--out", name)
            self.assertEqual((run.status, run.out, run.err), (0, b"", b""), name)
        windows(self.folder, "segment", "room.csv", "--out", "CONOUT$") # there may be no console
        self.assertEqual(set(os.listdir(self.folder)), before)
        run = windows(self.folder, "segment", "room.csv", "--out", "NULL.csv")
        self.assertEqual(run.files["NULL.csv"], self.clusters)

    def test_other_programs_are_beside_it_or_in_the_search_path(self):
        """A program in the current folder may be anybody's."""
        write(self.path("words.c"), b"""#include <stdio.h>
            int main(int count, char **words) { for (int i = 1; i < count; ++i) printf("%s|", words[i]); return 3; }""")
        for folder in ("alone", "two words"):
            os.mkdir(self.path(folder))
        shutil.copy(EXE, self.path("alone"))
        subprocess.run(["x86_64-w64-mingw32-gcc", "-o", self.path("hermes-experiments.exe"), self.path("words.c")], check=True)
        program, arguments = [WINE, self.path("alone/hermes-vector.exe")], ["report", 'a "b" c', "two words\\"]
        for path in (".", ""):
            run = Run(program, self.folder, arguments, environment={"WINEPATH": path})
            self.assertEqual(run.status, 1, run.out)
            self.assertIn(b"hermes-experiments, which is not installed", run.err)
        os.rename(self.path("hermes-experiments.exe"), self.path("two words/hermes-experiments.exe"))
        run = Run(program, self.folder, arguments, environment={"WINEPATH": "Z:" + self.path("two words").replace("/", "\\")})
        self.assertEqual((run.status, run.out, run.err), (3, b'report|a "b" c|two words\\|', b""))

    def test_help_and_wrong_use(self):
        for arguments in (["--help"], ["--version"], ["match", "--help"], [], ["nothing"], ["segment"], ["segment", "a", "--k", "x"]):
            here, there = native(self.folder, *arguments), windows(self.folder, *arguments)
            self.assertEqual((there.status, there.out, there.err), (here.status, here.out, here.err), arguments)

    def test_needs_no_library_of_its_own(self):
        shown = subprocess.run(["x86_64-w64-mingw32-objdump", "-p", EXE], capture_output=True, text=True, check=True).stdout
        libraries = {name.lower() for name in re.findall(r"DLL Name: (\S+)", shown)}
        self.assertLessEqual(libraries, {"kernel32.dll", "msvcrt.dll", "shell32.dll", "ws2_32.dll", "advapi32.dll", "user32.dll"})


if __name__ == "__main__":
    if absent := missing():
        print(f"skipped: {', '.join(absent)} not here; Debian has g++-mingw-w64-x86-64-posix, libz-mingw-w64-dev and wine64")
        sys.exit(SKIPPED)
    build()
    os.makedirs(ENVIRONMENT["WINEPREFIX"], exist_ok=True)
    subprocess.run([WINE, EXE, "--version"], env=ENVIRONMENT, capture_output=True, timeout=600, check=True) # makes Wine's folders
    unittest.main(verbosity=2)
