#!/usr/bin/env python3
"""The tour of the demo: its driver alone, in a corridor of mere numbers, who helps it on after a fault, and as a program with a
small loop. With HERMES_TOUR=whole it goes through the whole floor."""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from unittest import mock

from support import BINARIES, SOURCE, DaemonError, Process, free_port, simulated_hall, wait_for, put, text_of

sys.path.insert(0, os.path.join(SOURCE, "deploy", "demo"))
import attendant  # noqa: E402
import run  # noqa: E402
import tour  # noqa: E402
from drive import DriveError, PathFollower, PoseTopic, drive  # noqa: E402

RUN = os.path.join(SOURCE, "deploy", "demo", "run.py")
WHOLE = os.environ.get("HERMES_TOUR") == "whole"
# A ring of corridors, 2.4 m wide, round a block.
RING = [[0, 0, 14, 0], [14, 0, 14, 10], [14, 10, 0, 10], [0, 10, 0, 0],
        [2.4, 2.4, 2.4, 7.6], [2.4, 7.6, 11.6, 7.6], [11.6, 7.6, 11.6, 2.4], [11.6, 2.4, 2.4, 2.4]]
ROUND = [[3, 1.2, 0], [12, 1.2, 0], [12.8, 2, 1.571], [12.8, 8, 1.571], [12, 8.8, 3.1416], [2, 8.8, 3.1416], [1.2, 8, -1.571],
         [1.2, 2, -1.571], [2, 1.2, 0], [4, 1.2, 0]]


def seen(walls, x, y, theta):
    """What the lidar sees there, in the robot's frame."""
    xs, ys = [], []
    for ray in range(0, 360, 2):
        c, s = math.cos(theta + math.radians(ray)), math.sin(theta + math.radians(ray))
        distance = math.inf
        for x1, y1, x2, y2 in walls:
            across = c * (y2 - y1) - s * (x2 - x1)
            if abs(across) > 1e-12:
                along = ((x1 - x) * s - (y1 - y) * c) / across
                ahead = ((x1 - x) * (y2 - y1) - (y1 - y) * (x2 - x1)) / across
                if 0 <= along <= 1 and 0 < ahead < distance:
                    distance = ahead
        if distance < math.inf:
            xs.append(distance * math.cos(math.radians(ray)))
            ys.append(distance * math.sin(math.radians(ray)))
    return xs, ys


def to_wall(walls, x, y):
    def distance(x1, y1, x2, y2):
        dx, dy = x2 - x1, y2 - y1
        along = min(1, max(0, ((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy)))
        return math.hypot(x - x1 - along * dx, y - y1 - along * dy)
    return min(distance(*wall) for wall in walls)


class View:
    """The lidar of a robot of mere numbers."""

    points = None

    def obstacles(self):
        return self.points


class DriverTest(unittest.TestCase):
    def setUp(self):
        self.now = 0.0
        patch = mock.patch.object(tour.time, "monotonic", lambda: self.now)
        patch.start()
        self.addCleanup(patch.stop)

    def drive(self, walls, error, limit_s=90):
        """Round the ring with poses that are wrong by so much; gives the last place and the nearest that it came to a wall."""
        view = View()
        follower = tour.CarefulFollower(PathFollower(ROUND, 1.5, turn_rate=1.4, look_ahead=1.0), view)
        x, y, theta = ROUND[0]
        speed, turn, nearest = 0.0, 0.0, math.inf
        while self.now < limit_s:
            view.points = tour.obstacles(*seen(walls, x, y, theta))
            velocity = follower.command(x + error[0], y + error[1], theta)
            if velocity is None:
                return (x, y), nearest
            speed += min(max(velocity[0] - speed, -0.1), 0.1)  # the motor control's accelerations
            turn += min(max(velocity[1] - turn, -0.3), 0.3)
            theta += 0.1 * turn
            x, y = x + 0.1 * speed * math.cos(theta), y + 0.1 * speed * math.sin(theta)
            nearest = min(nearest, to_wall(walls, x, y))
            self.now += 0.1
        raise AssertionError(f"not at the end after {limit_s} s, but at {x:.2f}, {y:.2f}, {100 * follower.progress:.0f} %")

    def test_drives_round(self):
        place, nearest = self.drive(RING, (0, 0))
        self.assertLess(math.dist(place, ROUND[-1][:2]), 0.3)
        self.assertGreater(nearest, 0.5)

    def test_a_map_that_is_wrong_leads_into_no_wall(self):
        for error in ((1, 0), (-1, 0.5), (0.5, -0.8)):
            with self.subTest(error):
                self.now = 0.0
                _, nearest = self.drive(RING, error)
                self.assertGreater(nearest, 0.4)

    def test_stands_where_nothing_leads_on(self):
        blocked = RING + [[7, 0, 7, 2.4]]
        with self.assertRaisesRegex(DriveError, "no way forward for 20 s"):
            self.drive(blocked, (0, 0))

    def test_a_pause_takes_no_patience(self):
        view = View()
        view.points = [(0.5 * math.cos(math.radians(a)), 0.5 * math.sin(math.radians(a))) for a in range(0, 360, 4)]
        follower = tour.CarefulFollower(PathFollower([(0, 0), (9, 0)]), view)
        for self.now in [t / 2 for t in range(20)] + [60 + t / 2 for t in range(20)]:
            self.assertEqual(follower.command(0, 0, 0), (0.0, 0.0))
        with self.assertRaisesRegex(DriveError, "no way forward"):
            for self.now in [70 + t / 2 for t in range(10)]:
                follower.command(0, 0, 0)

    def test_stands_without_a_scan(self):
        view = View()
        follower = tour.CarefulFollower(PathFollower([(0, 0), (9, 0)]), view)
        self.assertEqual(follower.command(0, 0, 0), (0.0, 0.0))
        view.points = []  # nothing in sight
        self.assertGreater(follower.command(0, 0, 0)[0], 0.3)
        view.points = [(0.6, 0.0)]  # somebody
        self.assertLess(follower.command(0, 0, 0)[0], 0.2)
        view.points = [(0.5, y / 10) for y in range(-30, 31)]  # a wall
        self.assertEqual(follower.command(0, 0, 0)[0], 0.0)
        view.points = [(0.5 * math.cos(math.radians(a)), 0.5 * math.sin(math.radians(a))) for a in range(0, 360, 4)]
        self.assertEqual(follower.command(0, 0, 0), (0.0, 0.0))

    def test_an_old_scan_shows_nothing(self):
        view = tour.FreeView.__new__(tour.FreeView)
        for age, points in ((0.1, [(1, 1)]), (1, None), (-1, None)):
            view.newest = time.time() - age, [(1, 1)]
            self.assertEqual(view.obstacles(), points)
        view.newest = None
        self.assertIsNone(view.obstacles())

    def steady(self, told):
        """What is steered by, for poses [(seconds, x, theta, corrected)] of a robot that drives along x at 1 m/s."""
        poses = tour.SteadyPoses.__new__(tour.SteadyPoses)
        poses.left, poses.told, poses.stamp = (0.0, 0.0, 0.0), None, None
        steered = []
        for seconds, x, theta, corrected in told:
            self.now = seconds
            poses.newest = seconds, {"corrected": corrected}, {"vx": 1.0, "vy": 0.0, "omega": 0.0}
            with mock.patch.object(PoseTopic, "now", lambda _, pose=(x, 0.0, theta): pose):
                steered.append(poses.now())
        return steered

    def test_without_leaps_the_pose_is_what_is_told(self):
        told = [(t / 20, t / 20, 0.0, False) for t in range(20)]
        steered = self.steady(told)
        self.assertEqual([place[0] for place in steered], [x for _, x, _, _ in told])

    def test_a_correction_is_taken_over_bit_by_bit(self):
        for size, corrected in ((-0.8, True), (0.8, False), (0.1, True)):
            with self.subTest(size=size, corrected=corrected):
                told = [(t / 20, t / 20 + size * (t >= 20), 0.0, corrected and t == 20) for t in range(200)]
                steered = self.steady(told)
                for before, after in zip(steered, steered[1:]):
                    self.assertLess(abs(after[0] - before[0] - 0.05), 0.04 * abs(size) + 1e-9)
                self.assertAlmostEqual(steered[-1][0], told[-1][1], delta=0.01)


def refusal(code, halted=""):
    return DriveError(DaemonError({"code": code, "message": "refused"}), halted)


class AttendantTest(unittest.TestCase):
    def helped(self, error, *latched, pose=lambda: 0, ready=True):
        """An attendant of a robot that was held by these causes, and what the motor control was told."""
        told, left = [], list(latched)

        def call(command, **_):
            told.append(command)
            if command == "motor.reset_estop":
                left.pop(0)
            return {"ready": ready, "latched": dict.fromkeys(left[:1], "a reason")}
        motors, simulator = mock.Mock(), mock.Mock()
        motors.call, simulator.call = call, lambda _: {"pose": pose()}
        helper = attendant.Attendant(motors, simulator)
        with mock.patch.object(attendant, "STILL_S", 0.1), mock.patch.object(attendant, "PATIENCE_S", 0.5), \
                mock.patch("builtins.print"):
            helper.help(error)
        return helper, told

    def test_waits_for_controllers_that_were_silent(self):
        helper, told = self.helped(refusal(attendant.DEVICE_FAULT))
        self.assertEqual((helper.pauses, helper.releases, told), (1, 0, ["motor.state"]))
        with self.assertRaises(DriveError):
            self.helped(refusal(attendant.DEVICE_FAULT), ready=False)

    def test_releases_what_a_fault_holds(self):
        helper, told = self.helped(refusal(attendant.DEVICE_FAULT), "controller_1", "encoder")
        self.assertEqual((helper.pauses, helper.releases), (1, 2))
        self.assertEqual(told.count("motor.reset_estop"), 2)

    def test_releases_no_robot_that_moves(self):
        places = iter(range(1000))
        with self.assertRaisesRegex(DriveError, "does not come to a stand"):
            self.helped(refusal(attendant.DEVICE_FAULT), "controller_1", pose=lambda: next(places))

    def test_what_a_person_stopped_stays_stopped(self):
        for error, latched in ((refusal(attendant.DEVICE_FAULT, "stopped by the operator"), "controller_1"),
                               (refusal(attendant.DEVICE_FAULT), "estop"), (refusal(attendant.DEVICE_FAULT), "battery"),
                               (DriveError("no way forward"), "controller_1")):
            with self.subTest(error=error, latched=latched), self.assertRaises(DriveError):
                self.helped(error, latched)

    @unittest.skipIf("TSAN_OPTIONS" in os.environ, "the simulator does not keep its pace under the thread sanitizer")
    def test_a_controller_that_did_not_obey(self):
        """Simulator and motor control are true: the second controller keeps its set-point, whatever it hears, for two seconds."""
        with tempfile.TemporaryDirectory(prefix="hermes-test-") as folder:
            hall, link = simulated_hall(folder)
            self.addCleanup(hall.stop)
            simulator = hall.connect()
            line = f"serial://{link}?baud=115200"
            control = Process(BINARIES, "motorcontrol", free_port(0), folder,
                              {"controllers.1.url": line, "controllers.2.url": line})
            self.addCleanup(control.stop)
            motors = control.connect()
            wait_for("the motor control is ready", lambda: motors.call("motor.state")["ready"])

            def disturb(follower):
                if follower.progress > 0.3 and not disturbed:
                    disturbed.append(threading.Timer(2, mend))
                    disturbed[0].start()
                    simulator.call("sim.fault", device="controller2", kind="latched")
                    raise DriveError(DaemonError({"code": attendant.CONTROL_LOST, "message": "told to stand"}))

            def mend():
                with hall.connect() as connection:
                    connection.call("sim.fault", device="controller2", kind="none")

            disturbed, helper = [], attendant.Attendant(motors, simulator)
            follower = PathFollower([(0, 0), (3, 0)])
            while True:
                try:
                    drive(motors, PoseTopic("odometry", port=control.port), follower, "test", disturb)
                    break
                except DriveError as error:
                    if "told to stand" in str(error):
                        wait_for("a fault holds the robot", lambda: motors.call("motor.state")["latched"])
                    helper.help(error)
            self.assertGreater(helper.releases, 0)


class EndTest(unittest.TestCase):
    def test_a_drive_that_does_not_come_on_ends(self):
        follower, seen = mock.Mock(progress=0.0), []
        look = run.watched(seen.append, limit_s=0.05)
        for step in range(5):  # slowly, but on
            follower.progress = step / 10
            look(follower)
            time.sleep(0.03)
        with self.assertRaisesRegex(RuntimeError, "not come on .* 40 % of its path"):
            while True:
                look(follower)
        self.assertGreater(len(seen), 5)


@unittest.skipIf("TSAN_OPTIONS" in os.environ, "the simulator does not keep its pace under the thread sanitizer")
class TourTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="hermes-test-")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_tour(self, *arguments, limit_s):
        out = os.path.join(self.folder, "out")
        told = subprocess.run([sys.executable, RUN, "--tour", "--no-window", "--out", out, *arguments], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=limit_s, check=False)
        self.assertEqual(told.returncode, 0, told.stdout + told.stderr)
        summary = json.loads(text_of(os.path.join(out, "summary.json")))
        self.assertEqual((summary["lost"], summary["dropped"], summary["touched"]), (0, 0, 0), summary)
        self.assertEqual(set(summary["exit_status"].values()), {0})
        self.assertGreater(summary["final_drift_m"], 0.2)
        return summary

    @unittest.skipIf(WHOLE, "the whole tour instead")
    def test_one_loop_with_people(self):
        world = os.path.join(self.folder, "ring.json")
        put(world, {"name": "ring", "edges": RING, "poses": ROUND, "people": [[1, 13.5, 3, 13.5, 9], [1, 1.9, 9.5, 9, 9.5]]})
        summary = self.run_tour("--world", world, limit_s=120)
        self.assertLess(summary["final_error_m"], 0.05)

    @unittest.skipUnless(WHOLE, "takes five minutes; HERMES_TOUR=whole")
    def test_the_whole_floor(self):
        summary = self.run_tour(limit_s=400)
        self.assertLess(summary["final_error_m"], 0.05)
        self.assertGreater(summary["closures"], 0)
        self.assertLess(summary["seconds"], 320)


if __name__ == "__main__":
    unittest.main(verbosity=2)
