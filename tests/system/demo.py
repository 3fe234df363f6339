#!/usr/bin/env python3
"""Runs the demo as a newcomer does, interrupts it, kills it, and looks at what it leaves."""
import glob
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import uuid
from unittest import mock

from support import DATA, SOURCE, put, text_of
import window  # of deploy/demo

RUN = os.path.join(SOURCE, "deploy", "demo", "run.py")


def marked(mark):
    """Processes whose environment holds the mark."""
    found = []
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/environ", "rb") as environment:
                if mark.encode() in environment.read():
                    found.append(int(pid))
        except OSError:
            pass
    return found


def wait_for(condition, limit_s):
    deadline = time.monotonic() + limit_s
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.05)
    return condition()


class DemoTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="hermes-test-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.out = os.path.join(self.folder, "out")
        self.mark = str(uuid.uuid4())
        self.display = {"DISPLAY": "", "WAYLAND_DISPLAY": ""}

    def start(self, *arguments):
        return subprocess.Popen([sys.executable, RUN, "--out", self.out, *arguments], stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                                env={**os.environ, "HERMES_DEMO_MARK": self.mark, "TMPDIR": self.folder, **self.display})

    def finish(self, process, limit_s):
        out, err = process.communicate(timeout=limit_s)
        self.assertEqual(marked(self.mark), [], "processes are left behind")
        return process.returncode, out, err

    @unittest.skipIf("TSAN_OPTIONS" in os.environ, "the simulator does not keep its pace under the thread sanitizer")
    def test_drives_and_maps(self):
        stops = os.path.join(os.environ["XDG_STATE_HOME"], "hermes", "estop")
        os.makedirs(stops)
        with open(os.path.join(stops, "of another robot"), "w", encoding="utf-8") as file:
            file.write("emergency stop by somebody\nport 7410\n")  # which the demo does not heed
        begin = time.monotonic()
        status, out, err = self.finish(self.start(), 120)
        seconds = time.monotonic() - begin
        self.assertEqual(status, 0, out + err)
        self.assertLessEqual({"map.svg", "map.csv", "trajectory.tum", "odometry.tum", "truth.tum", "recording", "summary.json"},
                             set(os.listdir(self.out)))
        summary = json.loads(text_of(os.path.join(self.out, "summary.json")))
        self.assertGreater(summary["scans"], 200)
        self.assertEqual(summary["matched"], summary["scans"], summary)
        self.assertEqual(summary["dropped"], 0, summary)
        self.assertLess(summary["final_error_m"], 0.05)
        self.assertLess(summary["final_error_deg"], 1.0)
        # The wheels slip, and the matcher, which goes by them, puts it right.
        self.assertGreater(summary["by_odometry"], 0.9 * summary["scans"], summary)
        self.assertGreater(summary["final_drift_m"], 0.2)
        self.assertEqual(set(summary["exit_status"]), {"simulator", "motorcontrol", "velodynelogger", "scanmatcher", "recorder"})
        self.assertLess(seconds, 60)
        self.assertEqual(set(summary["exit_status"].values()), {0})
        lines = text_of(os.path.join(self.out, "trajectory.tum")).splitlines()
        self.assertGreaterEqual(len(lines), summary["scans"])
        self.assertTrue(all(len(line.split()) == 8 for line in lines))
        if shutil.which("capinfos"):
            told = subprocess.run(["capinfos", "-M", "-c", os.path.join(self.out, "recording", "velodynelogger-0001.pcap")],
                                  capture_output=True, text=True, check=True).stdout
            self.assertGreater(int(told.split("Number of packets:")[1].split()[0]), 30 * 1800)

    def records(self):
        """Whether the running demo has written a part of its recording."""
        return any(os.path.getsize(path) > 100000
                   for path in glob.glob(os.path.join(self.folder, "hermes-demo-*", "results", "recording", "*.pcap")))

    def interrupt(self, number):
        process = self.start()
        self.assertTrue(wait_for(self.records, 20), "the demo never got to record")
        process.send_signal(number)
        return self.finish(process, 15)

    def test_ctrl_c_leaves_nothing(self):
        status, out, err = self.interrupt(signal.SIGINT)
        self.assertEqual(status, 130, out + err)
        self.assertIn("Interrupted", err)
        self.assertEqual(os.listdir(self.folder), [])

    def test_term_leaves_nothing(self):
        status, _, _ = self.interrupt(signal.SIGTERM)
        self.assertEqual(status, 143)
        self.assertEqual(os.listdir(self.folder), [])

    def with_window(self):
        """The window opens, but nowhere."""
        self.display = {"DISPLAY": ":0", "QT_QPA_PLATFORM": "offscreen"}

    def test_ctrl_c_closes_the_window(self):
        self.with_window()
        status, out, err = self.interrupt(signal.SIGINT)
        self.assertEqual(status, 130, out + err)
        self.assertIn("opening hermes-gui", out)

    def test_ctrl_c_while_the_window_stays(self):
        """Is as good as closing it."""
        stays = window.Window.__new__(window.Window)
        with subprocess.Popen(["sleep", "60"]) as stays.process:
            self.addCleanup(stays.process.kill)
            with mock.patch.object(stays.process, "wait", side_effect=KeyboardInterrupt):
                stays.stay("The window stays.")
            self.assertIsNone(stays.process.poll())
            stays.stop()

    def test_kill_leaves_no_process(self):
        self.with_window()
        process = self.start()
        self.assertTrue(wait_for(lambda: len(marked(self.mark)) >= 6, 20))
        process.kill()
        process.communicate()
        self.assertTrue(wait_for(lambda: not marked(self.mark), 10), "daemons outlive a killed demo")

    def test_ports_in_use_are_no_obstacle(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            sys.path.insert(0, os.path.dirname(RUN))
            from processes import free_port
            self.assertNotEqual(free_port(taken.getsockname()[1]), taken.getsockname()[1])

    def test_usage_errors(self):
        for arguments in (["--log", "/no/such/file"], ["--world", "/no/such/world"], ["--nonsense"], ["--tour", "--log", RUN]):
            status, _, err = self.finish(self.start(*arguments), 20)
            self.assertEqual(status, 2, err)
            self.assertIn(arguments[0], err)
            self.assertFalse(os.path.exists(self.out))

    def test_other_peoples_folder_is_not_replaced(self):
        os.mkdir(self.out)
        put(os.path.join(self.out, "thesis.txt"), "ten years of work")
        status, _, err = self.finish(self.start(), 20)
        self.assertEqual(status, 2, err)
        self.assertEqual(os.listdir(self.out), ["thesis.txt"])

    def test_bad_world(self):
        world = os.path.join(self.folder, "empty.json")
        put(world, '{"name": "empty", "edges": [], "poses": [[0, 0, 0]]}')
        status, _, err = self.finish(self.start("--world", world), 20)
        self.assertEqual(status, 1, err)
        self.assertIn("empty.json", err)
        self.assertFalse(os.path.exists(self.out))
        logs = re.search(r"logs of the daemons in (\S+)", err)[1]
        self.assertLessEqual({"scanmatcher.log", "simulator.log"}, set(os.listdir(logs)))
        self.assertEqual([name for name in os.listdir(logs) if not name.endswith(".log")], [])

    @unittest.skipUnless(os.path.isdir(DATA), "no real data (HERMES_DATA)")
    def test_real_log(self):
        log = os.path.join(DATA, "belgioioso-corrected.log.gz")
        status, out, err = self.finish(self.start("--log", log, "--corrected"), 60)
        self.assertEqual(status, 0, out + err)
        self.assertLessEqual({"map.svg", "map.csv", "trajectory.tum", "summary.json"}, set(os.listdir(self.out)))


if __name__ == "__main__":
    unittest.main(verbosity=2)
