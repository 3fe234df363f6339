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
import struct
import subprocess
import tempfile
import threading
import time
import unittest

from robot import NAMES, Robot, Talker
from support import BINARIES, BUILD, SOURCE, Daemon, DaemonError, Process, free_port, wait_for

WORLD = os.path.join(SOURCE, "deploy", "worlds", "pillars.json")
PACKET = 1206  # bytes of a Velodyne data packet
SENTENCE = b"$GPGGA,120000,4916.45,N,12311.12,W,1,08,0.9,545.4,M,46.9,M,,*55\r\n"
NOISE = bytes((37 * i * i + 11 * i) % 256 for i in range(499))
INTERPOSED = {"LD_PRELOAD": os.path.join(BUILD, "tests", "system", "interposed.so"), "ASAN_OPTIONS": "verify_asan_link_order=0"}


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

    def robot_of(self, environment=None, **changes):
        """A robot that has begun to work, all well."""
        self.robot = Robot(self.folder, self.wires)
        for name, settings in changes.items():
            self.robot.write(name, **settings)
        self.robot.start(**environment or {})
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
            raise AssertionError(f"{name} does not tell {words}: {error}\n{seen}\n{self.robot.written(since)[:6000]}") from None
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
        self.simulate()
        robot = self.robot_of()
        self.until_well()
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
        self.simulate()
        robot = self.robot_of()
        self.until_well()
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

    def test_clock_set_back(self):
        """By an hour while the robot drives, and forth again: it drives on, and stands when it is told nothing; what was told by
        the other clock is refused."""
        clock = os.path.join(self.folder, "clock")

        def set_clock(ahead_s):
            with open(clock, "wb") as file:
                file.write(struct.pack("q", ahead_s))
        set_clock(0)
        self.simulate()
        robot = self.robot_of({**INTERPOSED, "HERMES_CLOCK": clock})
        self.until_well()
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
        "empty": (b"", "0 bytes"),
        "zeros": (b"{}" + bytes(100), "line 1"),
        "Latin-1": (b'{"record": {"folder": "/tmp/M\xfcll"}}', "line 1"),
        "UTF-16": ("{}".encode("utf-16"), "expected UTF-8"),
        "no object": (b"[1, 2]", "expected a JSON object"),
        "binary": (bytes(range(256)) * 4, "line 1"),
        "cut off": (b'{"record": {"folder": "/t', "line 1"),
        "folder": (os.mkdir, "regular file"),
        "pipe": (os.mkfifo, "regular file"),
        "device": (lambda path: os.symlink("/dev/zero", path), "regular file"),
        "links in a circle": (lambda path: os.symlink(path, path), "[Ll]inks"),
        "huge": (lambda path: subprocess.run(["truncate", "-s", "1G", path], check=True), "1073741824 bytes"),
        "unreadable": (lambda path: os.close(os.open(path, os.O_CREAT, 0)), "[Pp]ermission"),
        "absent": (lambda path: None, "No such file")}

    def spoil(self, name, what):
        """Puts that in the place of a settings file; False where it cannot be made."""
        made, path = self.WRONG_SETTINGS[what][0], self.robot.path(name)
        if what == "unreadable" and os.geteuid() == 0:
            return False
        if isinstance(made, bytes):
            self.robot.write_text(name, made)
        else:
            os.remove(path)
            made(path)
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

    def mount(self, folder, *how):
        done = subprocess.run(["mount", *how, folder], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            self.skipTest(f"{folder} cannot be mounted here: " + done.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", "-l", folder], check=True)

    @staticmethod
    def make(folder, access):
        subprocess.run(["mount", "-o", f"remount,bind,{access}", folder], check=True)

    def small_disk(self):
        disk = os.path.join(self.folder, "disk")
        os.mkdir(disk)
        self.mount(disk, "-t", "tmpfs", "-o", "size=2m", "tmpfs")
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

    def test_state_that_is_read_only(self):
        """From the start; when it is no longer, all goes on."""
        state = os.path.join(self.folder, "state")
        os.mkdir(state)
        self.mount(state, "--bind", state)
        self.make(state, "ro")
        self.simulate()
        record, maps = {"folder": os.path.join(state, "recordings")}, os.path.join(state, "maps")
        robot = self.robot_of({"STATE_DIRECTORY": state, "XDG_STATE_HOME": state}, velodynelogger={"record": record},
                              seriallogger={"record": record}, scanmatcher={"map": {"folder": maps, "journal": "drive.journal"}})
        self.tells("scanmatcher", "journal", maps, "[Rr]ead-only")
        self.drive(lambda: not self.stands())
        self.tells("motorcontrol", "audit", os.path.join(state, "audit"), "[Rr]ead-only")
        calls = {name: lambda name=name: robot.call(name, "record.start", name=f"run-{name}") for name in ("velodynelogger", "seriallogger")}
        calls["scanmatcher"] = lambda: robot.call("scanmatcher", "map.save", path="first.csv")
        for name, call in calls.items():
            with self.subTest(name), self.assertRaisesRegex(DaemonError, f"{state}.*[Rr]ead-only"):
                call()
        self.make(state, "rw")
        for call in calls.values():
            call()
        for name in ("velodynelogger", "seriallogger"):
            robot.call(name, "record.stop")
        wait_for("the audit", lambda: os.path.getsize(os.path.join(state, "audit", "seriallogger.jsonl")) > 0)
        self.drive(lambda: not self.stands())
        self.until_well("a folder to write to", limit_s=90)  # what was not written down is told for a minute

    def test_settings_that_cannot_be_written(self):
        """A full disk, one that is read-only: the files stay as they are."""
        robot = self.robot_of()
        wait_for("the start", lambda: all(robot.items(name) is not None for name in ("supervisor", *NAMES)))
        self.mount(robot.etc, "-t", "tmpfs", "-o", "size=64k", "tmpfs")
        for name in robot.settings:
            robot.write(name)
        robot.call("supervisor", "setup.apply", settings={"seriallogger": {"limits": {"clients": 20}}})
        wait_for("it", lambda: robot.items("seriallogger") is not None)
        before = self.files(robot.etc)
        robot.call("seriallogger", "settings.set", values={"limits": {"clients": 30}})
        full = os.path.join(robot.etc, "filler")
        for what, spoil, mend in (("[Ss]pace", lambda: self.fill(robot.etc), lambda: os.remove(full)),
                                  ("not writable", lambda: self.make(robot.etc, "ro"), lambda: self.make(robot.etc, "rw"))):
            spoil()
            for name, method in (("seriallogger", "settings.save"), ("supervisor", "setup.apply"), ("supervisor", "setup.undo")):
                params = {"settings": {"seriallogger": {"limits": {"clients": 40}}}} if method == "setup.apply" else {}
                with self.subTest(f"{what} {method}"), self.assertRaisesRegex(DaemonError, f"{robot.etc}.*{what}"):
                    robot.call(name, method, **params)
            mend()
            self.assertEqual(self.files(robot.etc), before)
        robot.call("seriallogger", "settings.save")
        self.assertEqual(self.files(robot.etc)["seriallogger.json"]["limits"], {"clients": 30})

    @staticmethod
    def files(folder):
        found = {}
        for name in os.listdir(folder):
            if not name.endswith((".json", ".previous")):
                continue  # a draft of a program that was killed
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                found[name] = json.load(file)
        return found

    def test_killed_while_settings_are_replaced(self):
        """At each step of setup.apply: all files are as they were, or it is told and setup.undo makes them so."""
        robot = self.robot_of()
        changes = {name: {"limits": {"clients": 30}} for name in ("motorcontrol", "seriallogger")}
        before = self.files(robot.etc)

        def is_up():
            return robot.items("supervisor") is not None

        def are_all_up():
            return all(robot.items(name) is not None for name in ("supervisor", *NAMES))
        wait_for("the service", is_up)
        told = 0
        for at in range(1, 100):
            robot.environment = {**INTERPOSED, "HERMES_KILL_AT": str(at)}
            robot.process.terminate()
            wait_for("the end", lambda: not is_up())
            wait_for("the service", is_up)
            robot.environment, since = {}, robot.journal_size()
            try:
                robot.call("supervisor", "setup.apply", settings=changes)
                break
            except OSError:  # it was killed
                wait_for("the service", are_all_up)
            if robot.items("supervisor"):
                told += 1
                self.tells("supervisor", "settings files", robot.etc, "cut off", "setup.undo", since=since)
                with self.assertRaisesRegex(DaemonError, "cut off"):
                    robot.call("supervisor", "setup.apply", settings=changes)
                robot.call("supervisor", "setup.undo")
            now = self.files(robot.etc)
            self.assertEqual({name: now[name] for name in before}, before, f"killed at step {at}")
            wait_for("that all is well", lambda: not robot.items("supervisor"), 10)
        self.assertGreater(told, 1)
        self.assertEqual(self.files(robot.etc)["motorcontrol.json"]["limits"], {"clients": 30})


if __name__ == "__main__":
    unittest.main(verbosity=2)
