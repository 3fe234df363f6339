#!/usr/bin/env python3
"""docs/examples/drive.py: its path follower alone, and as a program that drives a simulated robot, is refused, interrupted, and
left without poses."""
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

from support import BINARIES, SOURCE, Daemon, Process, free_port, release, simulated_hall, wait_for
import drive  # of docs/examples

PROGRAM = os.path.join(SOURCE, "docs", "examples", "drive.py")


class FollowerTest(unittest.TestCase):
    def follow(self, points, pose, limit_s=120):
        """The places where a robot without lag goes; the follower must end by itself."""
        follower = drive.PathFollower(points, speed=0.8, turn_rate=1.2)
        x, y, theta = pose
        places = []
        for _ in range(round(limit_s / drive.PERIOD_S)):
            velocity = follower.command(x, y, theta)
            if velocity is None:
                self.assertEqual(follower.progress, 1)
                return places
            self.assertTrue(0 <= velocity[0] <= 0.8 and abs(velocity[1]) <= 1.2 + 1e-9, velocity)
            theta += velocity[1] * drive.PERIOD_S
            x += math.cos(theta) * velocity[0] * drive.PERIOD_S
            y += math.sin(theta) * velocity[0] * drive.PERIOD_S
            places.append((x, y))
        raise AssertionError(f"not at the end after {limit_s} s, but at {x:.2f}, {y:.2f}, {100 * follower.progress:.0f} %")

    def test_reaches_the_end(self):
        eight = [(3 * math.sin(t / 10), 2 * math.sin(t / 5)) for t in range(63)]  # crosses itself
        for name, points in (("straight", [(0, 0), (4, 0)]), ("corners", [(0, 0), (2, 0), (2, 2), (0, 2)]),
                             ("back", [(0, 0), (2, 0), (0, 0)]), ("twice", [(0, 0), (0, 0), (2, 1), (2, 1)]), ("eight", eight)):
            for heading in (0, 2, math.pi):
                with self.subTest(name, heading=heading):
                    places = self.follow(points, (0, 0, heading))
                    self.assertLess(math.dist(places[-1], points[-1]), 0.06)

    def test_keeps_to_the_path(self):
        square = [(0, 0), (3, 0), (3, 3)]
        for x, y in self.follow(square, (0, 0, 0)):
            self.assertLess(min(abs(y) if x <= 3 else 9, abs(x - 3) if y >= 0 else 9), 0.2, (x, y))

    def test_tightest_bend(self):
        drive.PathFollower([(0, 0), (1, 0)], least_radius=1).command(1, 0.15, 0)
        with self.assertRaisesRegex(drive.DriveError, "0.25 m beside its last point: no tighter bend than of 1.00 m"):
            drive.PathFollower([(0, 0), (1, 0)], least_radius=1).command(1, 0.25, 0)

    def test_bad_points(self):
        for points in ([], [(1, 1)], [(0, 0), (math.nan, 0)], [(0, 0), (math.inf, 0)]):
            with self.assertRaises(ValueError):
                drive.PathFollower(points)
        self.assertIsNone(drive.PathFollower([(1, 1), (1, 1)]).command(5, 5, 0))


class DriveTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        simulator, link = simulated_hall(cls.folder.name)
        cls.addClassCleanup(simulator.stop)
        cls.simulator = simulator.connect()
        line = f"serial://{link}?baud=115200"
        cls.motor_process = Process(BINARIES, "motorcontrol", free_port(0), cls.folder.name,
                                    {"controllers.1.url": line, "controllers.2.url": line})
        cls.addClassCleanup(cls.motor_process.stop)
        cls.port = cls.motor_process.port
        cls.motors = cls.motor_process.connect()

    def setUp(self):
        release(self.motors)
        wait_for("readiness of the controllers", lambda: self.motors.call("motor.state")["ready"])
        wait_for("standstill", self.stands)
        self.simulator.call("sim.place", x=0, y=0, theta=0)
        self.motors.call("odometry.reset")

    def place(self):
        pose = self.simulator.call("sim.state")["pose"]
        return pose["x"], pose["y"]

    def stands(self):
        return self.motors.call("motor.state")["twist"] == {"vx": 0, "vy": 0, "omega": 0}

    def run_program(self, *arguments):
        return subprocess.Popen([sys.executable, PROGRAM, "--motors", f"127.0.0.1:{self.port}", *arguments],
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def end(self, process, limit_s=30):
        out, err = process.communicate(timeout=limit_s)
        wait_for("standstill", self.stands, 1.5)
        self.assertFalse(self.motors.call("control.state")["held"])
        return process.returncode, out, err

    def test_arrives(self):
        status, out, err = self.end(self.run_program("--speed", "0.8", "1.5,0", "1.5,1.5"))
        self.assertEqual((status, out.split()[-1:]), (0, ["arrived"]), err)
        self.assertLess(math.dist(self.place(), (1.5, 1.5)), 0.08)

    def test_interrupt_stops_the_robot(self):
        for number, expected in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            process = self.run_program("8,0")
            wait_for("driving", lambda: not self.stands())
            process.send_signal(number)
            status, _, err = self.end(process, 5)
            self.assertEqual(status, expected, err)
        self.assertLess(self.place()[0], 4)

    def test_refusals_name_their_reason(self):
        with Daemon(port=self.port) as other:
            other.call("control.acquire", client="joystick", timeout_s=30)
            process = self.run_program("2,0")
            _, err = process.communicate(timeout=10)
            self.assertEqual(process.returncode, 1)
            self.assertIn("joystick holds the control", err)
        self.motors.call("motor.estop")
        status, _, err = self.end(self.run_program("2,0"))
        self.assertEqual(status, 1)
        self.assertIn("emergency stop", err)
        release(self.motors)
        status, _, err = self.end(self.run_program("--speed", "5", "2,0"))
        self.assertEqual(status, 1)
        self.assertIn("expected a number from -1 to 1 m/s", err)
        self.assertLess(math.dist(self.place(), (0, 0)), 1e-6)

    def test_a_stop_by_another_ends_the_drive(self):
        process = self.run_program("8,0")
        wait_for("driving", lambda: not self.stands())
        self.motors.call("motor.stop")
        status, _, err = self.end(process, 5)
        self.assertEqual(status, 1)
        self.assertIn("does not hold the control", err)
        self.assertIn("stopped by", err)

    def test_nobody_there(self):
        port = free_port(0)
        process = subprocess.run([sys.executable, PROGRAM, "--motors", f"127.0.0.1:{port}", "1,0"], capture_output=True,
                                 text=True, timeout=20, check=False)
        self.assertEqual(process.returncode, 1)
        self.assertEqual(process.stderr, f"drive.py: hermes-motorcontrol: no daemon answers at 127.0.0.1:{port}: Connection refused. "
                                         "Start it, or name its address: drive.py --help\n")
        process = subprocess.run([sys.executable, PROGRAM, "--motors", f"127.0.0.1:{self.port}", "--matcher", f"127.0.0.1:{port}", "1,0"],
                                 capture_output=True, text=True, timeout=20, check=False)
        self.assertEqual(process.returncode, 1)
        self.assertIn(f"hermes-scanmatcher: no daemon answers at 127.0.0.1:{port}", process.stderr)
        for arguments in (["1;0"], [], ["--motors", "nowhere", "1,0"]):
            self.assertEqual(subprocess.run([sys.executable, PROGRAM, *arguments], capture_output=True, check=False).returncode, 2)

    def test_without_controllers_it_says_so(self):
        absent = "serial:///dev/absent?baud=115200"
        motors = Process(BINARIES, "motorcontrol", free_port(0), self.folder.name,
                         {"controllers.1.url": absent, "controllers.2.url": absent})
        self.addCleanup(motors.stop)
        motors.connect().close()
        process = subprocess.run([sys.executable, PROGRAM, "--motors", f"127.0.0.1:{motors.port}", "1,0"], capture_output=True,
                                 text=True, timeout=20, check=False)
        self.assertEqual(process.returncode, 1)
        self.assertIn(f"topic odometry of 127.0.0.1:{motors.port}: no pose comes", process.stderr)
        self.assertIn("controller_1: ", process.stderr)
        self.assertIn("/dev/absent", process.stderr)
        self.assertEqual(len(process.stderr.splitlines()), 1)

    def test_without_poses_it_stops(self):
        poses = drive.PoseTopic("odometry", port=self.port)
        wait_for("a pose", poses.now)
        seen = time.monotonic() + 1
        blinded = mock.Mock(now=lambda: poses.now() if time.monotonic() < seen else None)
        blinded.name, blinded.fault = "topic pose", poses.fault
        with Daemon(port=self.port) as client, self.assertRaisesRegex(drive.DriveError, r"topic pose: no pose of the last 0\.5 s: the last one is -?0\.\d s old"):
            drive.drive(client, blinded, drive.PathFollower([(0, 0), (8, 0)], 0.5),
                        watch=lambda _: self.assertTrue(time.monotonic() < seen + 1.5 or self.stands()))
        self.assertLess(self.place()[0], 1.5)
        self.assertGreater(self.place()[0], 0.1)

    def test_late_commands_move_nothing(self):
        poses = mock.Mock(now=lambda: (0, 0, 0))
        now = time.time
        with Daemon(port=self.port) as client, mock.patch("drive.time.time", lambda: now() - 1), \
                self.assertRaisesRegex(drive.DriveError, "come too late"):
            drive.drive(client, poses, drive.PathFollower([(0, 0), (8, 0)]))
        self.assertLess(math.dist(self.place(), (0, 0)), 1e-6)


if __name__ == "__main__":
    unittest.main(verbosity=2)
