#!/usr/bin/env python3
"""hermesctl session import: a bag of a stranger's robot is a session of the recorder, replays through the topics of its own daemons, and
the matcher makes a map of it."""
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

from support import BINARIES, SOURCE, Listener, Process, free_port, wait_for

sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
import ros_bags as bags  # noqa: E402  pylint: disable=wrong-import-position

MOUNT = (0.2, 0.0, math.pi / 2)
WAY_M, SCANS, START = 0.05, 60, 1700000000.0


def wall_distance(x, y, direction):
    """From a place in a room of 9 m by 6 m."""
    dx, dy = math.cos(direction), math.sin(direction)
    return min((edge - at) / step for at, step, edges in ((x, dx, (-4, 5)), (y, dy, (-3, 3))) for edge in edges if (edge - at) * step > 1e-9)


def drive(with_map=False):
    """A drive ahead with a scanner that looks to the left and sees three quarters of a turn; with the frame of a map."""
    messages = [("/tf_static", "tf2_msgs/TFMessage", START, bags.transforms(bags.Bytes("cdr"), (START, "base", "laser", (*MOUNT[:2], 0.2), MOUNT[2])))]
    for i in range(SCANS):
        t, x = START + 0.1 * i, WAY_M * i
        ranges = [wall_distance(x + MOUNT[0], 0, MOUNT[2] - 2.3 + 0.01 * k) for k in range(460)]
        messages.append(("/odom", "nav_msgs/Odometry", t, bags.odometry(bags.Bytes("cdr"), t, (x, 0, 0), (WAY_M * 10, 0, 0), child="base")))
        if with_map:
            frames = (t, "map", "odom", (10, 20, 0), math.pi / 2), (t, "odom", "base", (x, 0, 0), 0)
            messages.append(("/tf", "tf2_msgs/TFMessage", t, bags.transforms(bags.Bytes("cdr"), *frames)))
        messages.append(("/scan", "sensor_msgs/LaserScan", t + 0.02, bags.laser_scan(bags.Bytes("cdr"), t, ranges, "laser", -2.3, 0.01)))
    return messages


class BagImport(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder, self.records = folder.name, os.path.join(folder.name, "records")
        os.mkdir(self.records)
        self.bag = os.path.join(self.folder, "strange.mcap")
        bags.write_mcap(self.bag, drive())
        self.ports = {name: free_port(0) for name in ("scanner", "motorcontrol", "scanmatcher", "recorder")}
        address = {name: f"127.0.0.1:{port}" for name, port in self.ports.items()}
        self.settings = {"recorder": {"daemons": json.dumps([address[name] for name in ("scanner", "motorcontrol")]), "record.folder": self.records,
                                      "record.free_floor_bytes": 0, "record.free_warn_bytes": 0},
                         "scanner": {"record.folder": self.records}, "motorcontrol": {},
                         "scanmatcher": {"source.address": address["scanner"], "odometry.address": address["motorcontrol"],
                                         "matcher.start": "mapping", "map.folder": self.folder}}

    def start(self, name):
        process = Process(BINARIES, name, self.ports[name], self.folder, self.settings[name])
        self.addCleanup(process.stop)
        return process.connect()

    def sessions(self):
        return sorted(name for name in os.listdir(self.records) if name != ".recorder.lock")

    def ctl(self, *words):
        return subprocess.run([os.path.join(BINARIES, "hermesctl"), *words, "--recorder", f"127.0.0.1:{self.ports['recorder']}"],
                              capture_output=True, text=True, timeout=60, check=False)

    def test_a_bag_is_a_session(self):
        recorder = self.start("recorder")
        shown = self.ctl("session", "import", self.bag)
        self.assertEqual((shown.returncode, shown.stdout, shown.stderr), (0, "strange\n", ""))
        info = recorder.call("session.info", name="strange")
        self.assertEqual({t["topic"]: (t["messages"], t["lost"]) for t in info["topics"]},
                         {"scanner/scan2d": (SCANS, 0), "motorcontrol/odometry": (SCANS, 0)})
        self.assertEqual((info["summary"]["problems"], info["summary"]["start"]), ([], START))
        self.assertAlmostEqual(info["duration_s"], 0.1 * (SCANS - 1) + 0.02, places=6)
        self.assertAlmostEqual(info["driven_m"], WAY_M * (SCANS - 1), places=3)
        mapped = subprocess.run([os.path.join(BINARIES, "hermes-vector"), "map", os.path.join(self.records, "strange")], capture_output=True,
                                text=True, timeout=60, check=True)
        self.assertEqual(json.loads(mapped.stdout)["matched"], SCANS)
        self.assertIn(json.loads(mapped.stdout)["segments"], (4, 5))  # one is seen in two parts
        self.assertNotIn("contradict", mapped.stderr)
        alone = subprocess.run([os.path.join(BINARIES, "hermes-vector"), "map", os.path.join(self.records, "strange", "recorder-0001.mcap")],
                               capture_output=True, text=True, timeout=60, check=True)
        self.assertEqual(json.loads(alone.stdout)["matched"], SCANS)
        again = self.ctl("session", "import", self.bag)
        self.assertEqual(again.returncode, 1)
        self.assertIn("it exists already; --name", again.stderr)
        self.assertEqual(self.ctl("session", "import", self.bag, "--name", "other", "--topic", "/scan").stdout, "other\n")
        self.assertEqual(self.sessions(), ["other", "strange"])

    def test_a_session_of_a_bag_becomes_a_bag_again(self):
        recorder = self.start("recorder")
        self.assertEqual(self.ctl("session", "import", self.bag).returncode, 0)
        path = recorder.call("session.export", name="strange", format="mcap", profile="ros2")["paths"][0]
        mapped = subprocess.run([os.path.join(BINARIES, "hermes-vector"), "map", path], capture_output=True, text=True, timeout=60, check=True)
        self.assertEqual((json.loads(mapped.stdout)["matched"], json.loads(mapped.stdout)["by_odometry"]), (SCANS, SCANS - 1))
        self.assertEqual(self.ctl("session", "import", path, "--name", "again").returncode, 0)
        topics = {t["topic"]: t["messages"] for t in recorder.call("session.info", name="again")["topics"]}
        self.assertEqual(topics, {"scanner/scan2d": SCANS, "motorcontrol/odometry": SCANS})

    def test_poses_in_a_map(self):
        recorder = self.start("recorder")
        bags.write_mcap(self.bag, drive(with_map=True))
        self.assertEqual(self.ctl("session", "import", self.bag).returncode, 0)
        recorder.call("session.export", name="strange", format="tum")
        with open(os.path.join(self.records, "strange", "export", "scanmatcher-pose.tum"), encoding="ascii") as file:
            poses = [tuple(map(float, line.split())) for line in file if line[0] != "#"]
        self.assertEqual(len(poses), SCANS)
        for i, (t, x, y, *_, z, w) in enumerate(poses):
            for found, expected in ((t, START + 0.1 * i), (x, 10), (y, 20 + WAY_M * i), (2 * math.atan2(z, w), math.pi / 2)):
                self.assertAlmostEqual(found, expected, places=4)

    def test_what_cannot_be_imported(self):
        self.start("recorder")
        for words, told in ((["/nowhere.bag"], "/nowhere.bag"), ([self.bag, "--topic", "/back"], "found no scanner /back"),
                            ([self.bag, "--name", "../x"], "--name"), ([__file__], "expected a bag")):
            shown = self.ctl("session", "import", *words)
            self.assertEqual(shown.returncode, 1, words)
            self.assertIn(told, shown.stderr)
        self.assertEqual(self.sessions(), [])
        self.assertEqual(self.ctl("session", "list").stdout, "")

    def test_it_replays_through_the_robot(self):
        daemons = {name: self.start(name) for name in self.ports}
        self.assertEqual(self.ctl("session", "import", self.bag).returncode, 0)
        scans, odometry = Listener(self.ports["scanner"], "scan2d"), Listener(self.ports["motorcontrol"], "odometry")
        wait_for("the daemons", lambda: "2 daemons" in next(one["message"] for one in daemons["recorder"].call("daemon.status")["health"]
                                                            if one["name"] == "daemons"))
        shown = self.ctl("replay", "strange", "--speed", "2")
        self.assertEqual((shown.returncode, shown.stderr), (0, ""))
        replayed = [m["data"] for m in scans.messages]
        self.assertEqual(len(replayed), SCANS)
        for i, message in enumerate(scans.messages):
            self.assertAlmostEqual(message["stamp"], START + 0.1 * i, places=5)
            self.assertAlmostEqual(replayed[i]["stamp"], START + 0.1 * i, places=5)
        # In the robot's frame: the wall to the left is as far as from the robot's centre.
        self.assertAlmostEqual(max(replayed[0]["y"]), 3, places=3)
        self.assertGreaterEqual(len(odometry.messages), SCANS)
        state = daemons["scanmatcher"].call("matcher.state")
        self.assertGreater(state["scans"], SCANS / 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
