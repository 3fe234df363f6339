#!/usr/bin/env python3
"""All loggers of a robot record as one session and play it back, by hermesctl and the recorder: all or none begins, the end is
checked, what is played is what was recorded, together in time."""
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
        self.begin_recorder(self.lidar.process.port, self.serial.process.port)

    def begin_recorder(self, *ports):
        """A recorder of the daemons at these ports, which answer."""
        process = Process(load.BINARIES, "recorder", free_port(0), self.folder, {
            "daemons": json.dumps([f"127.0.0.1:{port}" for port in ports]), "record.folder": self.records,
            "record.free_floor_bytes": 0, "record.free_warn_bytes": 0})
        self.addCleanup(process.stop)
        self.recorder = f"127.0.0.1:{process.port}"
        with process.connect() as daemon:
            wait_for("the daemons", lambda: any(item["message"].startswith(f"{len(ports)} daemons")
                                                for item in daemon.call("daemon.status")["health"]))

    @staticmethod
    def end(logger):
        logger.daemon.close()
        logger.process.stop()

    def ctl(self, *arguments, status=0):
        shown = ctl("--recorder", self.recorder, *arguments)
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
        wait_for("the packets in the state", lambda: f"packets {data + position}" in self.ctl("record", "status"))
        self.assertRegex(self.ctl("record", "status"), r"velodynelogger +recording .* nothing *\n")
        self.assertIn('"run1" is being recorded', self.ctl("record", "start", "run2", status=1))
        self.assertRegex(self.ctl("record", "list"), r"run1 +20\S+ +\S+ MB +recorder, .* being recorded")
        shown = self.ctl("record", "stop")
        self.assertRegex(shown, rf"velodynelogger +stopped .* data {data}, packets {data + position}, position {position} +nothing\n")
        self.assertRegex(shown, rf"seriallogger +stopped .* bytes {size}, chunks \d+ +nothing\n")
        self.assertRegex(shown, r"recorder +stopped .* messages \d+, topics \d+ +nothing\n")
        self.assertRegex(self.ctl("record", "list"), r"run1 +20\S+ +20\S+ .* recorder, \w+logger, \w+logger\n$")
        self.assertIn("nothing is being recorded", self.ctl("record", "stop", status=1))
        self.assertIn('has a recording "run1" already', self.ctl("record", "start", "run1", status=1))
        self.assertEqual(sorted(os.listdir(self.records)),
                         [".recorder.ended", ".recorder.lock", ".seriallogger.lock", ".velodynelogger.lock", "run1"])
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
        replay = subprocess.Popen([CTL, "--recorder", self.recorder, "replay", "run1", "--loop", "--speed", "10"], stderr=near)
        os.close(near)
        try:
            wait_for("the third time", has_looped)
            self.assertRegex(os.read(far, 100000).decode(), r"replaying, second \d+ of \d+")
            replay.send_signal(signal.SIGINT)
            self.assertEqual(replay.wait(20), 0)
        finally:
            replay.kill()
            replay.wait()
        os.close(far)
        self.check_live()
        self.assertIn('there is no session "run2"', self.ctl("replay", "run2", status=1))

    def test_what_cannot_be_replayed(self):
        self.record("run1")
        self.assertIn('"run1" is being recorded', self.ctl("replay", "run1", status=1))
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
        self.begin_recorder(self.lidar.process.port, full.process.port)
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
        self.begin_recorder(self.lidar.process.port, port)
        told = self.ctl("record", "start", "run1", status=1)
        for words in ("late: record.start: no reply within 5 s", "late had begun and was stopped, see /late",
                      "velodynelogger had begun and was stopped"):
            self.assertIn(words, told)
        self.assertIn("idle", self.ctl("record", "status"))

    def test_json_and_completion(self):
        def told(*arguments):
            return json.loads(self.ctl(*arguments, "--json"))

        loggers = {"recorder", "velodynelogger", "seriallogger"}
        self.assertEqual({part["daemon"] for part in told("record", "start", "run1")["parts"]}, loggers)
        self.assertEqual(told("record", "mark", "here")["text"], "here")
        self.assertEqual({(part["daemon"], part["state"]) for part in told("record", "status")["parts"]},
                         {(name, "recording") for name in loggers})
        stopped = told("record", "stop")
        self.assertEqual((stopped["state"], stopped["name"], stopped["problems"]), ("idle", "run1", []))
        session, = told("record", "list")
        self.assertEqual((session["name"], set(session["daemons"]), session["problems"]), ("run1", loggers, []))
        for line in (f"replay --recorder {self.recorder} ru", f"call 127.0.0.1:{self.serial.process.port} source.open recording="):
            self.assertIn("run1", ctl("complete", "hermesctl " + line).stdout)
        error = json.loads(self.ctl("replay", "none", "--json", status=1))
        self.assertIn('no session "none"', error["message"])

    def test_some_of_the_loggers_without_a_name(self):
        parts = json.loads(self.ctl("session", "start", "--daemons", "seriallogger", "--json"))
        self.assertEqual({part["daemon"] for part in parts["parts"]}, {"recorder", "seriallogger"})
        self.assertRegex(parts["name"], r"^\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d$")
        self.ctl("session", "stop")

    def test_a_session_is_told_renamed_exported_and_removed(self):
        self.record("run1")
        self.ctl("record", "stop")
        self.assertRegex(self.ctl("session", "info", "run1"), r"velodynelogger/scan2d +\d+ +0 ")
        self.assertIn("run1", self.ctl("session", "explain", "run1", "--at", "0.5"))
        for path in self.ctl("session", "export", "run1", "--format", "csv", "--topics", "velodynelogger/scan2d").splitlines():
            self.assertTrue(os.path.exists(path), path)
        self.assertRegex(self.ctl("session", "rename", "run1", "run2"), r"\nrun2 ")
        self.assertIn("--yes removes it", self.ctl("session", "remove", "run2", status=1))
        self.assertTrue(os.path.exists(os.path.join(self.records, "run2")))
        self.ctl("session", "remove", "run2", "--yes")
        self.assertFalse(os.path.exists(os.path.join(self.records, "run2")))
        self.assertEqual(self.ctl("session", "list"), "")

    def test_a_replay_without_hermesctl(self):
        self.record("run1")
        self.ctl("record", "stop")
        self.ctl("replay", "run1", "--loop", "--speed", "0.1", "--detach")
        wait_for("the replay", lambda: self.serial.daemon.call("source.status")["source"]["state"] == "replay")
        killed = subprocess.Popen([CTL, "--recorder", self.recorder, "replay", "run1", "--speed", "0.1", "--json"],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.assertIn(b'"replay":', killed.stdout.readline())
        killed.kill()
        killed.wait()
        killed.stdout.close()
        self.assertRegex(self.ctl("session", "status"), r"run1 +replaying")
        self.assertNotIn("replaying", self.ctl("session", "live"))
        self.check_live()

    def test_progress_as_json(self):
        self.record("run1")
        self.ctl("record", "stop")
        shown = ctl("--recorder", self.recorder, "replay", "run1", "--json", "--speed", "0.25")
        self.assertEqual(shown.returncode, 0, shown.stderr)
        progress = [json.loads(line)["progress"] for line in shown.stderr.splitlines()]
        self.assertGreater(len(progress), 3, shown.stdout)
        self.assertEqual(len({p["total"] for p in progress}), 1)
        self.assertEqual([p["done"] for p in progress], sorted(p["done"] for p in progress))

    def test_mark(self):
        self.assertIn("nothing is being recorded", self.ctl("record", "mark", "too early", status=1))
        self.ctl("record", "start", "run1")
        self.assertRegex(self.ctl("record", "mark", "at the door"), r"at \[s\] +mark\n\d\S* +at the door\n$")
        self.ctl("record", "stop")
        self.assertIn('"text":"at the door"', text_of(os.path.join(self.records, "run1", "seriallogger-events.jsonl")))

    def test_one_that_died_is_told(self):
        self.record("run1")
        self.serial.process.process.kill()
        self.serial.process.process.wait()
        self.assertIn("seriallogger: it took part, and does not answer", self.ctl("record", "stop", status=1))
        shown = ctl("--recorder", self.recorder, "replay", "run1", "--speed", "10")  # what is there
        self.assertEqual(shown.returncode, 0, shown)

    def test_losses_are_told(self):
        self.ctl("record", "start", "run1")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            stranger.sendto(bytes(3000), ("127.0.0.1", self.lidar.lidar_port))
        wait_for("the loss", lambda: self.lidar.daemon.call("record.status")["losses"]["too_long"])
        self.assertIn("velodynelogger: lost: too_long 1", self.ctl("record", "stop", status=1))


if __name__ == "__main__":
    unittest.main(verbosity=2)
