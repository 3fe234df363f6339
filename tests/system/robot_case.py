"""What tests of bad input share: a robot at work, and what must tell that something is wrong with it."""
import os
import re
import socket
import tempfile
import time
import unittest

from robot import NAMES, Robot
from support import BINARIES, BUILD, WORLD, Daemon, DaemonError, Process, fastest_wheel, free_port, wait_for

INTERPOSED = {"LD_PRELOAD": os.path.join(BUILD, "tests", "system", "interposed.so"), "ASAN_OPTIONS": "verify_asan_link_order=0"}


class RobotCase(unittest.TestCase):
    """Tests of a robot whose supervisor runs as a service; the simulator is at the far end of its wires."""

    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.folder = self.holder.name
        self.wires = {"motors": os.path.join(self.folder, "motors"), "gps": os.path.join(self.folder, "gps"),
                      "lidar": free_port(0, socket.SOCK_DGRAM)}

    def simulate(self, **settings):
        simulator = Process(BINARIES, "simulator", free_port(0), self.folder, {
            "world": WORLD, "motors.link": self.wires["motors"], "gps.link": self.wires["gps"], "lidar.port": self.wires["lidar"],
            "lidar.position_port": free_port(0, socket.SOCK_DGRAM), **settings})
        self.addCleanup(simulator.stop)
        self.simulator = simulator.connect()
        return simulator

    def robot_of(self, environment=None, **changes):
        """A robot that has begun to work."""
        self.robot = Robot(self.folder, self.wires)
        for name, settings in changes.items():
            self.robot.write(name, **settings)
        self.robot.start(**environment or {})
        self.addCleanup(self.robot.stop)
        return self.robot

    def robot_at_work(self, environment=None, **changes):
        """The same with its simulator, once all is well."""
        self.simulate()
        robot = self.robot_of(environment, **changes)
        self.until_well()
        return robot

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
        return fastest_wheel(self.simulator) < 0.02

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

    def restart(self, name):
        self.robot.call("supervisor", "process.restart", name=name)
        wait_for("the restart", lambda: self.robot.items(name) is not None, 15)
