#!/usr/bin/env python3
"""All loggers of a robot record as one session and play it back, by hermesctl: all or none begins, the end is checked, what is
played is what was recorded, together in time."""
import json
import os
import shutil
import pty
import signal
import socket
import statistics
import subprocess
import tempfile
import threading
import time
import unittest

import recording_load as load
from lateness import Lateness
from support import SOURCE, Daemon, Process, free_port, wait_for, text_of

CTL = os.path.join(load.BINARIES, "hermesctl")
PACKETS_HZ, SECONDS = 1810, 1


class Serial:
    """hermes-seriallogger with one UDP source `gps`."""

    def __init__(self, folder, records):
        self.source = free_port(0, socket.SOCK_DGRAM)
        self.sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)  # one, as a device has: others are not read beside it
        ports = [{"name": "gps", "url": f"udp://127.0.0.1:{self.source}", "view": "nmea", "checksum": "lenient"}]
        self.process = Process(load.BINARIES, "seriallogger", free_port(0), folder,
                               {"ports": json.dumps(ports), "record.folder": records, "record.free_floor_bytes": 0,
                                "record.free_warn_bytes": 0})
        self.daemon = self.process.connect()
        wait_for("the port", lambda: self.daemon.call("ports.list")[0]["state"] == "open")

    def send(self, text):
        before = self.daemon.call("ports.list")[0]["bytes"]
        self.sender.sendto(text, ("127.0.0.1", self.source))
        wait_for("the bytes", lambda: self.daemon.call("ports.list")[0]["bytes"] == before + len(text))


# A logger whose record.start takes long.
LATE_LOGGER = """
import sys, time
sys.path.insert(0, sys.argv.pop(1))
from hermes_daemon import Daemon
late = Daemon("late", "Late", {"period_s": {"type": "number", "default": 0.1}}, {})
state = {"recording": False, "folder": "/late"}

def put(recording, seconds=0):
    time.sleep(seconds)
    state["recording"] = recording
    return state

late.method("record.status", "Status")(lambda: state)
late.method("record.list", "List")(lambda: [])
late.method("record.stop", "Stop")(lambda: put(False))
text = {"type": "string"}
late.methods["record.start"] = ("Start", {"name": text, "session": text}, lambda name, session: put(True, 8))
late.run(lambda: None, 0)
"""


class Reader(threading.Thread):
    """Everything that a topic says, with the time at which it came; understood when it is taken, which takes longer."""

    def __init__(self, port, topic):
        super().__init__(daemon=True)
        self.connection = Daemon(port=port, timeout=None)
        self.came = []
        self.connection.subscribe(topic, queue=1000)
        self.start()

    def run(self):
        try:
            for line in self.connection.lines:
                self.came.append((time.monotonic(), line))
        except (OSError, ValueError):
            pass  # closed

    def take(self):
        came, self.came = self.came, []
        return [(when, json.loads(line)["params"]["data"]) for when, line in came]


def listens(port):
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def ctl(*arguments):
    return subprocess.run([CTL, *arguments], capture_output=True, text=True, timeout=60, check=False)


class Sessions(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.records = os.path.join(self.folder, "records")
        self.lidar = load.Logger(self.records, self.folder, **{"record.file_bytes": 1000000, "record.free_floor_bytes": 0,
                                                               "record.free_warn_bytes": 0})
        self.addCleanup(self.end, self.lidar)
        self.serial = Serial(self.folder, self.records)
        self.addCleanup(self.end, self.serial)
        self.daemons = f"127.0.0.1:{self.lidar.process.port},127.0.0.1:{self.serial.process.port}"

    @staticmethod
    def end(logger):
        logger.daemon.close()
        logger.process.stop()

    def ctl(self, *arguments, status=0):
        shown = ctl("--daemons", self.daemons, *arguments)
        self.assertEqual(shown.returncode, status, shown)
        return shown.stdout if status == 0 else shown.stderr

    def sidecar(self, name, logger):
        return json.loads(text_of(os.path.join(self.records, name, logger + ".json")))

    def record(self, name, lines=None):
        """A session with packets and lines, all of them heard by the reader of lines; gives how many data packets, position
        packets and bytes."""
        self.ctl("record", "start", name)
        sender = self.lidar.send(PACKETS_HZ, SECONDS, 0)
        text = b""
        while sender.poll() is None:
            line = b"$GPTXT,01,01,02,line %d\r\n" % text.count(b"\n")
            self.serial.send(line)
            text += line
        data, position, _ = load.sent(sender)
        wait_for("the packets", lambda: self.lidar.daemon.call("record.status")["counts"]["packets"] == data + position)
        wait_for("the lines live", lambda: lines is None or len(lines.came) == text.count(b"\n"))
        return data, position, len(text)

    def test_record(self):
        data, position, size = self.record("run1")
        self.assertRegex(self.ctl("record", "status"), r"velodynelogger +recording +run1 .* nothing\n")
        self.assertIn('records "run1" already', self.ctl("record", "start", "run2", status=1))
        self.assertRegex(self.ctl("record", "list"), r"run1 .*velodynelogger being recorded")
        shown = self.ctl("record", "stop")
        self.assertRegex(shown, rf"velodynelogger +run1 +\S+ +\d+ +\d+ +data {data}, packets {data + position}, "
                                rf"position {position} +nothing\n")
        self.assertRegex(shown, rf"seriallogger +run1 +\S+ +1 +{size} +bytes {size}, chunks \d+ +nothing\n")
        self.assertRegex(self.ctl("record", "list"), r"run1 .* velodynelogger,seriallogger +complete\n")
        self.assertIn("nothing is being recorded", self.ctl("record", "stop", status=1))
        self.assertIn('has a recording "run1" already', self.ctl("record", "start", "run1", status=1))
        self.assertEqual(sorted(os.listdir(self.records)), [".seriallogger.lock", ".velodynelogger.lock", "run1"])
        sidecars = [self.sidecar("run1", name) for name in ("velodynelogger", "seriallogger")]
        self.assertEqual(sidecars[0]["session"], sidecars[1]["session"])
        self.assertLess(abs(sidecars[0]["start"] - sidecars[1]["start"]), 1)
        load.check_files(os.path.join(self.records, "run1"), 0, data, position)

    def test_replay(self):
        lines, scans = self.read(self.serial, "lines"), self.read(self.lidar, "scan2d")
        self.record("run1", lines)
        self.ctl("record", "stop")
        live_turns = self.lidar.daemon.call("source.status")["turns"]
        wait_for("the turns live", lambda: len(scans.came) == live_turns)
        self.assertGreater(len(load.captures(os.path.join(self.records, "run1"))), 2)
        live_lines, live_scans = lines.take(), scans.take()
        with Lateness() as lateness:
            self.assertEqual(self.ctl("replay", "run1"), "")
            wait_for("the lines", lambda: len(lines.came) == len(live_lines))
            # The turn that was under way came when the replay began, the last of the replay at its end.
            wait_for("the turns", lambda: len(scans.came) == len(live_scans) + 2)
            allowed = 0.1 + 2 * lateness.take_longest()  # what holds up a nap here holds up the loggers too
        lines, scans = lines.take(), scans.take()
        live_scans.append(scans.pop(0))
        self.assertEqual([line for _, line in lines], [line for _, line in live_lines])
        for (_, turn), (_, same) in zip(scans, live_scans):
            self.assertEqual((turn["turn"], turn["stamp"], turn["x"]), (same["turn"], same["stamp"], same["x"]))
            self.assertEqual(turn["lost_packets"], 0)
        late = [[now - then for (now, _), (then, _) in list(zip(again, before))[:-1]]
                for again, before in ((lines, live_lines), (scans, live_scans))]
        apart = statistics.median(late[0]) - statistics.median(late[1])
        print(f"replay: lines and turns {1e3 * apart:+.1f} ms apart from how they came live, spread of lines "
              f"{1e3 * statistics.pstdev(late[0]):.1f} ms, of turns {1e3 * statistics.pstdev(late[1]):.1f} ms")
        self.assertLess(abs(apart), allowed)
        self.check_live()

    def check_live(self):
        for logger in (self.lidar, self.serial):
            self.assertEqual(logger.daemon.call("source.status")["source"]["state"], "live")

    def read(self, logger, topic):
        reader = Reader(logger.process.port, topic)
        self.addCleanup(reader.connection.socket.close)
        return reader

    def test_replay_loops_until_interrupted(self):
        self.record("run1")
        self.ctl("record", "stop")
        lines, heard = self.read(self.serial, "lines"), []

        def has_looped():
            heard.extend(lines.take())
            return sum(line["text"].endswith("line 0") for _, line in heard) >= 3

        far, near = pty.openpty()
        replay = subprocess.Popen([CTL, "--daemons", self.daemons, "replay", "run1", "--loop", "--speed", "10"], stderr=near)
        os.close(near)
        try:
            wait_for("the third time", has_looped)
            replay.send_signal(signal.SIGINT)
            self.assertEqual(replay.wait(20), 0)
        finally:
            replay.kill()
            replay.wait()
        self.assertRegex(os.read(far, 100000).decode(), r"run1: [\d.]+ of [\d.]+ s")
        os.close(far)
        self.check_live()
        shown = ctl("--daemons", self.daemons, "replay", "run2")
        self.assertEqual(shown.returncode, 1)
        self.assertIn('there is no session "run2"', shown.stderr)

    def test_what_cannot_be_replayed(self):
        self.record("run1")
        self.assertIn('is recording "run1"', self.ctl("replay", "run1", status=1))
        self.ctl("record", "stop")
        os.remove(load.captures(os.path.join(self.records, "run1"))[0])
        told = self.ctl("replay", "run1", status=1)
        self.assertIn("velodynelogger: ", told)
        self.assertIn("0001.pcap: cannot be read", told)
        self.check_live()

    def test_all_or_none(self):
        full = Serial(self.folder, os.path.join(self.folder, "elsewhere"))  # a disk of its own
        self.addCleanup(self.end, full)
        full.daemon.call("settings.set", values={"record": {"free_warn_bytes": 1e15, "free_floor_bytes": 1e15}})
        self.daemons = f"127.0.0.1:{self.lidar.process.port},127.0.0.1:{full.process.port}"
        told = self.ctl("record", "start", "run1", status=1)
        self.assertIn("seriallogger: ", told)
        self.assertIn("free_floor_bytes", told)
        self.assertIn("velodynelogger had begun and was stopped", told)
        for logger in (self.lidar, full):
            self.assertFalse(logger.daemon.call("record.status")["recording"])
        self.assertEqual(self.sidecar("run1", "velodynelogger")["ended"], "stopped")

    def test_a_start_that_timed_out_is_taken_back(self):
        port = free_port(0)
        late = subprocess.Popen(["python3", "-c", LATE_LOGGER, os.path.join(SOURCE, "docs", "examples"), "--port", str(port)])
        self.addCleanup(late.wait)
        self.addCleanup(late.kill)
        wait_for("the late logger", lambda: listens(port))
        self.daemons = f"127.0.0.1:{self.lidar.process.port},127.0.0.1:{port}"
        told = self.ctl("--timeout", "4", "record", "start", "run1", status=1)
        for words in ("late: record.start: no reply within 4 s", "late had begun and was stopped, see /late",
                      "velodynelogger had begun and was stopped"):
            self.assertIn(words, told)
        self.assertNotRegex(self.ctl("record", "status"), " recording ")

    def test_json_and_completion(self):
        def told(*arguments):
            return json.loads(self.ctl(*arguments, "--json"))

        loggers = {"velodynelogger", "seriallogger"}
        self.assertEqual({one["daemon"] for one in told("record", "start", "run1")}, loggers)
        self.assertEqual([one["daemon"] for one in told("record", "mark", "here")], ["seriallogger"])
        self.assertEqual({(one["daemon"], one["recording"]) for one in told("record", "status")}, {(name, True) for name in loggers})
        self.assertEqual({(one["daemon"], one["name"]) for one in told("record", "stop")}, {(name, "run1") for name in loggers})
        session, = told("record", "list")
        self.assertEqual((session["name"], set(session["loggers"]), session["faults"]), ("run1", loggers, []))
        for line in (f"replay --daemons {self.daemons} ru", f"call {self.daemons.split(',')[1]} source.open recording="):
            self.assertIn("run1", ctl("complete", "hermesctl " + line).stdout)
        error = json.loads(self.ctl("replay", "none", "--json", status=1))
        self.assertIn('no session "none"', error["message"])

    def test_progress_as_json(self):
        self.record("run1")
        self.ctl("record", "stop")
        shown = ctl("--daemons", self.daemons, "replay", "run1", "--json", "--speed", "0.25")
        self.assertEqual(shown.returncode, 0, shown.stderr)
        progress = [json.loads(line)["progress"] for line in shown.stderr.splitlines()]
        self.assertGreater(len(progress), 3, shown.stdout)
        self.assertEqual(len({p["total"] for p in progress}), 1)
        self.assertEqual([p["done"] for p in progress], sorted(p["done"] for p in progress))

    def test_a_start_tells_what_is_not_well(self):
        """The receiver is unplugged: it would be recorded, and nothing comes."""
        self.serial.process.stop()
        ports = [{"name": "gps", "url": f"serial://{self.folder}/unplugged?baud=9600"}]
        process = Process(load.BINARIES, "seriallogger", free_port(0), self.folder, {
            "ports": json.dumps(ports), "record.folder": self.records, "record.free_floor_bytes": 0, "record.free_warn_bytes": 0})
        self.addCleanup(process.stop)
        process.connect().close()
        shown = ctl("--daemons", f"127.0.0.1:{process.port}", "record", "start", "run1")
        self.assertEqual(shown.returncode, 0, shown)
        self.assertIn("records to", shown.stdout)
        self.assertRegex(shown.stderr, rf"hermesctl: seriallogger: error: port gps: .*{self.folder}/unplugged")
        ctl("--daemons", f"127.0.0.1:{process.port}", "record", "stop")
        shown = ctl("--daemons", f"127.0.0.1:{process.port}", "record", "start", "run2", "--json")
        notes = [json.loads(line)["note"] for line in shown.stderr.splitlines()]
        self.assertTrue(any(one.startswith("seriallogger: error: port gps: ") for one in notes), shown)

    def test_mark(self):
        self.assertIn("no logger that takes marks is recording", self.ctl("record", "mark", "too early", status=1))
        self.ctl("record", "start", "run1")
        self.assertRegex(self.ctl("record", "mark", "at the door"), r"daemon +marked at\nseriallogger +20\d\d-\S+\n$")
        self.ctl("record", "stop")
        self.assertIn('"text":"at the door"', text_of(os.path.join(self.records, "run1", "seriallogger-events.jsonl")))

    def test_one_that_died_is_told(self):
        self.record("run1")
        self.serial.process.process.kill()
        self.serial.process.process.wait()
        shown = ctl("--daemons", self.daemons.split(",")[0], "record", "stop")
        self.assertEqual(shown.returncode, 1)
        self.assertIn("seriallogger: it took part, but does not answer", shown.stderr)
        shown = ctl("--daemons", self.daemons.split(",")[0], "replay", "run1", "--speed", "10")  # what is there
        self.assertEqual(shown.returncode, 0)
        self.assertIn("seriallogger: it took part, but does not answer", shown.stderr)

    def test_one_that_began_anew_is_told(self):
        self.record("run1")
        self.serial.process.process.kill()
        self.serial.process.process.wait()
        again = Serial(self.folder, self.records)
        self.addCleanup(self.end, again)
        self.daemons = f"127.0.0.1:{self.lidar.process.port},127.0.0.1:{again.process.port}"
        self.assertIn("seriallogger: cut off", self.ctl("record", "stop", status=1))

    def test_losses_are_told(self):
        self.ctl("record", "start", "run1")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            stranger.sendto(bytes(3000), ("127.0.0.1", self.lidar.lidar_port))
        wait_for("the loss", lambda: self.lidar.daemon.call("record.status")["losses"]["too_long"])
        self.assertIn("velodynelogger: lost: too_long 1", self.ctl("record", "stop", status=1))

    def test_who_is_asked(self):
        nobody = f"127.0.0.1:{free_port(0)}"
        for arguments, words, status in ((("--daemons", nobody, "record", "start", "x"), "refused", 1),
                                         (("--host", "127.0.0.79", "record", "start", "x"), "no logger answers", 1),
                                         (("--daemons", "nobody", "record", "stop"), "unknown daemon", 2),
                                         (("record", "start", "a/b"), "NAME", 2), (("record",), "one of these is expected", 2),
                                         (("record", "start"), "usage", 2), (("record", "stop", "x"), "usage", 2)):
            shown = ctl(*arguments)
            self.assertEqual(shown.returncode, status, shown)
            self.assertIn(words, shown.stderr)
        trigger = Process(load.BINARIES, "softwaretrigger", free_port(0), self.folder, {})
        self.addCleanup(trigger.stop)
        trigger.connect().close()
        shown = ctl("--daemons", f"127.0.0.1:{trigger.port}", "record", "status")
        self.assertEqual(shown.returncode, 1)
        self.assertIn("no logger", shown.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
