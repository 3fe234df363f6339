#!/usr/bin/env python3
"""Scanners of one plane on their serial lines, as emulators made from the makers' documents alone speak: found by themselves, the
map of the demo's room, damage that is counted, a cable that is pulled, a recording that is the same scans again."""
import json
import math
import os
import shutil
import subprocess
import tempfile
import time
import unittest

from recorded_robot import Driver
from support import BINARIES, WORLD, Daemon, Listener, Process, free_port, text_of, wait_for

EDGES = json.loads(text_of(WORLD))["edges"]
ALL = """ld06 stl27l rplidar-a1 rplidar-a3 rplidar-c1 rplidar-s2 ydlidar-x2 ydlidar-x4 ydlidar-tmini ydlidar-tg30
sick-tim551 sick-tim571 sick-lms111 hokuyo-urg04lx hokuyo-ust10lx"""
MODELS = os.environ.get("HERMES_SCANNERS", "ld06 rplidar-a1").replace("all", ALL).split()
RAYS = {"sick-tim551": 360, "sick-tim571": 1080, "sick-lms111": 720, "hokuyo-urg04lx": 1024, "hokuyo-ust10lx": 1440,
        "ld06": 450}  # in a full revolution, of which a sweep is a part
PULLS = int(os.environ.get("HERMES_KILLS", "3"))
SECONDS = float(os.environ.get("HERMES_SECONDS", "0"))
NAMES = {"sick-tim551": "sick-tim5xx", "sick-tim571": "sick-tim5xx", "sick-lms111": "sick-lms1xx"}  # as the daemon has them
CHECKED = ("ld", "stl", "rplidar-a", "rplidar-s", "ydlidar", "hokuyo")  # models whose packets have a checksum


def wall_distance(x, y):
    best = math.inf
    for x1, y1, x2, y2 in EDGES:
        dx, dy = x2 - x1, y2 - y1
        k = min(1.0, max(0.0, ((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy)))
        best = min(best, math.hypot(x1 + k * dx - x, y1 + k * dy - y))
    return best


class Scanners(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.line = os.path.join(self.folder, "laser")

    def begin(self, name, **settings):
        process = Process(BINARIES, name, free_port(0), self.folder, settings)
        self.addCleanup(process.stop)
        return process, process.connect()

    def scanner_of(self, model, told="auto", **settings):
        port = free_port(0) if model.startswith("sick") else 0
        self.simulated, self.simulator = self.begin("simulator", **{
            "world": WORLD, "scanner.model": model, "scanner.link": self.line, "scanner.port": port, "scanner.x_m": 0.1,
            "lidar.port": free_port(0), **settings})
        self.process, self.scanner = self.begin("scanner", **{
            "scanner.url": f"tcp://127.0.0.1:{port}" if port else f"serial://{self.line}", "scanner.model": NAMES.get(told, told),
            "record.folder": self.folder, "record.free_floor_bytes": 0, "record.free_warn_bytes": 0})
        begun = time.monotonic()
        wait_for(f"a revolution of {model}", lambda: self.state()["revolutions"] > 2)
        print(f"{model}, {told}: measures after {time.monotonic() - begun:.1f} s")
        self.assertIn(self.state()["model"], (NAMES.get(model, model), "sick-lms1xx", None))  # null: several speak alike

    def state(self):
        return self.scanner.call("source.status")

    def health(self):
        return next(item for item in self.scanner.call("daemon.status")["health"] if item["name"] == "scanner")

    @staticmethod
    def counted(state):
        return state["revolutions"] + state["partial"] + state["missed"]

    def turned(self):
        return self.simulator.call("sim.state")["scanner"]["revolutions"]

    def fault(self, kind, share=0.1):
        self.simulator.call("sim.fault", device="scanner", kind=kind, share=share)

    def points(self, messages, begin):
        """In the world, of a robot that stands at begin."""
        x, y, theta = begin
        c, s = math.cos(theta), math.sin(theta)
        for message in messages:
            for px, py in zip(message["data"]["x"], message["data"]["y"]):
                yield x + c * (px + 0.1) - s * py, y + s * (px + 0.1) + c * py

    def test_map_of_the_room(self):
        for model in MODELS:
            with self.subTest(model):
                self.scanner_of(model)
                turned, seen = self.turned(), self.state()["revolutions"]
                begin = json.loads(text_of(WORLD))["poses"][0]
                scans = Listener(self.process.port, "scan2d")
                scans.wait(5)
                still = list(scans.messages)
                if model in RAYS:
                    self.assertEqual(still[-1]["data"]["rays"], RAYS[model])
                far = sorted(wall_distance(x, y) for x, y in self.points(still, begin))
                self.assertGreater(len(far), 1000)
                print(f"{model}: points are {1e3 * far[len(far) // 2]:.1f} mm off the walls, the median; 98 % {1e3 * far[int(0.98 * len(far))]:.1f}")
                self.assertLess(far[int(0.98 * len(far))], 0.05)  # four sigma, and how the format rounds
                matcher, state = self.begin("scanmatcher", **{
                    "source.address": f"127.0.0.1:{self.process.port}", "sensor.x_m": 0.1, "matcher.start": "mapping", "map.folder": self.folder})
                wait_for("scans", lambda: state.call("matcher.state")["scans"] > 3)  # pylint: disable=cell-var-from-loop
                truths, poses = Listener(self.simulated.port, "truth"), Listener(matcher.port, "pose")
                self.simulator.call("sim.drive")
                poses.wait(120)
                self.simulator.call("sim.halt")
                self.check_poses(poses.messages, truths.messages)
                self.check_map(state.call("map.get")["edges"], begin)
                scanner = self.state()
                self.assertEqual(scanner["lost"], 0, scanner)
                self.assertLessEqual(abs(self.turned() - turned - (scanner["revolutions"] - seen)), 2, scanner)
                self.assertEqual(self.health()["level"], "ok", self.health())
                for cleanup in range(len(self._cleanups) - 1):  # but the folder
                    function, args, kwargs = self._cleanups.pop()
                    function(*args, **kwargs)

    def test_rays_are_those_of_a_full_revolution(self):
        self.scanner_of("hokuyo-ust10lx", told="hokuyo-ust10lx")  # of which its sweep, from 225 to 135 degrees, is a part
        scans = Listener(self.process.port, "scan2d")
        scans.wait(1)
        self.assertEqual(scans.messages[0]["data"]["rays"], RAYS["hokuyo-ust10lx"])

    def test_found_among_those_alike(self):
        for model in ("ydlidar-tmini", "hokuyo-ust10lx"):  # others of the same speed come first
            with self.subTest(model):
                self.scanner_of(model)
                self.assertEqual(self.state()["model"], model)
                self.assertEqual(self.state()["damaged"], 0)
                self.doCleanups()
                self.setUp()

    def check_poses(self, poses, truths):
        """Where the matcher has the scanner, against where it truly is; relative to the first."""
        def at(stamp):
            return min(truths, key=lambda message: abs(message["stamp"] - stamp))["data"]
        errors = []
        first = None
        for message in poses[5::10]:
            pose, truth = message["data"], at(message["stamp"])
            true = (truth["x"] + 0.1 * math.cos(truth["theta"]), truth["y"] + 0.1 * math.sin(truth["theta"]), truth["theta"])
            first = first or (pose, true)
            turn = first[1][2] - first[0]["theta"]
            dx, dy = pose["x"] - first[0]["x"], pose["y"] - first[0]["y"]
            x = first[1][0] + math.cos(turn) * dx - math.sin(turn) * dy
            y = first[1][1] + math.sin(turn) * dx + math.cos(turn) * dy
            errors.append(math.hypot(x - true[0], y - true[1]))
        print(f"poses of {len(errors)} scans: at most {1e3 * max(errors):.1f} mm off")
        self.assertLess(max(errors), 0.05)

    def check_map(self, segments, begin):
        x, y, theta = begin
        c, s = math.cos(theta), math.sin(theta)
        x, y = x + 0.1 * c, y + 0.1 * s  # the map begins where the scanner was
        far = []
        for segment in segments:
            steps = 1 + int(10 * math.hypot(segment["x2"] - segment["x1"], segment["y2"] - segment["y1"]))  # by its length
            for k in ((i + 0.5) / steps for i in range(steps)):
                px, py = (segment[a] + k * (segment[b] - segment[a]) for a, b in (("x1", "x2"), ("y1", "y2")))
                far.append(wall_distance(x + c * px - s * py, y + s * px + c * py))
        far.sort()
        print(f"map of {len(segments)} segments: 95 % within {1e3 * far[int(0.95 * len(far))]:.1f} mm of a wall, all within "
              f"{1e3 * far[-1]:.1f} mm")
        self.assertGreater(len(segments), 10)
        self.assertLess(far[int(0.95 * len(far))], 0.02)

    def test_pulled_and_put_back(self):
        self.scanner_of(MODELS[-1], told=MODELS[-1])
        slowest = 0.0
        for _ in range(PULLS):
            self.fault("pulled")
            wait_for("notice", lambda: self.state()["line"] == "closed")
            wait_for("a reason", lambda: self.health()["level"] == "error")
            self.fault("none")
            wait_for("the line", lambda: self.state()["line"] == "open")
            back, before = time.monotonic(), self.state()["revolutions"]
            wait_for("revolutions", lambda: self.state()["revolutions"] > before)  # pylint: disable=cell-var-from-loop
            slowest = max(slowest, time.monotonic() - back)
        print(f"{PULLS} times pulled: scans again after {slowest:.2f} s at most")
        self.assertLess(slowest, 2)

    def test_damage_is_counted(self):
        for model in MODELS:
            with self.subTest(model):
                self.scanner_of(model, told=model)
                scans = Listener(self.process.port, "scan2d")
                scans.wait(2)
                state = self.state()
                self.fault("corrupt", 0.3 * state["packets"] / state["bytes"])  # about every third packet
                wait_for("damage", lambda: self.state()["damaged"] > 20)
                lost = self.state()["skipped_bytes"]
                self.fault("corrupt", 0.1)  # of the bytes: hardly a packet is whole
                wait_for("more damage", lambda: self.state()["skipped_bytes"] > lost + 5000)  # pylint: disable=cell-var-from-loop
                self.fault("none")
                count = self.state()["revolutions"] + 3
                wait_for("whole revolutions", lambda: self.state()["revolutions"] > count)  # pylint: disable=cell-var-from-loop
                self.assertGreaterEqual(self.state()["lost"], self.state()["damaged"] // 2)
                if model.startswith(CHECKED):  # which two flips may outwit, but not in a scan of which nothing else is missing
                    begin = json.loads(text_of(WORLD))["poses"][0]
                    whole = [message for message in scans.messages if not message["data"]["partial"]]
                    self.assertGreater(len(whole), 5)
                    false = sum(wall_distance(x, y) > 0.1 for x, y in self.points(whole, begin))
                    self.assertEqual(false, 0)
                self.doCleanups()
                self.setUp()

    def test_recording_is_the_same_scans(self):
        self.scanner_of(MODELS[-1])
        wait_for("what the recording must know", lambda: self.health()["level"] == "ok")
        live = Listener(self.process.port, "scan2d")
        live.wait(2)
        self.scanner.call("record.start", name="drive")
        live.wait(15)
        done = self.scanner.call("record.stop")
        self.assertEqual(set(done["losses"].values()), {0}, done)
        stream = Daemon(port=self.process.port, timeout=20)
        self.addCleanup(stream.close)
        scans = stream.subscribe("scan2d", queue=1000)
        self.scanner.call("source.open", recording="drive", speed=0)
        again = []
        while len(again) < 8:
            message = next(scans)
            if message["data"].get("replayed"):
                again.append(message["data"])
        beams = {tuple(message["data"]["x"]): message["data"]["stamp"] for message in live.messages}
        same = [scan for scan in again if tuple(scan["x"]) in beams]
        self.assertGreater(len(same), 4)
        for scan in same:
            self.assertLess(abs(beams[tuple(scan["x"])] - scan["stamp"]), 0.02)  # the host's clock is found anew
        wait_for("the end", lambda: self.state()["source"]["state"] == "ended")
        wait_for("who plays it", lambda: "played to its end" in self.health()["message"])
        self.scanner.call("source.open", live=True)
        self.assertEqual(self.state()["source"]["state"], "live")

    def test_recording_tells_its_scanner_from_its_beginning(self):
        _, scanner = self.begin("scanner", **{"scanner.url": f"serial://{self.line}", "scanner.model": "ld06", "record.folder": self.folder,
                                              "record.free_floor_bytes": 0, "record.free_warn_bytes": 0})
        scanner.call("record.start", name="at once")  # before the daemon has looked after itself for the first time
        sidecar = json.loads(text_of(os.path.join(self.folder, "at once", "scanner.json")))
        self.assertEqual([file.get("scanner") for file in sidecar["files"]], ["ld06"], sidecar)

    def test_recording_keeps_what_its_first_bytes_need(self):
        def needed():
            return json.loads(text_of(os.path.join(self.folder, "two", "scanner.json")))["files"][0]["prerequisite"]
        self.scanner_of("hokuyo-urg04lx", told="hokuyo-urg04lx")
        self.scanner.call("record.start", name="two")
        first, begin = needed(), self.state()["revolutions"]
        self.simulated.stop()
        self.begin("simulator", **{"world": WORLD, "scanner.model": "hokuyo-ust10lx", "scanner.link": self.line, "lidar.port": free_port(0)})
        wait_for("revolutions of another one", lambda: self.state()["revolutions"] > begin + 60)  # 1.5 s
        self.scanner.call("record.stop")
        self.assertTrue(first.startswith("1024 "), first)
        self.assertEqual(needed(), first)

    def test_what_a_replay_leaves_out_is_not_missed(self):
        self.scanner_of(MODELS[0])
        self.scanner.call("record.start", name="drive")
        begin = self.state()["revolutions"]
        wait_for("revolutions", lambda: self.state()["revolutions"] > begin + 40)
        self.scanner.call("record.stop")
        self.scanner.call("source.open", recording="drive")
        wait_for("some of them again", lambda: self.state()["revolutions"] > 5)
        self.scanner.call("source.seek", t_s=3)
        wait_for("the end", lambda: self.state()["source"]["state"] == "ended")
        self.assertLess(self.state()["revolutions"], 30)
        self.assertEqual(self.state()["missed"], 0)

    def test_line_must_be_one_of_the_model(self):
        for model, url, is_right in (("sick-tim5xx", "serial:///dev/ttyUSB0", False), ("sick-tim5xx", "tcp://192.168.0.1:2112", True),
                                     ("ld06", "serial:///dev/ttyUSB0", True)):
            with self.subTest(model=model, url=url):
                checked = subprocess.run([os.path.join(BINARIES, "hermes-scanner"), "--check", "--set", f"scanner.model={model}",
                                          "--set", f"scanner.url={url}"], check=False, stderr=subprocess.PIPE, text=True)
                self.assertEqual(checked.returncode == 0, is_right, checked.stderr)
                self.assertEqual("has no serial line" in checked.stderr, not is_right, checked.stderr)

    def test_rests_when_its_daemon_has_ended(self):
        self.scanner_of("rplidar-a3", told="rplidar-a3")
        before = len(text_of(self.process.log_name))
        self.process.stop()
        self.assertNotIn("warning", text_of(self.process.log_name)[before:])  # that it ends is no fault of the line
        wait_for("standstill", self.is_still)

    def is_still(self):
        before = self.turned()
        time.sleep(0.5)  # five revolutions
        return self.turned() == before

    def test_session_is_mapped_again(self):
        motors = os.path.join(self.folder, "motors")
        self.scanner_of(MODELS[0], told=MODELS[0], **{"motors.link": motors})
        line = f"serial://{motors}?baud=115200"
        base, control = self.begin("motorcontrol", **{"controllers.1.url": line, "controllers.2.url": line})
        wait_for("the wheels", lambda: control.call("motor.state")["ready"])
        _, recorder = self.begin("recorder", **{
            "daemons": json.dumps([f"127.0.0.1:{port}" for port in (self.process.port, base.port)]), "record.folder": self.folder,
            "record.free_floor_bytes": 0, "record.free_warn_bytes": 0})
        wait_for("the daemons", lambda: "2 daemons" in str(recorder.call("daemon.status")["health"]))
        recorder.call("session.start", name="drive")
        driver, begin = Driver(base.port, "anna", vx=0.4, omega=0.4), self.state()["revolutions"]
        wait_for("revolutions", lambda: self.state()["revolutions"] > begin + 40)
        driver.end()
        stopped = recorder.call("session.stop")
        self.assertEqual({part["daemon"] for part in stopped["parts"]}, {"scanner", "recorder"})
        self.assertEqual({part["state"] for part in stopped["parts"]}, {"stopped"})
        done = subprocess.run([os.path.join(BINARIES, "hermes-vector"), "map", os.path.join(self.folder, "drive"), "--force"], check=True,
                              stdout=subprocess.PIPE, cwd=self.folder)
        summary = json.loads(done.stdout)
        self.assertGreater(summary["scans"], 30)
        self.assertGreaterEqual(summary["by_odometry"], summary["scans"] - summary["skipped"] - 2, summary)
        (log,) = recorder.call("session.export", name="drive", format="carmen")["paths"]
        with open(log, encoding="ascii") as file:
            self.assertGreater(sum(text.startswith("ROBOTLASER1") for text in file), 30)

    @unittest.skipUnless(SECONDS, "takes its time: with ./check --all")
    def test_no_revolution_is_lost(self):
        self.scanner_of(MODELS[-1])
        begin = self.state()
        told = self.turned()
        until = time.monotonic() + SECONDS
        while time.monotonic() < until:
            now = self.state()  # a client that is silent for long is given up
            print(f"{until - time.monotonic():.0f} s left: {self.turned() - told} revolutions, "
                  f"{self.counted(now) - self.counted(begin)} seen or missed, {now['missed']} of them missed", flush=True)
            time.sleep(10)
        end = self.state()
        turned = self.turned() - told
        seen, missed = self.counted(end) - self.counted(begin), end["missed"] - begin["missed"]
        print(f"{turned} revolutions, {seen - missed} seen, {missed} missed, {end['lost']} packets lost")
        self.assertLessEqual(abs(turned - seen), 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
