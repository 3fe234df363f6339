#!/usr/bin/env python3
"""What a session of a whole robot tells afterwards: why the robot stopped, the map of its drive, files for other tools."""
import json
import math
import os
import subprocess
import sys
import unittest

from recorded_robot import RecordedRobot
from support import BINARIES, release, wait_for


class Reports(RecordedRobot):
    def setUp(self):
        super().setUp()
        self.motors = self.robot.daemons["motorcontrol"]

    def stopped_by(self, name, stop):
        """What the recorder explains of a drive that this ends."""
        self.call("session.start", name=name)
        driver = self.drive(vx=0.4, omega=0.3)
        stop(driver)
        wait_for("the halt", lambda: self.motors.call("motor.state")["halted"])
        driver.end()
        self.wait_for_messages(100)  # what comes after it
        self.call("session.stop")
        return self.call("session.explain", name=name)["text"]

    def test_causes_are_named(self):
        simulator = self.robot.daemons["simulator"]
        causes = {
            "time-out": (lambda driver: driver.silent.set(), ("Cause: time-out", "no command for")),
            "take-over": (lambda driver: self.motors.call("control.acquire", client="bert", take_over=True, timeout_s=5),
                          ("Cause: take-over", "bert took the control over from anna")),
            "stop": (lambda driver: self.motors.call("motor.stop", client="window"), ("Cause: STOP", "stopped by window")),
            "estop": (lambda driver: self.motors.call("motor.estop", client="window"), ("Cause: STOP", "emergency stop by window")),
            "controller": (lambda driver: simulator.call("sim.fault", device="controller2", kind="silence"),
                           ("Cause: lost controller", "does not answer")),
            "battery": (lambda driver: simulator.call("sim.fault", device="battery", kind="charge", share=0.01),
                        ("Cause: low battery", "the battery has"))}
        for name, (stop, expected) in causes.items():
            with self.subTest(name):
                text = self.stopped_by(name, stop)
                for words in (*expected, "anna drove until then"):
                    self.assertIn(words, text)
                self.assertRegex(text, r"Commanded last: 0\.40 m/s ahead, 0\.00 m/s to the left, 0\.30 rad/s")
                self.assertRegex(text, r"Measured last:  0\.[2-6]\d m/s ahead")  # a machine that stalls reads the wheels late
                self.assertEqual(text.count("Cause:"), 1)
                if os.environ.get("HERMES_SHOW"):
                    print(text, file=sys.stderr)
            if name == "take-over":
                self.motors.call("control.release")
            if name == "estop":
                release(self.motors)
            if name == "controller":
                simulator.call("sim.fault", device="controller2", kind="none")
                wait_for("the controller", lambda: self.motors.call("motor.state")["ready"])
        self.assertIn("motor.estop", self.call("session.info", name="estop")["stops"][-1])

    def test_map_of_a_session_is_the_live_one(self):
        self.call("session.start", name="drive")
        driver = self.drive(vx=0.4, omega=0.3)
        begin = self.robot.daemons["scanmatcher"].call("matcher.state")["scans"]
        wait_for("scans", lambda: self.robot.daemons["scanmatcher"].call("matcher.state")["scans"] > begin + 60)
        driver.end()
        self.call("session.stop")
        folder = os.path.join(self.robot.records, "drive")
        info = self.call("session.info", name="drive")
        self.assertGreater(info["driven_m"], 1)
        self.assertEqual(info["summary"]["problems"], [])
        (live,) = self.call("session.export", name="drive", format="tum")["paths"]
        out = os.path.join(folder, "mapped.tum")
        done = subprocess.run([os.path.join(BINARIES, "hermes-vector"), "map", folder, "--loops", "leave", "--out-trajectory", out],
                              check=True, stdout=subprocess.PIPE)
        summary = json.loads(done.stdout)
        self.assertGreater(summary["scans"], 60)
        # A machine that stalls reads the wheels late: there the odometry has gaps.
        self.assertGreater(summary["by_odometry"], 0.6 * (summary["scans"] - summary["skipped"]))
        self.assertLess(self.farthest(self.poses(live), self.poses(out)), 0.01)
        for form, least in (("csv", 15), ("carmen", 1), ("mcap", 1), ("pcap", 1)):
            told = self.call("session.export", name="drive", format=form)
            self.assertGreaterEqual(len(told["paths"]), least)
            self.assertTrue(all(os.path.getsize(path) > 0 for path in told["paths"]))
            self.assertEqual(told["problems"], [])
        log = self.call("session.export", name="drive", format="carmen")["paths"][0]
        subprocess.run([os.path.join(BINARIES, "hermes-vector"), "map", log, "--summary", os.devnull, "--force"], check=True)

    @staticmethod
    def poses(path):
        with open(path, encoding="utf-8") as file:
            rows = [[float(word) for word in line.split()] for line in file if not line.startswith("#")]
        return {round(row[0], 4): (row[1], row[2], 2 * math.atan2(row[6], row[7])) for row in rows}

    def farthest(self, live, mapped):
        """Distance of the poses of a scan, where the first is in place; metres."""
        both = sorted(set(live) & set(mapped))
        self.assertGreater(len(both), 0.9 * len(mapped), (sorted(live)[:3], sorted(mapped)[:3]))
        a, b = live[both[0]], mapped[both[0]]
        turn = a[2] - b[2]
        worst = 0.0
        for stamp in both:
            dx, dy = mapped[stamp][0] - b[0], mapped[stamp][1] - b[1]
            x = a[0] + math.cos(turn) * dx - math.sin(turn) * dy
            y = a[1] + math.sin(turn) * dx + math.cos(turn) * dy
            worst = max(worst, math.hypot(x - live[stamp][0], y - live[stamp][1]))
        return worst


if __name__ == "__main__":
    unittest.main()
