#!/usr/bin/env python3
"""Whatever happens to a device or the clock, the service stays up, the robot stands, hermesctl list, the health items that the window
shows and the journal name what, where, what was found and what was expected; when the cause is gone all goes on by itself."""
import os
import re
import socket
import struct
import threading
import time
import unittest

from robot import Talker
from robot_case import INTERPOSED, RobotCase
from support import Daemon, DaemonError, wait_for

PACKET = 1206  # bytes of a Velodyne data packet
SENTENCE = b"$GPGGA,120000,4916.45,N,12311.12,W,1,08,0.9,545.4,M,46.9,M,,*55\r\n"
NOISE = bytes((37 * i * i + 11 * i) % 256 for i in range(499))


class BadInput(RobotCase):
    def test_devices_that_vanish(self):
        """Absent at the start, there, pulled while the robot drives, put back."""
        robot = self.robot_of()
        for name, words in {"motorcontrol": (self.wires["motors"], "no such device"),
                            "seriallogger": (self.wires["gps"], "no such device"),
                            "velodynelogger": (str(self.wires["lidar"]), "no packet")}.items():
            self.tells(name, *words)
        self.simulate()
        self.until_well("a robot that came after its daemons")
        for _ in range(2):
            self.drive(lambda: not self.stands())
            since = robot.journal_size()
            for device in ("line1", "gps"):
                self.simulator.call("sim.fault", device=device, kind="pulled")
            self.simulator.call("sim.fault", device="lidar", kind="silence")
            self.drive(self.stands)
            self.tells("motorcontrol", self.wires["motors"], "controller_1", since=since)
            self.tells("seriallogger", self.wires["gps"], "gps", since=since)
            self.tells("velodynelogger", str(self.wires["lidar"]), "no packet", since=since)
            for device in ("line1", "gps", "lidar"):
                self.simulator.call("sim.fault", device=device, kind="none")
            self.until_well("devices that are back")
            self.assertTrue(self.stands(), "it drove on by itself")
            for name in ("controller_1", "port gps", "lidar"):
                wait_for(f"{name} in the journal", lambda name=name: re.search(f"{name} is (ok|warn)", robot.written(since)), 10)

    def test_wrong_devices(self):
        """A GPS receiver, noise or nothing where the controllers are expected; these or noise where a receiver is; datagrams of
        others where a lidar is."""
        robot = self.robot_at_work()
        lines = {"a receiver": SENTENCE, "noise": NOISE, "nothing": b""}
        before = {"motorcontrol": dict(robot.settings["motorcontrol"]), "seriallogger": dict(robot.settings["seriallogger"])}
        for what, says in lines.items():
            with self.subTest(what):
                path = os.path.join(self.folder, "wrong")
                talker = Talker(path, says)
                try:
                    url = f"serial://{path}?baud=115200"
                    robot.write("motorcontrol", controllers={"1": {"url": url}, "2": {"url": url}})
                    since = robot.journal_size()
                    self.restart("motorcontrol")
                    self.tells("motorcontrol", path, "answer", since=since)
                    with self.assertRaises(DaemonError):
                        robot.call("motorcontrol", "motor.drive", vx=0.2)
                finally:
                    talker.close()
        robot.write("motorcontrol", **before["motorcontrol"])
        self.restart("motorcontrol")
        for what, says in {"noise": NOISE, "a talker of another kind": b"login: ", "nothing": b""}.items():
            with self.subTest(what):
                path = os.path.join(self.folder, "wrong")
                talker = Talker(path, says)
                try:
                    robot.write("seriallogger", ports=[{"name": "gps", "url": f"serial://{path}?baud=9600", "view": "nmea"}])
                    since = robot.journal_size()
                    self.restart("seriallogger")
                    words = ("no byte",) if not says else ("no NMEA sentence", "expected a GPS receiver")
                    self.tells("seriallogger", path, *words, since=since)
                finally:
                    talker.close()
        robot.write("seriallogger", **before["seriallogger"])
        self.restart("seriallogger")
        self.until_well("the right devices")

    def test_other_devices_under_the_same_names(self):
        """Pulled while the robot drives, then something else is plugged in and gets the name."""
        robot = self.robot_at_work()
        self.drive(lambda: not self.stands())
        since, devices = robot.journal_size(), {"line1": ("motors", SENTENCE), "gps": ("gps", NOISE)}
        for device in devices:
            self.simulator.call("sim.fault", device=device, kind="pulled")
        self.drive(self.stands)
        talkers = [Talker(self.wires[name], says) for name, says in devices.values()]
        try:
            self.tells("motorcontrol", self.wires["motors"], "answer", since=since)
            self.tells("seriallogger", self.wires["gps"], "no NMEA sentence", since=since)
            with Daemon(port=robot.ports["motorcontrol"]) as motors, self.assertRaisesRegex(DaemonError, "answer"):
                motors.call("control.acquire", timeout_s=2)
                motors.call("motor.drive", vx=0.2)
        finally:
            for talker in talkers:
                talker.close()
        for device in devices:
            self.simulator.call("sim.fault", device=device, kind="none")
        self.until_well("the right devices")
        self.assertTrue(self.stands(), "it drove on by itself")
        self.drive(lambda: not self.stands())

    def test_controllers_where_a_receiver_is_expected(self):
        """And the line of the one in the hands of the other."""
        robot = self.robot_at_work()
        before, since = list(robot.settings["seriallogger"]["ports"]), robot.journal_size()
        robot.write("seriallogger", ports=[{"name": "gps", "url": f"serial://{self.wires['motors']}?baud=115200", "view": "nmea"}])
        self.restart("seriallogger")
        self.tells("seriallogger", self.wires["motors"], "in use by another program", since=since)
        since = robot.journal_size()
        robot.call("supervisor", "process.stop", name="motorcontrol")
        self.tells("seriallogger", self.wires["motors"], "no byte", since=since, down="motorcontrol")
        since = robot.journal_size()
        robot.call("supervisor", "process.start", name="motorcontrol")
        wait_for("the motor control", lambda: robot.items("motorcontrol") is not None, 15)
        self.tells("motorcontrol", self.wires["motors"], "in use by another program", since=since)
        robot.write("seriallogger", ports=before)
        self.restart("seriallogger")
        self.until_well("each at its line")
        self.drive(lambda: not self.stands())

    def test_controllers_of_one_address(self):
        """On one line both answer whatever is asked, so that all wheels would turn by what is meant for two."""
        self.simulate(**{"motors.address2": 128})
        self.robot_of()
        self.tells("motorcontrol", "controller_2", self.wires["motors"], "0x81", "answer")
        begin, end = self.simulator.call("sim.state")["pose"], time.monotonic() + 5
        self.assertRegex(self.drive(lambda: time.monotonic() > end), "controller [12].*answer")
        self.assertEqual(self.simulator.call("sim.state")["pose"], begin)

    def test_one_line_under_two_names(self):
        """As that of a port and that of an adapter: it would be spoken to twice."""
        robot, other = self.robot_at_work(), os.path.join(self.folder, "by-id")
        os.symlink(self.wires["motors"], other)
        before, since = robot.settings["motorcontrol"]["controllers"], robot.journal_size()
        robot.write("motorcontrol", controllers={**before, "2": {"url": f"serial://{other}?baud=115200"}})
        self.restart("motorcontrol")
        self.tells("motorcontrol", "controller_2", other, "in use", since=since)

        def is_refused():  # for controller 1 as long as that has not answered
            with self.assertRaises(DaemonError) as refused:
                robot.call("motorcontrol", "motor.drive", vx=0.2)
            return re.search("controller 2.*in use", str(refused.exception))
        wait_for("controller 2 is named", is_refused)
        self.assertTrue(self.stands())
        robot.write("motorcontrol", controllers=before)
        self.restart("motorcontrol")
        self.until_well("one name")
        self.drive(lambda: not self.stands())

    def test_clock_set_back(self):
        """By an hour while the robot drives, and forth again: it drives on, and stands when it is told nothing; what was told by
        the other clock is refused."""
        clock = os.path.join(self.folder, "clock")

        def set_clock(ahead_s):
            with open(clock, "wb") as file:
                file.write(struct.pack("q", ahead_s))
        set_clock(0)
        robot = self.robot_at_work({**INTERPOSED, "HERMES_CLOCK": clock})
        for ahead_s in (-3600, 0):
            others = time.time() - 3600 - ahead_s
            with Daemon(port=robot.ports["motorcontrol"], timeout=10) as motors:
                wait_for("the controllers", lambda: motors.call("motor.state")["ready"], 10)
                motors.call("control.acquire", timeout_s=2)

                def go_on(until, motors=motors):
                    motors.call("motor.drive", vx=0.1)
                    return until()
                wait_for("the drive", lambda: go_on(lambda: not self.stands()), 10)
                with Daemon(port=robot.ports["motorcontrol"], timeout=10) as other:
                    stamps = (message["stamp"] for message in other.subscribe("odometry"))
                    first = next(stamps)
                    set_clock(ahead_s)
                    wait_for("the other time", lambda: go_on(lambda: abs(next(stamps) - first) > 3000), 10)
                begin = self.simulator.call("sim.state")["pose"]["x"]
                wait_for("a way", lambda: go_on(lambda: abs(self.simulator.call("sim.state")["pose"]["x"] - begin) > 0.05), 10)
                with self.assertRaisesRegex(DaemonError, "the clocks disagree"):
                    motors.call("motor.drive", vx=0.1, stamp=others)
                motors.call("motor.drive", vx=0.1)
                wait_for("the watchdog", self.stands, 3)
            self.until_well("another time")
        self.drive(lambda: not self.stands())

    def test_wrong_lidars(self):
        robot = self.robot_at_work()
        self.simulator.call("sim.fault", device="lidar", kind="silence")
        other = bytearray(PACKET)
        for block in range(12):
            other[100 * block:100 * block + 2] = b"\xff\xee"
        for what, packet, words in (("short packets", bytes(PACKET - 1), ("no data packets", "expected")),
                                    ("an unknown model", bytes(other[:-1]) + b"\x77", ("model 77 hex", "expected", "VLP-16 .22 hex"))):
            with self.subTest(what), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                self.restart("velodynelogger")
                since, is_over = robot.journal_size(), threading.Event()

                def send(sender=sender, packet=packet, is_over=is_over):
                    while not is_over.wait(0.005):
                        sender.sendto(packet, ("127.0.0.1", self.wires["lidar"]))
                thread = threading.Thread(target=send)
                thread.start()
                try:
                    self.tells("velodynelogger", "lidar", *words, since=since)
                finally:
                    is_over.set()
                    thread.join()
        self.simulator.call("sim.fault", device="lidar", kind="none")
        self.until_well("the lidar")

    def test_lidar_of_another_model(self):
        """Than the setting says: nothing is decoded."""
        robot = self.robot_at_work()
        robot.write("velodynelogger", decode={"model": "vlp16"})
        since = robot.journal_size()
        self.restart("velodynelogger")
        self.tells("velodynelogger", "error", "lidar", str(self.wires["lidar"]), "HDL-32E sends", "decode.model is vlp16", "expected",
                   since=since)
        robot.write("velodynelogger", decode={"model": "hdl32e"})
        self.restart("velodynelogger")
        self.until_well("the right model")

    def test_covered_lidar(self):
        """Packets at full rate, and nothing in them: a scan shows nothing, and the pose is only guessed."""
        robot = self.robot_at_work()
        wait_for("a map", lambda: robot.call("scanmatcher", "matcher.state")["matched"] > 5, 10)
        for dropouts, found in ((1, "0"), (0.999, r"[0-9]+")):
            since = robot.journal_size()
            self.simulator.call("sim.noise", dropouts=dropouts)
            self.tells("velodynelogger", "lidar", str(self.wires["lidar"]), f"only {found} of [0-9]+ beams", "expected.* 1 %", since=since)
            self.tells("scanmatcher", "tracking", "[0-9]+ scans in a row", "[01] line segments in [0-9]+ points", "expected are 2",
                       "no odometry", since=since)
            self.simulator.call("sim.noise", dropouts=0)
            for name in ("lidar", "tracking"):
                wait_for(f"{name} in the journal", lambda name=name, since=since: f"{name} is ok" in robot.written(since), 10)

    def test_what_is_stopped_during_a_search_stays_so(self):
        robot = self.robot_at_work()
        found = {}
        search = threading.Thread(target=lambda: found.update(robot.call("supervisor", "setup.find", release=True)))
        search.start()

        def state(name):
            return next(one["state"] for one in robot.call("supervisor", "process.list")["processes"] if one["name"] == name)
        wait_for("the release", lambda: state("motorcontrol") == "stopped", 10)
        robot.call("supervisor", "process.stop", name="motorcontrol")
        search.join()
        self.assertIn("seriallogger", found["restarted"])
        self.assertNotIn("motorcontrol", found["restarted"])
        self.assertEqual(state("motorcontrol"), "stopped")


if __name__ == "__main__":
    unittest.main(verbosity=2)
