"""What tests of sessions share: a whole robot with a recorder, who drives it, and who listens to it."""
import glob
import json
import math
import os
import shutil
import socket
import sys
import tempfile
import threading
import unittest

from support import BINARIES, SOURCE, WORLD, Daemon, DaemonError, Process, free_port, wait_for

sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
import mcap_reader  # noqa: E402  pylint: disable=wrong-import-position


class Driver(threading.Thread):
    """A client that has the control and commands the same 10 times a second, until it is told to be silent or is refused."""

    def __init__(self, port, name, **twist):
        super().__init__(daemon=True)
        self.motors, self.twist = Daemon(port=port), twist
        self.motors.call("control.acquire", client=name, timeout_s=5)
        self.silent = threading.Event()
        self.start()

    def run(self):
        try:
            while not self.silent.wait(0.1):  # the pace of a driver
                self.motors.call("motor.drive", **self.twist)
        except (DaemonError, OSError):
            pass

    def end(self):
        self.silent.set()
        self.join()
        self.motors.close()


class Robot:
    """The daemons of the demo, a serial logger and a recorder."""

    def __init__(self, folder):
        self.folder, self.records = folder, os.path.join(folder, "records")
        lidar, position = free_port(0, socket.SOCK_DGRAM), free_port(0, socket.SOCK_DGRAM)
        line, gps = os.path.join(folder, "motors"), os.path.join(folder, "gps")
        self.ports = {name: free_port(0) for name in
                      ("simulator", "motorcontrol", "velodynelogger", "seriallogger", "scanmatcher", "recorder")}
        self.processes, self.daemons = {}, {}
        serial = f"serial://{line}?baud=115200"
        keep = {"record.folder": self.records, "record.free_floor_bytes": 0, "record.free_warn_bytes": 0}
        self.settings = {
            "simulator": {"world": WORLD, "lidar.port": lidar, "lidar.position_port": position, "motors.link": line, "gps.link": gps},
            "velodynelogger": {"source.port": lidar, "source.position_port": position, **keep},
            "seriallogger": {"ports": json.dumps([{"name": "gps", "url": f"serial://{gps}?baud=9600", "view": "nmea"}]), **keep},
            "motorcontrol": {"controllers.1.url": serial, "controllers.2.url": serial},
            "scanmatcher": {"source.address": f"127.0.0.1:{self.ports['velodynelogger']}", "matcher.start": "mapping",
                            "odometry.address": f"127.0.0.1:{self.ports['motorcontrol']}", "map.folder": folder},
            "recorder": {"daemons": json.dumps([f"127.0.0.1:{port}" for name, port in self.ports.items() if name != "recorder"]),
                         **keep}}
        for name in self.settings:
            self.start(name)
        self.recorder = self.daemons["recorder"]
        wait_for("the daemons", lambda: "5 daemons" in self.health("daemons"))
        wait_for("poses", lambda: self.daemons["scanmatcher"].call("matcher.state")["scans"] > 0)
        wait_for("the wheels", lambda: self.daemons["motorcontrol"].call("motor.state")["ready"])

    def start(self, name):
        self.processes[name] = Process(BINARIES, name, self.ports[name], self.folder, self.settings[name])
        self.daemons[name] = self.processes[name].connect()
        self.recorder = self.daemons.get("recorder")

    def kill(self, name):
        self.processes[name].process.kill()
        self.processes[name].process.wait()

    def health(self, item):
        return next(one["message"] for one in self.recorder.call("daemon.status")["health"] if one["name"] == item)

    def stop(self):
        for process in reversed(list(self.processes.values())):
            process.stop()

    def processor_seconds(self, name):
        with open(f"/proc/{self.processes[name].process.pid}/stat", encoding="ascii") as file:
            fields = file.read().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def files(self, name):
        """Of a session: whole files, or the reader of the tests raises."""
        return [mcap_reader.Mcap(path) for path in sorted(glob.glob(os.path.join(self.records, name, "recorder-*.mcap")))]


class RecordedRobot(unittest.TestCase):
    """Tests with such a robot."""

    def setUp(self):
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        self.robot = Robot(folder)
        self.addCleanup(self.robot.stop)

    def call(self, method, **params):
        """Of the recorder."""
        return self.robot.recorder.call(method, **params)

    def source_of(self, name):
        return self.robot.daemons[name].call("source.status")["source"]["state"]

    def pose(self):
        return self.robot.daemons["simulator"].call("sim.state")["pose"]

    def drive(self, name="anna", way_m=0.0, **twist):
        """A driver, once the robot goes as it is told and has come so far."""
        driver, begin = Driver(self.robot.ports["motorcontrol"], name, **twist), self.pose()
        state = lambda: self.robot.daemons["motorcontrol"].call("motor.state")  # while a controller is silent: the last
        wait_for("a drive", lambda: not (now := state())["halted"] and abs(now["twist"]["vx"]) > 0.8 * twist["vx"])
        wait_for("a way", lambda: math.hypot((now := self.pose())["x"] - begin["x"], now["y"] - begin["y"]) >= way_m)
        return driver

    def wait_for_messages(self, more):
        """That the recorder takes."""
        count = lambda: next((part["counts"].get("messages", 0) for part in self.call("session.state")["parts"]
                              if part["daemon"] == "recorder"), 0)
        before = count()
        wait_for("messages", lambda: count() > before + more)
