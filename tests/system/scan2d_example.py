#!/usr/bin/env python3
"""docs/examples/ld06.py, simulated_ld06.py and scan2d.py: the sensor's packets, its clock on a busy computer, and the way from a
serial line over hermes-scanmatcher to a map."""
import json
import math
import os
import pty
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import tty
import unittest
from unittest import mock

from support import BINARIES, SLOWNESS, SOURCE, WORLD, Daemon, Process, free_port, wait_for

EXAMPLES = os.path.join(SOURCE, "docs", "examples")
sys.path.insert(0, EXAMPLES)
import ld06  # noqa: E402

# The example of the sensor's manual.
PACKET = bytes.fromhex("542C6808AB7EE000E4DC00E2D900E5D500E3D300E4D000E9CD00E4CA00E2C700E9C500E5C200E5C000E5BE823A1A50")
MOUNT = (0.12, -0.05, 0.4)


def packet(degrees, milliseconds, millimetres=1000):
    data = ld06.HEAD + struct.pack("<HH", 3600, round(100 * degrees)) + struct.pack("<HB", millimetres, 200) * ld06.POINTS
    data += struct.pack("<HH", round(100 * ((degrees + 8.8) % 360)), milliseconds % 30000)
    return data + bytes([ld06.crc8(data)])


class PacketTest(unittest.TestCase):
    def test_the_packet_of_the_manual(self):
        self.assertTrue(ld06.is_packet(PACKET))
        for i in range(len(PACKET)):
            self.assertFalse(ld06.is_packet(PACKET[:i] + bytes([PACKET[i] ^ 1]) + PACKET[i + 1:]), i)

    def test_packets_among_other_bytes(self):
        far, near = pty.openpty()
        tty.setraw(near)
        for data in (PACKET[:20], PACKET[20:] + b"\x54\x2c" + PACKET, b"x" + PACKET[:46] + b"\x00" + PACKET + b"\x54"):
            os.write(far, data)
        with mock.patch("ld06.open_port", lambda *_: near), mock.patch("ld06.termios.tcflush"):
            packets = ld06.read_packets("")
            self.assertEqual([next(packets) for _ in range(3)], [PACKET] * 3)
            os.close(far)
            with self.assertRaises(OSError):
                next(packets)

    def turns(self, sent, moments=None):
        """What read_scans() makes of these packets, each read at its moment of a steady clock that is 5,000 s behind the other."""
        clock = mock.Mock()
        clock.monotonic.side_effect = moments or [1000 + 12 / 4500 * i for i in range(len(sent))]
        clock.time.side_effect = lambda: 5000 + self.now
        steady = clock.monotonic

        def monotonic():
            self.now = steady()
            return self.now
        clock.monotonic = monotonic
        with mock.patch("ld06.read_packets", lambda _: iter(sent)), mock.patch("ld06.time", clock):
            return list(ld06.read_scans(""))

    def spin(self, count, missing=()):
        return [packet(9.6 * i % 360, round(1000 * 12 / 4500 * i)) for i in range(count) if i not in missing]

    def test_whole_turns_counter_clockwise(self):
        turns = self.turns(self.spin(150))
        self.assertEqual([len(points) for _, points in turns], [444, 456])
        stamp, points = turns[0]
        angles, ranges, seconds = zip(*points)
        self.assertEqual(set(ranges), {1.0})
        self.assertTrue(all(a > b for a, b in zip(angles, angles[1:])))  # clockwise is downward
        self.assertTrue(all(a < b for a, b in zip(seconds, seconds[1:])))
        self.assertAlmostEqual(seconds[-1], (len(points) - 1) / 4500, 4)
        self.assertAlmostEqual(angles[-1] - angles[0], -2 * math.pi * seconds[-1] / 0.1, 2)
        self.assertAlmostEqual(turns[1][0] - stamp, len(points) / 4500, 2)

    def test_a_turn_with_a_gap_is_left_out(self):
        self.assertEqual(len(self.turns(self.spin(150, missing=range(50, 60)))), len(self.turns(self.spin(150))) - 1)

    def test_a_head_that_is_held_makes_no_turn(self):
        moments = [1000 * 12 / 4500 * i for i in range(2300)]
        angles = [9.6 * min(i, max(100, i - 2000)) % 360 for i in range(2300)]  # held for 5.3 s
        sent = [packet(angle, round(moment)) for angle, moment in zip(angles, moments)]
        turns = [len(points) for _, points in self.turns(sent)]
        self.assertGreater(len(turns), 4)
        self.assertLess(max(turns), 500)

    def test_late_readings_do_not_change_the_stamps(self):
        sent = self.spin(1000)
        due = [1000 + 12 / 4500 * i for i in range(len(sent))]
        late = [max(moment, 1001.5) if 1000.5 < moment else moment for moment in due]  # stood still for a second
        for (right, _), (found, _) in zip(self.turns(sent, due), self.turns(sent, late)):
            self.assertAlmostEqual(right, found, 2)

    def test_the_sensors_clock_begins_again(self):
        sent = [packet(9.6 * i % 360, 29900 + round(1000 * 12 / 4500 * i)) for i in range(200)]
        stamps = [stamp for stamp, _ in self.turns(sent)]
        self.assertTrue(all(0.08 < b - a < 0.12 for a, b in zip(stamps, stamps[1:])), stamps)

    def test_after_a_long_silence_the_newest_packet_counts(self):
        sent = self.spin(150)
        turns = self.turns(sent + sent, [1000 + 12 / 4500 * i for i in range(150)] + [2000 + 12 / 4500 * i for i in range(150)])
        self.assertAlmostEqual(turns[-1][0], 7000.4, 0)


class ScannerTest(unittest.TestCase):
    """The whole way, on a simulated robot."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder, self.link = folder.name, os.path.join(folder.name, "laser")
        self.simulator_port, self.port = free_port(0), free_port(0)
        self.daemon("simulator", self.simulator_port, {"world": WORLD})
        self.simulator = self.simulators.connect()
        self.start_sensor()
        self.publisher = self.example("scan2d.py", "--port", self.port, "--set", f"device={self.link}")
        self.laser = wait_for("the publisher", self.connect)
        self.addCleanup(self.laser.close)

    def daemon(self, name, port, settings):
        process = Process(BINARIES, name, port, self.folder, settings)
        self.addCleanup(process.stop)
        setattr(self, name + "s", process)

    def example(self, name, *arguments):
        process = subprocess.Popen([sys.executable, os.path.join(EXAMPLES, name), *map(str, arguments)],
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def start_sensor(self):
        self.sensor = self.example("simulated_ld06.py", WORLD, self.link, "--port", self.simulator_port, "--mount", *MOUNT)
        wait_for("the sensor's line", lambda: os.path.exists(self.link))

    def connect(self):
        try:
            return Daemon(port=self.port)
        except OSError:
            return None

    def scanner(self):
        return next((item for item in self.laser.call("daemon.status")["health"] if item["name"] == "scanner"), None)

    def test_a_map_grows_and_the_pose_is_right(self):
        matcher_port = free_port(0)
        self.daemon("scanmatcher", matcher_port, {"source.address": f"127.0.0.1:{self.port}"})
        matcher = self.scanmatchers.connect()
        self.addCleanup(matcher.close)
        wait_for("a map", lambda: matcher.call("matcher.state")["matched"] > 3)
        begin = self.simulator.call("sim.state")["pose"]
        segments = matcher.call("matcher.state")["map_segments"]
        self.simulator.call("sim.drive")

        def wait_for_way(metres):
            wait_for("a way", lambda: math.dist((begin["x"], begin["y"]), [self.simulator.call("sim.state")["pose"][axis] for axis in "xy"]) > metres)
        wait_for_way(1)
        self.publisher.send_signal(signal.SIGSTOP)
        time.sleep(0.7)  # as on a busy computer
        self.publisher.send_signal(signal.SIGCONT)
        wait_for_way(2)
        wait_for("a larger map", lambda: matcher.call("matcher.state")["map_segments"] > segments)
        self.simulator.call("sim.halt")
        wait_for("standstill", lambda: abs(self.simulator.call("sim.state")["twist"]["vx"]) < 1e-6)
        count = matcher.call("matcher.state")["scans"]
        wait_for("scans of the robot that stands", lambda: matcher.call("matcher.state")["scans"] > count + 5)
        end, state = self.simulator.call("sim.state")["pose"], matcher.call("matcher.state")
        self.assertGreater(math.dist((begin["x"], begin["y"]), (end["x"], end["y"])), 2)
        self.assertGreaterEqual(state["matched"], 0.97 * state["scans"], state)
        self.assertEqual(state["refused"] + state["unknown_fields"], 0)
        pose = next(matcher.subscribe("pose"))["data"]
        x, y, theta = relative(mounted(begin), mounted(end))
        self.assertLess(math.dist((pose["x"], pose["y"]), (x, y)), 0.05, (pose, x, y))
        self.assertLess(abs(math.remainder(pose["theta"] - theta, 2 * math.pi)), 0.02)

    def test_what_is_wrong_with_the_device_is_told(self):
        wait_for("scans", lambda: self.scanner() and self.scanner()["level"] == "ok")
        scan = next(self.laser.subscribe("scan2d"))
        self.assertTrue(all(len(scan["data"][name]) == len(scan["data"]["x"]) for name in ("y", "t")))
        self.assertTrue(0 < time.time() - scan["stamp"] < 1 * SLOWNESS, scan["stamp"])
        self.laser.call("settings.set", values={"field_of_view_deg": 180, "upside_down": True})
        turned = next(self.laser.subscribe("scan2d"))["data"]
        self.assertAlmostEqual(turned["rays"], 2 * scan["data"]["rays"], delta=30)
        self.sensor.kill()
        fault = wait_for("the fault", lambda: self.scanner()["level"] == "error" and self.scanner())
        self.assertIn(self.link, fault["message"])
        os.remove(self.link)
        self.start_sensor()
        wait_for("scans", lambda: self.scanner()["level"] == "ok")


class UnreadableTest(unittest.TestCase):
    """A publisher whose messages are no JSON, because a number in them is not finite."""

    def publish(self, server):
        client, _ = server.accept()
        with client, client.makefile("r", encoding="utf-8") as lines:
            for line in lines:
                request = json.loads(line)
                reply = {"result": {"subscription": 1}} if request["method"] == "topics.subscribe" else {"error": {"code": -32601, "message": ""}}
                client.sendall(json.dumps({"jsonrpc": "2.0", "id": request["id"], **reply}).encode() + b"\n")
                if "result" in reply:
                    data = {"stamp": time.time(), "turn": 0, "x": [math.nan], "y": [0]}
                    message = {"subscription": 1, "topic": "scan2d", "seq": 1, "dropped": 0, "stamp": time.time(), "data": data}
                    client.sendall(json.dumps({"jsonrpc": "2.0", "method": "topic", "params": message}).encode() + b"\n")

    def test_the_matcher_says_so(self):
        with tempfile.TemporaryDirectory() as folder, socket.create_server(("127.0.0.1", 0)) as server:
            threading.Thread(target=self.publish, args=(server,), daemon=True).start()
            process = Process(BINARIES, "scanmatcher", free_port(0), folder, {"source.address": f"127.0.0.1:{server.getsockname()[1]}"})
            self.addCleanup(process.stop)
            with process.connect() as matcher:
                def source():
                    health = matcher.call("daemon.status")["health"]
                    return next(item["message"] for item in health if item["name"] == "source")
                wait_for("the complaint", lambda: "1 messages could not be read, the last: " in source())


def mounted(pose):
    """Where the sensor is in the world."""
    c, s = math.cos(pose["theta"]), math.sin(pose["theta"])
    return pose["x"] + c * MOUNT[0] - s * MOUNT[1], pose["y"] + s * MOUNT[0] + c * MOUNT[1], pose["theta"] + MOUNT[2]


def relative(a, b):
    """The pose b in the frame of a."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return c * (b[0] - a[0]) + s * (b[1] - a[1]), c * (b[1] - a[1]) - s * (b[0] - a[0]), b[2] - a[2]


if __name__ == "__main__":
    unittest.main()
