#!/usr/bin/env python3
"""The first contact with a robot, against a simulator at the far end of real wires: hermesctl setup finds the controllers, the GPS
receiver and the lidar, and disturbs nobody."""
import os
import pty
import socket
import threading
import time
import tty
import unittest

from setup_case import SetupCase
from support import WORLD, DaemonError, SerialPort, free_port, put, wait_for


class Line:
    """The far end of a serial line whose device does as a test says; keeps what it was sent."""

    def __init__(self, folder, name, says=b""):
        self.far, near = pty.openpty()
        tty.setraw(near)
        self.near = near
        self.path = os.path.join(folder, name)
        os.symlink(os.ttyname(near), self.path)
        self.heard = b""
        self.says = says
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        os.set_blocking(self.far, False)
        while self.far >= 0:
            try:
                self.heard += os.read(self.far, 4096)
            except OSError:
                pass
            if self.says:
                os.write(self.far, self.says)
            time.sleep(0.05)


class Setup(SetupCase):
    def test_finds_what_is_plugged_in(self):
        _, simulator = self.simulator()
        silent, chatty = Line(self.folder, "silent"), Line(self.folder, "chatty", b"login: ")
        self.supervisor([self.motors, self.gps, silent.path, chatty.path, os.path.join(self.folder, "nothing")])
        findings, serial = self.found("--yes")
        motors = serial[self.motors]
        self.assertEqual((motors["kind"], motors["addresses"], motors["any_address"]), ("roboclaw", [128, 129], False))
        self.assertIn("RoboClaw", motors["text"])
        self.assertEqual(serial[self.gps]["kind"], "nmea")
        self.assertTrue(serial[self.gps]["text"].startswith("$G"), serial)
        self.assertEqual(serial[silent.path]["kind"], "silent")
        self.assertEqual(serial[chatty.path]["kind"], "talker")
        self.assertEqual(chatty.heard, b"", "a device that talks by itself was sent something")
        controllers = silent.heard[:next(i for i in range(0, len(silent.heard), 2) if not 128 <= silent.heard[i] <= 135)]
        commands = {controllers[i:i + 2][1:] for i in range(0, len(controllers), 2)}  # before scanners are looked for
        self.assertEqual(commands, {b"\x15"}, "more was sent than the command that reads the version")
        self.assertEqual(len(findings["lidars"]), 1, findings)
        lidar = findings["lidars"][0]
        self.assertEqual((lidar["address"], lidar["model"], lidar["key"]), ("127.0.0.1", "HDL-32E", "hdl32e"))
        self.assertGreater(lidar["rate_hz"], 200)
        self.assertEqual(simulator.call("sim.state")["motors"]["wheels_rps"], [0, 0, 0, 0])

    def test_asks_nobody_unless_told_to(self):
        self.simulator()
        silent = Line(self.folder, "silent")
        self.supervisor([self.motors, silent.path])
        _, serial = self.found()
        self.assertEqual({serial[self.motors]["kind"], serial[silent.path]["kind"]}, {"not_asked"})
        self.assertEqual(silent.heard, b"")
        put(os.path.join(self.etc, "motorcontrol.json"), {"controllers": {"1": {"url": f"serial://{self.motors}?baud=115200"}}})
        table = self.ctl("--list")  # a controller's by the settings
        self.assertRegex(table, r"roboclaw +\S+motors +.*115200 baud, address 128, address 129")
        self.assertRegex(table, r"not_asked +\S+silent")
        self.assertEqual(silent.heard, b"")

    def test_finds_scanners_and_a_base_with_an_arduino(self):
        lines = {model: os.path.join(self.folder, model) for model in ("ld06", "rplidar-a1", "ydlidar-x4")}
        for model, line in lines.items():
            self.start("simulator", {"world": WORLD, "lidar.port": 0, "scanner.model": model, "scanner.link": line})
        base = os.path.join(self.folder, "base")
        self.start("simulator", {"world": WORLD, "lidar.port": 0, "motors.kind": "arduino", "motors.link": base, "frame.layout": "differential"})
        self.supervisor([*lines.values(), base], [self.sleeper(name) for name in ("motorcontrol", "scanner", "scanmatcher")])
        _, serial = self.found()
        self.assertEqual([serial[line]["kind"] for line in lines.values()], ["scanner", "not_asked", "not_asked"])
        self.found("--yes")  # which leaves nobody talking
        _, serial = self.found("--yes")
        for model, line in lines.items():
            self.assertEqual((serial[line]["kind"], serial[line]["model"]), ("scanner", model), serial)
        self.assertEqual(serial[base]["kind"], "arduino", serial)
        self.ctl("--yes")
        motors = self.file("motorcontrol")
        self.assertEqual((motors["controllers"]["kind"], motors["frame"]["layout"]), ("arduino", "two_wheels"))
        self.assertEqual(motors["controllers"]["1"]["url"], f"serial://{base}?baud=57600")
        self.assertEqual(self.file("scanner")["scanner"], {"url": f"serial://{lines['ld06']}", "model": "ld06"})
        self.assertEqual(self.file("scanmatcher")["source"]["address"], "127.0.0.1:7470")

    def test_leaves_what_is_in_use(self):
        self.simulator()
        port = SerialPort(self.motors)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind(("0.0.0.0", self.lidar_port))
            self.supervisor([self.motors])
            findings, serial = self.found("--yes")
        self.assertEqual(serial[self.motors]["kind"], "in_use")
        self.assertIn(f"process {os.getpid()}", serial[self.motors]["text"])
        self.assertIn(f"UDP port {self.lidar_port} is in use by", findings["problems"][0])
        self.assertIn(f"process {os.getpid()}", findings["problems"][0])
        port.close()

    def test_ends_and_starts_its_own_processes(self):
        self.simulator()
        url = f"serial://{self.motors}?baud=115200"
        listen = f"tcp://127.0.0.1:{free_port(0)}?protocol=json"
        arguments = ["--listen", listen, "--set", f"controllers.1.url={url}", "--set", f"controllers.2.url={url}"]
        supervisor = self.supervisor([self.motors], [
            {"name": "motorcontrol", "arguments": arguments, "autostart": True},
            {"name": "idle", "program": "/bin/sleep", "arguments": ["1000"], "autostart": True},
            {"name": "scanner", "autostart": True, "arguments": [  # its line may come as the search begins
                "--listen", f"tcp://127.0.0.1:{free_port(0)}?protocol=json", "--set", f"scanner.url=serial://{self.folder}/none"]},
            {"name": "seriallogger"}])

        def processes():
            return {one["name"]: one for one in supervisor.call("process.list")["processes"]}

        def holds():
            pid = processes()["motorcontrol"]["pid"]
            return pid and os.path.realpath(self.motors) in [os.path.realpath(f"/proc/{pid}/fd/{one}")
                                                             for one in os.listdir(f"/proc/{pid}/fd")]
        wait_for("the open line", holds)
        _, serial = self.found()
        self.assertEqual(serial[self.motors]["kind"], "in_use")
        self.assertIn("hermes-motorcontrol", serial[self.motors]["text"])
        before = processes()
        findings, serial = self.found("--yes")
        self.assertEqual(serial[self.motors]["kind"], "roboclaw")
        self.assertEqual(findings["restarted"], ["motorcontrol", "scanner"])
        after = processes()
        self.assertNotEqual(after["motorcontrol"]["pid"], before["motorcontrol"]["pid"])
        self.assertEqual(after["idle"]["pid"], before["idle"]["pid"])
        self.assertEqual(after["seriallogger"]["state"], "stopped")

    def test_a_fresh_installation(self):
        """The simulator of the service is no robot: what it offers is not mixed with what is plugged in."""
        listen = {name: f"tcp://127.0.0.1:{free_port(0)}?protocol=json" for name in ("simulator", "motorcontrol")}
        simulated = os.path.join(self.folder, "simulated")
        supervisor = self.supervisor([self.motors], [
            {"name": "simulator", "autostart": True, "arguments": [
                "--listen", listen["simulator"], "--set", f"world={WORLD}", "--set", f"motors.link={simulated}",
                "--set", f"lidar.port={self.lidar_port}", "--set", f"lidar.position_port={self.position_port}"]},
            {"name": "motorcontrol"}])
        put(os.path.join(self.etc, "motorcontrol.json"), {"controllers": {number: {"url": f"serial://{simulated}?baud=115200"} for number in "12"}})
        wait_for("the simulator", lambda: os.path.exists(simulated))
        findings, serial = self.found("--yes")
        self.assertTrue(serial[simulated]["simulated"] and findings["lidars"][0]["simulated"], findings)
        self.assertEqual(set(supervisor.call("setup.propose")["settings"]),
                         {"motorcontrol", "velodynelogger", "scanmatcher", "supervisor"})
        self.simulator(**{"lidar.port": free_port(0, socket.SOCK_DGRAM)})  # far from the supervisor: as what is plugged in
        for _ in range(3):  # on a busy machine the simulated controllers may answer too late
            findings, serial = self.found("--yes")
            proposal = supervisor.call("setup.propose")
            kinds = [serial[line]["kind"] for line in (simulated, self.motors)]
            if kinds == ["roboclaw", "roboclaw"]:
                break
        self.assertEqual(kinds, ["roboclaw", "roboclaw"], serial)
        for controller in proposal["settings"]["motorcontrol"]["controllers"].values():
            self.assertEqual(controller["url"], f"serial://{self.motors}?baud=115200")
        self.assertNotIn("velodynelogger", proposal["settings"])
        self.assertIn("the simulator starts with the supervisor", proposal["notes"][0])

    def test_a_process_that_does_not_end(self):
        """Somebody starts it again while it is to end: the search goes on, and another one is possible."""
        line, script = Line(self.folder, "line"), os.path.join(self.folder, "stubborn")
        put(script, f"#!/bin/sh\ntrap '' TERM\nexec 3<>{line.path}\nwhile test -e {script}; do sleep 0.1; done\n")
        os.chmod(script, 0o755)
        supervisor = self.supervisor([line.path], [{"name": "stubborn", "program": script, "autostart": True}])

        def state():
            return supervisor.call("process.list")["processes"][0]["state"]
        wait_for("its line", lambda: self.found()[1][line.path]["kind"] == "in_use", 20)
        found = {}
        search = threading.Thread(target=lambda: found.update(self.found("--yes")[1]))
        search.start()
        wait_for("the end", lambda: state() == "stopping")
        with self.assertRaisesRegex(DaemonError, "search is under way"):
            supervisor.call("setup.undo")
        supervisor.call("process.start", name="stubborn")
        search.join(60)
        self.assertIn(line.path, found)
        wait_for("another search", lambda: self.found()[1][line.path]["kind"] == "in_use", 20)


if __name__ == "__main__":
    unittest.main()
