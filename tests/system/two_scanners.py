#!/usr/bin/env python3
"""A robot with two scanners of 200 degrees, one ahead and one at the back, in the demo's room: one map of both within 2 cm, poses at
least as good as by the first alone, and what happens when the second is pulled and put back. With a number it is a scanner."""
import bisect
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import time
import unittest

from scanners import EDGES, wall_distance
from support import BINARIES, SOURCE, WORLD, Daemon, Listener, Process, free_port, text_of, wait_for

sys.path.insert(0, os.path.join(SOURCE, "docs", "examples"))
from hermes_daemon import Daemon as Publisher  # noqa: E402

MOUNTS = ((0.25, 0.0, 0.0), (-0.25, 0.05, math.pi))
PERIODS = (0.1, 0.14)
FIELD, STEP = math.radians(200), math.radians(1)
POSES = json.loads(text_of(WORLD))["poses"]
SPEED, EASE_S, STAND_S, DRIVE_S = 0.8, 1.0, 1.0, 23.0
WAYS = [0.0]
for (x1, y1, _), (x2, y2, _) in zip(POSES, POSES[1:]):
    WAYS.append(WAYS[-1] + math.hypot(x2 - x1, y2 - y1))


def robot_at(seconds):
    """It speeds up, and follows the poses of the world along cubic curves."""
    way = SPEED * (seconds * seconds / (2 * EASE_S) if seconds < EASE_S else seconds - EASE_S / 2)
    way = min(max(way, 0.0) if seconds > 0 else 0.0, WAYS[-1] - 1e-6)
    i = bisect.bisect_right(WAYS, way) - 1
    (xa, ya, a), (xb, yb, b), long = POSES[i], POSES[i + 1], WAYS[i + 1] - WAYS[i]
    k = (way - WAYS[i]) / long
    weights = (2 * k**3 - 3 * k**2 + 1, (k**3 - 2 * k**2 + k) * long, 3 * k**2 - 2 * k**3, (k**3 - k**2) * long)
    slopes = (6 * k**2 - 6 * k, (3 * k**2 - 4 * k + 1) * long, 6 * k - 6 * k**2, (3 * k**2 - 2 * k) * long)
    x, dx = (sum(w * v for w, v in zip(s, (xa, math.cos(a), xb, math.cos(b)))) for s in (weights, slopes))
    y, dy = (sum(w * v for w, v in zip(s, (ya, math.sin(a), yb, math.sin(b)))) for s in (weights, slopes))
    return x, y, math.atan2(dy, dx)


def compose(pose, inner):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return pose[0] + c * inner[0] - s * inner[1], pose[1] + s * inner[0] + c * inner[1], pose[2] + inner[2]


def range_along(x, y, angle):
    c, s, best = math.cos(angle), math.sin(angle), math.inf
    for x1, y1, x2, y2 in EDGES:
        dx, dy = x2 - x1, y2 - y1
        across = c * dy - s * dx
        if abs(across) > 1e-9:
            away = ((x1 - x) * dy - (y1 - y) * dx) / across
            if 0 < away < best and 0 <= ((x1 - x) * s - (y1 - y) * c) / across <= 1:
                best = away
    return best


def measured(number, noise, begin):
    """Ray after ray while the robot moves, with noise of 1 cm."""
    x, y, t = [], [], []
    for i in range(round(FIELD / STEP) + 1):
        angle, seconds = -FIELD / 2 + i * STEP, 0.8 * PERIODS[number] * i * STEP / FIELD
        place = compose(robot_at(begin + seconds - STAND_S), MOUNTS[number])
        away = range_along(place[0], place[1], place[2] + angle) + noise.gauss(0, 0.01)
        x.append(round(away * math.cos(angle), 4))
        y.append(round(away * math.sin(angle), 4))
        t.append(round(seconds, 5))
    return {"rays": 360, "x": x, "y": y, "t": t}


def be_scanner(number, port):
    """All is computed before, as a busy machine would be late."""
    noise, period, turn = random.Random(number), PERIODS[number], 0
    stamps = [0.03 * number + turn * period for turn in range(round(DRIVE_S / period))]
    scans = [measured(number, noise, stamp) for stamp in stamps]
    scanner = Publisher(f"laser{number}", "Laser scanner", settings={
        "period_s": {"type": "number", "default": 0.01, "description": "Of publishing"},
        "begin": {"type": "number", "default": 0, "description": "When it begins, since the epoch; 0: never"},
        "pulled": {"type": "boolean", "default": False, "description": "Nothing is published"}}, topics={"scan2d": "Scans"})

    def work():
        nonlocal turn
        begin = scanner.settings["begin"]
        while begin and turn < len(scans) and time.time() > begin + stamps[turn] + period:
            if not scanner.settings["pulled"]:
                scanner.publish("scan2d", {"stamp": begin + stamps[turn], "turn": turn, **scans[turn]}, begin + stamps[turn])
            turn += 1
    sys.argv[1:] = ["--port", str(port)]
    scanner.run(work, port=port)


class TwoScanners(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def matcher(self, **settings):
        folder = tempfile.mkdtemp(dir=self.folder.name)
        process = Process(BINARIES, "scanmatcher", free_port(0), folder, {
            "source.address": f"127.0.0.1:{self.ports[0]}", "sensor.x_m": MOUNTS[0][0], "map.folder": folder, **settings})
        self.addCleanup(process.stop)
        return process, process.connect()

    def scanner(self, number):
        program = subprocess.Popen([sys.executable, __file__, str(number), str(self.ports[number])])
        self.addCleanup(program.wait)
        self.addCleanup(program.terminate)

    def test_one_map_of_both(self):
        self.ports = [free_port(0), free_port(0)]
        for number in (0, 1):
            self.scanner(number)
        both, state = self.matcher(**{
            "source2.address": f"127.0.0.1:{self.ports[1]}", "sensor2.x_m": MOUNTS[1][0], "sensor2.y_m": MOUNTS[1][1],
            "sensor2.theta_rad": MOUNTS[1][2]})
        alone, lone = self.matcher()
        wait_for("the scanners", lambda: all(source["connected"] for daemon in (state, lone) for source in daemon.call("matcher.state")["sources"]))
        scanners = [Daemon(port=port) for port in self.ports]
        begin = time.time()
        for scanner in scanners:
            self.addCleanup(scanner.close)
            scanner.call("settings.set", values={"begin": begin})
        poses = [Listener(process.port, "pose") for process in (both, alone)]
        second = lambda: state.call("matcher.state")["sources"][1]  # noqa: E731
        health = lambda: next(item for item in state.call("daemon.status")["health"] if item["name"] == "source2")  # noqa: E731
        wait_for("trial", lambda: second().get("use") == "taken", 20)
        print(f"taken after {time.time() - begin - STAND_S:.1f} s of driving")
        scanners[1].call("settings.set", values={"pulled": True})
        pulled, matched = time.monotonic(), state.call("matcher.state")["matched"]
        wait_for("notice", lambda: health()["level"] == "warn" and "no scan from" in health()["message"], 5)
        print(f"told after {time.monotonic() - pulled:.1f} s")
        self.assertLess(time.monotonic() - pulled, 2)
        wait_for("scans of the first", lambda: state.call("matcher.state")["matched"] > matched + 20, 5)
        scanners[1].call("settings.set", values={"pulled": False})
        paired = second()["paired"]
        wait_for("both again", lambda: second()["paired"] > paired + 5 and health()["level"] == "ok", 5)
        wait_for("the end of the drive", lambda: time.time() > begin + DRIVE_S + 0.5, 40)
        errors = [self.errors(listener.messages, begin) for listener in poses]
        maps = [self.off_walls(daemon.call("map.get")["edges"]) for daemon in (state, lone)]
        for name, found, off in zip(("both", "alone"), errors, maps):
            print(f"{name}: poses {1e3 * sum(found) / len(found):.1f} mm off, {1e3 * max(found):.1f} at most; {0.1 * len(off):.1f} m, "
                  f"median {1e3 * off[len(off) // 2]:.1f} mm off, 95 % {1e3 * off[int(0.95 * len(off))]:.1f}")
        end = state.call("matcher.state")
        self.assertEqual((end["lost"], end["matched"]), (0, end["scans"]), end)
        self.assertLess(maps[0][int(0.95 * len(maps[0]))], 0.02)
        self.assertLess(maps[0][len(maps[0]) // 2], 0.001 + maps[1][len(maps[1]) // 2])
        self.assertLess(sum(errors[0]) / len(errors[0]), max(0.01, 1.1 * sum(errors[1]) / len(errors[1])))

    def errors(self, poses, begin):
        start = compose(robot_at(0), MOUNTS[0])
        errors = []
        for message in poses:
            data = message["data"]
            x, y, _ = compose(start, (data["x"], data["y"], 0))
            true = compose(robot_at(message["stamp"] - begin - STAND_S), MOUNTS[0])
            errors.append(math.hypot(x - true[0], y - true[1]))
        return errors

    def off_walls(self, segments):
        start = compose(robot_at(0), MOUNTS[0])
        far = []
        for segment in segments:
            steps = 1 + int(10 * math.hypot(segment["x2"] - segment["x1"], segment["y2"] - segment["y1"]))
            for k in ((i + 0.5) / steps for i in range(steps)):
                x, y, _ = compose(start, tuple(segment[a] + k * (segment[b] - segment[a]) for a, b in (("x1", "x2"), ("y1", "y2"))) + (0,))
                far.append(wall_distance(x, y))
        return sorted(far)


if __name__ == "__main__":
    if sys.argv[1:2] in (["0"], ["1"]):
        be_scanner(int(sys.argv[1]), int(sys.argv[2]))
    else:
        unittest.main(verbosity=2)
