#!/usr/bin/env python3
"""`hermesctl session` and the recorder of a whole robot: it records, plays back, and tells what is wrong."""
import glob
import json
import math
import os
import pty
import re
import signal
import subprocess
import unittest

from recorded_robot import RecordedRobot, mcap_reader
from support import HERMESCTL, text_of, wait_for

import ros_cdr  # of tests/support, which recorded_robot has found


class Sessions(RecordedRobot):
    def command(self, words):
        return [HERMESCTL, "--recorder", f"127.0.0.1:{self.robot.ports['recorder']}", *words.split()]

    def ctl(self, words, status=0):
        shown = subprocess.run(self.command(words), capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(shown.returncode, status, shown)
        return shown.stdout if status == 0 else shown.stderr

    def check_live(self):
        self.assertEqual([self.source_of(name) for name in ("velodynelogger", "seriallogger")], ["live", "live"])

    def test_a_session_from_begin_to_end(self):
        self.assertIn("nothing is being recorded", self.ctl("record mark early", status=1))
        self.ctl("record start run1")
        wait_for("packets", lambda: "packets" in self.ctl("record status"))
        self.assertRegex(self.ctl("record status"), r"\nvelodynelogger +recording .* nothing *\n")
        self.assertIn('"run1" is being recorded', self.ctl("record start run2", status=1))
        self.assertRegex(self.ctl("record mark door"), r"at \[s\] +mark\n\d\S* +door\n$")
        self.assertRegex(self.ctl("record list"), r"run1 +20\S+ +\S+ \w+ +recorder, .* being recorded")
        self.assertRegex(self.ctl("record stop"), r"\nvelodynelogger +stopped .* packets \d+.* nothing *\n")
        self.assertIn('"text":"door"', text_of(os.path.join(self.robot.records, "run1", "seriallogger-events.jsonl")))
        self.assertIn('has a recording "run1" already', self.ctl("record start run1", status=1))
        self.assertRegex(self.ctl("session info run1"), r"velodynelogger/scan2d +\d+ +0 ")
        self.assertIn("run1", self.ctl("session explain run1 --at 0.01"))
        for path in self.ctl("session export run1 --format csv --topics velodynelogger/scan2d").splitlines():
            self.assertTrue(os.path.exists(path), path)
        logger = self.robot.ports["seriallogger"]
        for line in (f"replay --recorder 127.0.0.1:{self.robot.ports['recorder']} ru", f"call 127.0.0.1:{logger} source.open recording="):
            self.assertIn("run1", subprocess.check_output([HERMESCTL, "complete", "hermesctl " + line], text=True))
        self.assertRegex(self.ctl("session rename run1 run2"), r"\nrun2 ")
        self.assertIn("--yes removes it", self.ctl("session remove run2", status=1))
        self.ctl("session remove run2 --yes")
        self.assertFalse(os.path.exists(os.path.join(self.robot.records, "run2")))
        self.assertEqual(self.ctl("session list"), "")

    def test_a_replay_and_who_shows_it(self):
        self.ctl("record start run1")
        self.wait_for_messages(400)
        self.ctl("record stop")
        self.ctl("replay run1 --loop --speed 0.1 --detach")
        wait_for("the replay", lambda: self.source_of("seriallogger") == "replay")
        self.ctl("session live")
        self.check_live()
        far, near = pty.openpty()
        replay = subprocess.Popen(self.command("replay run1 --loop --speed 0.5"), stderr=near)
        self.addCleanup(replay.kill)
        os.close(near)
        shown = b""
        while not re.search(rb"replaying, second \d+ of \d+", shown):
            shown += os.read(far, 100000)  # raises when the program ends
        os.close(far)
        replay.send_signal(signal.SIGINT)
        self.assertEqual(replay.wait(20), 0)
        self.check_live()
        with subprocess.Popen(self.command("replay run1 --speed 0.1 --json"), stdout=subprocess.PIPE, stderr=subprocess.PIPE) as killed:
            self.assertIn(b'"replay":', killed.stdout.readline())
            progress = [json.loads(killed.stderr.readline())["progress"] for _ in range(3)]
            killed.kill()
        self.assertEqual(len({one["total"] for one in progress}), 1)
        self.assertEqual([one["done"] for one in progress], sorted(one["done"] for one in progress))
        self.assertRegex(self.ctl("session status"), r"run1 +replaying")
        self.assertNotIn("replaying", self.ctl("session live"))

    def test_a_bag_of_ros(self):
        """What it tells is what was recorded, read by nothing of the project's own."""
        self.ctl("record start run1")
        self.wait_for_messages(400)
        self.ctl("record stop")
        self.assertIn("expected ros2 with mcap", self.ctl("session export run1 --format csv --profile ros2", status=1))
        (bag,) = self.ctl("session export run1 --format mcap --profile ros2").splitlines()
        (plain,) = self.ctl("session export run1 --format mcap").splitlines()
        told = mcap_reader.Mcap(bag)
        self.assertEqual(told.profile, "ros2")
        topics = {}
        for message in told.messages:
            channel = told.channels[message.channel]
            kind = told.schemas[channel.schema].name
            self.assertEqual((channel.encoding, channel.metadata["topic_type_hash"]), ("cdr", ros_cdr.type_hash(kind.replace("/msg/", "/"))))
            self.assertIn("durability", channel.metadata["offered_qos_profiles"])
            topics.setdefault(channel.topic, []).append((message.log_time, ros_cdr.decode(kind.replace("/msg/", "/"), message.data)))
        self.assertLessEqual({"/scan", "/odom", "/tf", "/tf_static", "/pose", "/map", "/map_walls", "/battery", "/fix", "/joint_states",
                              "/diagnostics", "/robot_description"}, set(topics))
        recorded = mcap_reader.Mcap(plain)
        of = lambda topic: [json.loads(m.data) for m in recorded.messages if recorded.channels[m.channel].topic == topic]  # noqa: E731
        odometry = of("motorcontrol/odometry")
        self.assertEqual(len(topics["/odom"]), len(odometry))
        for (_, ros), hermes in zip(topics["/odom"], odometry):
            position, turned = ros["pose"]["pose"]["position"], ros["pose"]["pose"]["orientation"]
            self.assertEqual((position["x"], position["y"]), (hermes["pose"]["x"], hermes["pose"]["y"]))
            self.assertAlmostEqual(2 * math.atan2(turned["z"], turned["w"]), hermes["pose"]["theta"], 6)
            self.assertEqual(ros["twist"]["twist"]["linear"]["x"], hermes["twist"]["vx"])
        scans = of("velodynelogger/scan2d")
        self.assertLessEqual(len(scans) - len(topics["/scan"]), 1)  # one that is partial may not tell how many rays there are
        for time, scan in topics["/scan"]:
            stamp = scan["header"]["stamp"]
            self.assertAlmostEqual(time * 1e-9, stamp["sec"] + stamp["nanosec"] * 1e-9, 1)
            self.assertEqual(len(scan["ranges"]), len(topics["/scan"][0][1]["ranges"]))
        cells = topics["/map"][-1][1]
        self.assertEqual(len(cells["data"]), cells["info"]["width"] * cells["info"]["height"])
        self.assertEqual(set(cells["data"]) | {-1, 0, 100}, {-1, 0, 100})

    def test_what_is_wrong_is_told(self):
        self.ctl("record start run1")
        self.wait_for_messages(100)
        self.robot.kill("seriallogger")
        self.assertIn("seriallogger: it took part, and does not answer", self.ctl("record stop", status=1))
        self.ctl("replay run1 --speed 10")  # what is there
        os.remove(glob.glob(os.path.join(self.robot.records, "run1", "*.pcap"))[0])
        told = self.ctl("replay run1", status=1)
        self.assertIn("velodynelogger: ", told)
        self.assertIn("0001.pcap: cannot be read", told)
        self.assertEqual(self.source_of("velodynelogger"), "live")


if __name__ == "__main__":
    unittest.main()
