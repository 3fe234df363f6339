#!/usr/bin/env python3
"""Whatever happens to a device, a disk or a settings file, the service stays up, the robot stands, hermesctl list, the health items
that the window shows and the journal name what, where, what was found and what was expected; when the cause is gone all goes on by
itself. A supervisor with the daemons of a robot, as a service; the simulator is at the far end of their wires.

What needs a full disk, a file that cannot be read or a folder that cannot be written to is left out where it cannot be made."""
import json
import os
import re
import shutil
import socket
import subprocess
import tempfile
import threading
import time
import unittest

from robot import NAMES, Robot, Talker
from support import BINARIES, SOURCE, Daemon, DaemonError, Process, free_port, wait_for

WORLD = os.path.join(SOURCE, "deploy", "worlds", "pillars.json")
PACKET = 1206  # bytes of a Velodyne data packet


class BadInput(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.folder = self.holder.name
        self.wires = {"motors": os.path.join(self.folder, "motors"), "gps": os.path.join(self.folder, "gps"),
                      "lidar": free_port(0, socket.SOCK_DGRAM)}

    def simulate(self):
        simulator = Process(BINARIES, "simulator", free_port(0), self.folder, {
            "world": WORLD, "motors.link": self.wires["motors"], "gps.link": self.wires["gps"], "lidar.port": self.wires["lidar"],
            "lidar.position_port": free_port(0, socket.SOCK_DGRAM)})
        self.addCleanup(simulator.stop)
        self.simulator = simulator.connect()
        return simulator

    def robot_of(self, **changes):
        """A robot that has begun to work, all well."""
        self.robot = Robot(self.folder, self.wires)
        for name, settings in changes.items():
            self.robot.write(name, **settings)
        self.robot.start()
        self.addCleanup(self.robot.stop)
        return self.robot

    def until_well(self, what="all", names=("supervisor", *NAMES), limit_s=20):
        found = {}

        def is_well():
            found.update({name: self.robot.items(name) for name in names})
            return all(items is not None and not [one for one in items if ": warn: " not in one] for items in found.values())
        try:
            wait_for(what, is_well, limit_s)
        except AssertionError as error:
            raise AssertionError(f"{error}: {found}") from None

    def tells(self, name, *words, since=0, down=None):
        """A health item of the daemon, list and the journal have all these words; all daemons answer but for one that is down."""
        seen = {}

        def has(text):
            return all(re.search(word, text) for word in words)

        def is_told():
            seen["health"] = self.robot.items(name) or []
            return any(map(has, seen["health"]))
        try:
            wait_for("health", is_told, 60)  # the last page of a file on a full disk has room for some sentences
            wait_for("list", lambda: seen.update(list=self.robot.shown()) or any(map(has, seen["list"].splitlines())), 5)
            wait_for("journal", lambda: any(map(has, self.robot.written(since).splitlines())), 5)
        except AssertionError as error:
            raise AssertionError(f"{name} does not tell {words}: {error}\n{seen}\n{self.robot.written(since)[-3000:]}") from None
        for other in ("supervisor", *NAMES):
            if other != down:
                self.assertIsNotNone(self.robot.items(other), f"{other} does not answer")

    def stands(self):
        return max(map(abs, self.simulator.call("sim.state")["motors"]["wheels_rps"])) < 0.02

    def drive(self, until, limit_s=10):
        """A client that goes on driving whatever it is told; the last refusal."""
        refusal, deadline = None, time.monotonic() + limit_s
        with Daemon(port=self.robot.ports["motorcontrol"], timeout=10) as motors:
            while not until():
                self.assertLess(time.monotonic(), deadline, refusal)
                try:
                    motors.call("control.acquire", timeout_s=2)
                    motors.call("motor.drive", vx=0.3)
                except DaemonError as error:
                    refusal = str(error)
                time.sleep(0.05)
        return refusal

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

    def restart(self, name):
        self.robot.call("supervisor", "process.restart", name=name)
        wait_for("the restart", lambda: self.robot.items(name) is not None, 15)

    def test_wrong_devices(self):
        """A GPS receiver, noise or nothing where the controllers are expected; these or noise where a receiver is; datagrams of
        others where a lidar is."""
        self.simulate()
        robot = self.robot_of()
        self.until_well()
        sentence = b"$GPGGA,120000,4916.45,N,12311.12,W,1,08,0.9,545.4,M,46.9,M,,*55\r\n"
        noise = bytes((37 * i * i + 11 * i) % 256 for i in range(499))
        lines = {"a receiver": sentence, "noise": noise, "nothing": b""}
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
        for what, says in {"noise": noise, "a talker of another kind": b"login: ", "nothing": b""}.items():
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

    def test_wrong_lidars(self):
        self.simulate()
        robot = self.robot_of()
        self.until_well()
        self.simulator.call("sim.fault", device="lidar", kind="silence")
        other = bytearray(PACKET)
        for block in range(12):
            other[100 * block:100 * block + 2] = b"\xff\xee"
        for what, packet, words in (("short packets", bytes(PACKET - 1), ("no data packets", "expected")),
                                    ("an unknown model", bytes(other[:-1]) + b"\x77", ("not decoded", "expected"))):
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

    WRONG_SETTINGS = {
        "syntax": (b'{\n "record": {"folder": "/tmp"},\n "ports": [}\n', "line 3"),
        "unknown key": (b'{"prots": []}', "prots"),
        "wrong type": (b'{"limits": {"clients": "many"}}', "limits.clients.*many"),
        "out of range": (b'{"limits": {"clients": 0}}', "limits.clients.*0.*(1|from)"),
        "empty": (b"", "line 1"),
        "no object": (b"[1, 2]", "expected a JSON object"),
        "binary": (bytes(range(256)) * 4, "line 1"),
        "cut off": (b'{"record": {"folder": "/t', "line 1"),
        "folder": (None, "directory"),
        "unreadable": (b"{}", "[Pp]ermission"),
        "absent": (None, "No such file")}

    def spoil(self, name, what):
        """Puts that in the place of a settings file; False where it cannot be made."""
        text, path = self.WRONG_SETTINGS[what][0], self.robot.path(name)
        if what == "unreadable" and os.geteuid() == 0:
            return False
        if text is not None:
            self.robot.write_text(name, text)
        else:
            os.remove(path)
        if what == "folder":
            os.mkdir(path)
        if what == "unreadable":
            os.chmod(path, 0)
        return True

    def mend(self, name):
        if os.path.isdir(self.robot.path(name)):
            os.rmdir(self.robot.path(name))
        self.robot.write(name)

    def test_wrong_settings_of_a_daemon(self):
        self.simulate()
        robot = self.robot_of()
        self.until_well()
        name = "seriallogger"
        for what, (_, word) in self.WRONG_SETTINGS.items():
            with self.subTest(what):
                since = robot.journal_size()
                if not self.spoil(name, what):
                    continue
                try:
                    self.assertIsNotNone(robot.items(name), "a daemon that runs reads its file")
                    robot.call("supervisor", "process.restart", name=name)
                    self.tells("supervisor", f"process {name}", re.escape(robot.path(name)), word, since=since, down=name)
                finally:
                    self.mend(name)
                wait_for("a start by itself", lambda: robot.items(name) is not None, 15)
        self.until_well()

    def test_wrong_settings_of_the_supervisor(self):
        self.simulate()
        robot = self.robot_of()
        self.until_well()
        for what, (_, word) in self.WRONG_SETTINGS.items():
            with self.subTest(what):
                since = robot.journal_size()
                if not self.spoil("supervisor", what):
                    continue
                try:
                    robot.process.terminate()
                    wait_for("the end", lambda: robot.items("supervisor") is None, 20)
                    wait_for("the service", lambda: robot.items("supervisor") is not None, 20)
                    self.assertEqual(robot.call("supervisor", "process.list")["processes"][0]["state"], "stopped")
                    told = robot.items("supervisor")
                    self.assertTrue(any(robot.path("supervisor") in one and re.search(word, one) for one in told), told)
                    shown, journal = robot.shown(), robot.written(since)
                    for text in (shown, journal):
                        self.assertIn(robot.path("supervisor"), text)
                        self.assertRegex(text, word)
                finally:
                    self.mend("supervisor")
                wait_for("the processes", self.is_first_running, 20)
        self.until_well()

    def is_first_running(self):
        try:
            return self.robot.call("supervisor", "process.list")["processes"][0]["state"] == "running"
        except (OSError, DaemonError):  # it ends, and starts anew
            return False

    def test_what_is_stopped_during_a_search_stays_so(self):
        self.simulate()
        robot = self.robot_of()
        self.until_well()
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

    def small_disk(self):
        disk = os.path.join(self.folder, "disk")
        os.mkdir(disk)
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", disk], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            self.skipTest("a small disk cannot be mounted here: " + done.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", "-l", disk], check=True)
        return disk

    @staticmethod
    def fill(disk):
        with open(os.path.join(disk, "filler"), "ab", buffering=0) as filler:
            for size in (65536, 4096, 1):
                try:
                    while True:
                        filler.write(bytes(size))
                except OSError:
                    pass

    def test_full_disk(self):
        """Under recordings, the audit and the settings files."""
        disk = self.small_disk()
        self.simulate()
        record = {"folder": os.path.join(disk, "recordings"), "free_floor_bytes": 0, "free_warn_bytes": 0}
        audit = {"folder": os.path.join(disk, "audit")}
        robot = self.robot_of(velodynelogger={"record": record, "audit": audit}, seriallogger={"record": record},
                              motorcontrol={"audit": audit})
        etc = os.path.join(disk, "etc")
        os.mkdir(etc)
        robot.write("supervisor", setup={**robot.settings["supervisor"]["setup"], "folder": etc})
        self.until_well()
        robot.process.terminate()
        self.until_well("another folder of settings")
        robot.call("supervisor", "setup.apply", settings={"seriallogger": {"limits": {"clients": 20}}})
        with open(os.path.join(etc, "seriallogger.json"), "rb") as file:
            old = file.read()
        for name in ("velodynelogger", "seriallogger"):
            wait_for("it", lambda name=name: robot.items(name) is not None)
            robot.call(name, "record.start", name=f"run-{name}")
        self.drive(lambda: not self.stands())
        since = robot.journal_size()
        self.fill(disk)

        def audits():  # the last page of the file has room for some lines
            for method in ["motor.estop", "motor.reset_estop"] * 20:
                robot.call("motorcontrol", method)
            return any("audit" in item for item in robot.items("motorcontrol"))
        wait_for("a full disk under the audit", audits, 15)
        for name, words in {"velodynelogger": ("recording", "run"), "seriallogger": ("recording", "run"),
                            "motorcontrol": ("audit", "not written down")}.items():
            self.tells(name, *words, disk, "[Ss]pace|full", since=since)
            self.fill(disk)  # recordings that ended have given back what they had reserved
        for method, params in {"setup.apply": {"settings": {"seriallogger": {"limits": {"clients": 30}}, "simulator": {}}},
                               "setup.undo": {}}.items():
            with self.assertRaisesRegex(DaemonError, f"{disk}.*[Ss]pace"):
                robot.call("supervisor", method, **params)
            with open(os.path.join(etc, "seriallogger.json"), "rb") as file:
                self.assertEqual(file.read(), old, method)
            self.assertEqual(sorted(os.listdir(etc)), ["seriallogger.json", "seriallogger.json.previous"])
        os.remove(os.path.join(disk, "filler"))
        shutil.rmtree(os.path.join(disk, "recordings"))
        for name in ("velodynelogger", "seriallogger"):
            robot.call(name, "record.start", name=f"next-{name}")
            robot.call(name, "record.stop")
        self.until_well("room on the disk")
        robot.call("supervisor", "setup.undo")
        with open(os.path.join(etc, "seriallogger.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file), {})
        self.drive(lambda: not self.stands())


if __name__ == "__main__":
    unittest.main(verbosity=2)
