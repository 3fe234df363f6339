#!/usr/bin/env python3
"""The first contact with a robot, against a simulator at the far end of real wires: hermesctl setup finds the controllers, the GPS
receiver and the lidar, disturbs nobody, writes settings that the daemons take, and puts back what was there."""
import json
import os
import pty
import socket
import subprocess
import tempfile
import termios
import threading
import time
import tty
import unittest

from support import BINARIES, HERMESCTL, SOURCE, WORLD, DaemonError, Process, SerialPort, free_port, put, release, text_of, wait_for

SAMPLES = os.path.join(SOURCE, "deploy", "settings")


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


class Setup(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.folder = self.holder.name
        self.processes = []
        self.lidar_port, self.position_port = (free_port(0, socket.SOCK_DGRAM) for _ in range(2))
        self.motors, self.gps = (os.path.join(self.folder, name) for name in ("motors", "gps"))

    def tearDown(self):
        for process in reversed(self.processes):
            process.stop()
        self.holder.cleanup()

    def start(self, name, settings, arguments=()):
        self.processes.append(Process(BINARIES, name, free_port(0), self.folder, settings, arguments))
        return self.processes[-1], self.processes[-1].connect()

    def simulator(self, **settings):
        return self.start("simulator", {"world": WORLD, "motors.link": self.motors, "gps.link": self.gps,
                                        "lidar.port": self.lidar_port, "lidar.position_port": self.position_port, **settings})

    def supervisor(self, ports, processes=(), samples=SAMPLES, given=None):
        self.etc = os.path.join(self.folder, "etc")
        os.makedirs(self.etc, exist_ok=True)
        own = os.path.join(self.etc, "supervisor.json")
        if not os.path.exists(own):
            put(own, {"processes": list(processes), "setup": {
                    "folder": self.etc, "samples": samples, "ports": list(ports), "lidar_port": self.lidar_port,
                    "position_port": self.position_port}})
        process, client = self.start("supervisor", given or {}, ("--config", own))
        self.address = f"127.0.0.1:{process.port}"
        return client

    def ctl(self, *arguments, status=0, daemons=None, both=False):
        done = subprocess.run([HERMESCTL, "setup", *arguments, "--daemons", daemons or self.address], capture_output=True,
                              text=True, timeout=120, stdin=subprocess.DEVNULL)
        self.assertEqual(done.returncode, status, done.stderr + done.stdout)
        if both:
            return done.stdout + done.stderr
        return done.stdout if status == 0 else done.stderr

    def found(self, *arguments):
        findings = json.loads(self.ctl("--list", "--json", *arguments))
        return findings, {one["path"]: one for one in findings["serial"]}

    def file(self, name):
        return json.loads(text_of(os.path.join(self.etc, name + ".json")))

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
        self.assertEqual((motors["controllers"]["kind"], motors["frame"]["layout"]), ("arduino", "differential"))
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

    @staticmethod
    def sleeper(name, **entry):
        """A process of that name that is in nobody's way."""
        return {"name": name, "program": "/bin/sleep", "arguments": ["1000"], **entry}

    def test_from_nothing_to_settings(self):
        self.simulator()
        names = ["motorcontrol", "seriallogger", "velodynelogger", "scanmatcher"]
        supervisor = self.supervisor([self.motors, self.gps], [self.sleeper(name) for name in [*names, "softwaretrigger"]])
        text = self.ctl("--yes")
        self.assertIn("motorcontrol controllers.1.address = 128", text)
        url = f"serial://{self.motors}?baud=115200"
        self.assertEqual(self.file("motorcontrol"), {"controllers": {"1": {"url": url, "address": 128},
                                                                     "2": {"url": url, "address": 129}}})
        self.assertEqual(self.file("seriallogger")["ports"][0]["view"], "nmea")
        self.assertEqual(self.file("velodynelogger"), {"decode": {"model": "hdl32e"}})
        processes = {one["name"]: one for one in supervisor.call("process.list")["processes"]}
        self.assertEqual([name for name, one in processes.items() if one["autostart"]], names)
        for name in names:
            self.assertEqual(processes[name]["state"], "running", name)
        self.assertEqual(processes["softwaretrigger"]["state"], "stopped")
        before = {name: self.file(name) for name in names[:3]}
        self.ctl("--yes")  # again
        self.assertEqual({name: self.file(name) for name in before}, before)

    def test_ends_and_starts_its_own_processes(self):
        self.simulator()
        url = f"serial://{self.motors}?baud=115200"
        listen = f"tcp://127.0.0.1:{free_port(0)}?protocol=json"
        arguments = ["--listen", listen, "--set", f"controllers.1.url={url}", "--set", f"controllers.2.url={url}"]
        supervisor = self.supervisor([self.motors], [
            {"name": "motorcontrol", "arguments": arguments, "autostart": True},
            {"name": "idle", "program": "/bin/sleep", "arguments": ["1000"], "autostart": True},
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
        self.assertEqual(findings["restarted"], ["motorcontrol"])
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
            if "motorcontrol" in proposal["settings"]:
                break
        self.assertEqual((serial[simulated]["kind"], serial[self.motors]["kind"]), ("roboclaw", "roboclaw"))
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

    def test_sample_and_undo(self):
        supervisor = self.supervisor([])
        with open(os.path.join(self.etc, "seriallogger.json"), "w", encoding="utf-8") as file:
            file.write('{"ports": [')  # broken: a sample mends it
        with open(os.path.join(self.etc, "motorcontrol.json"), "w", encoding="utf-8"):
            pass  # empty, as after a power cut
        own = self.file("supervisor")
        samples = os.path.join(self.folder, "samples")
        os.makedirs(os.path.join(samples, "quiet"))
        for name, settings in (("supervisor", {"robot": "sampled"}), ("seriallogger", {"log": {"level": "error"}}),
                               ("motorcontrol", {"motion": {"vx": 0.5}, "log": {"level": "/etc/hermes/x"}})):
            put(os.path.join(samples, "quiet", name + ".json"), settings)
        supervisor.call("settings.set", values={"setup": {"samples": samples}})
        said = self.ctl("quiet", status=1)
        self.assertIn("nothing was changed: motorcontrol", said)
        self.assertIn("log.level", said)
        self.assertEqual(set(os.listdir(self.etc)), {"supervisor.json", "seriallogger.json", "motorcontrol.json"})
        put(os.path.join(samples, "quiet", "motorcontrol.json"), {"motion": {"vx": 0.5}})
        said = self.ctl("quiet", both=True)
        self.assertIn("written: ", said)
        self.assertRegex(said, "seriallogger.json: line 1: .* is not taken over")
        self.assertEqual(self.file("motorcontrol"), {"motion": {"vx": 0.5}})
        self.assertEqual(self.file("supervisor"), {"robot": "sampled", "setup": {**own["setup"], "samples": SAMPLES}})
        self.assertEqual(supervisor.call("settings.get", path="robot"), "sampled")
        self.assertIn("written: ", self.ctl("--undo"))
        self.assertEqual(self.file("supervisor"), own)
        self.assertEqual(self.file("motorcontrol"), {})
        self.assertEqual(supervisor.call("settings.get", path="robot"), "")
        self.assertIn("nothing to undo", self.ctl("--undo", status=1))
        self.assertIn('no sample "../quiet"', self.ctl("../quiet", status=2))
        self.assertIn("exclude each other", self.ctl("quiet", "--list", status=2))
        self.assertIn("this is no terminal", self.ctl(status=2))

    def test_a_process_that_leaves_the_list_is_named(self):
        samples = os.path.join(self.folder, "samples")
        os.makedirs(os.path.join(samples, "scanner"))
        put(os.path.join(samples, "scanner", "supervisor.json"), {"processes": [self.sleeper("scanmatcher")]})
        supervisor = self.supervisor([], samples=samples, processes=[self.sleeper("scanmatcher"), self.sleeper("motorcontrol")])
        shown = self.ctl("scanner", both=True)
        self.assertIn("motorcontrol is no process of the supervisor any more, and ends; setup.undo puts it back", shown)
        self.assertNotIn("scanmatcher is no process", shown)
        self.assertEqual([one["name"] for one in supervisor.call("process.list")["processes"]], ["scanmatcher"])
        self.ctl("--undo")
        self.assertEqual([one["name"] for one in supervisor.call("process.list")["processes"]], ["scanmatcher", "motorcontrol"])

    def test_command_line_holds(self):
        supervisor = self.supervisor([], given={"setup.folder": self.folder, "robot": "told"})
        put(os.path.join(self.folder, "supervisor.json"), {"robot": "written"})
        written = supervisor.call("setup.apply", settings={"supervisor": {"limits": {"clients": 30}}})
        self.assertEqual(written["files"], [os.path.join(self.folder, "supervisor.json")])
        now = supervisor.call("settings.get")
        self.assertEqual((now["setup"]["folder"], now["robot"], now["limits"]["clients"]), (self.folder, "told", 30))
        written = supervisor.call("setup.apply", settings={"seriallogger": {"limits": {"clients": 30}}})
        self.assertEqual(written["files"], [os.path.join(self.folder, "seriallogger.json")])

    def test_samples_are_valid(self):
        samples = sorted(os.listdir(SAMPLES))
        self.assertEqual(samples, ["differential", "mecanum", "simulator", "vlp16"])
        for sample in samples:
            for name in os.listdir(os.path.join(SAMPLES, sample)):
                path = os.path.join(SAMPLES, sample, name)
                daemon = os.path.join(BINARIES, "hermes-" + name.removesuffix(".json"))
                done = subprocess.run([daemon, "--check", "--config", path], capture_output=True, text=True, timeout=30)
                self.assertEqual(done.returncode, 0, f"{path}: {done.stderr}")
                shown = subprocess.run([daemon, "--print-settings"], capture_output=True, text=True, timeout=30)
                self.differ(path, json.loads(text_of(path)), json.loads(shown.stdout))

    def differ(self, path, settings, defaults):
        """Only what differs from the defaults is in it."""
        for name, value in settings.items():
            if isinstance(value, dict):
                self.differ(f"{path} {name}", value, defaults[name])
            else:
                self.assertNotEqual(value, defaults[name], f"{path}: {name} is the default")

    def at_terminal(self, arguments, answers):
        """What hermesctl shows at a terminal that gives these answers, each when it is asked for."""
        terminal, far = pty.openpty()
        settings = termios.tcgetattr(far)
        settings[3] &= ~termios.ECHO
        termios.tcsetattr(far, termios.TCSANOW, settings)
        process = subprocess.Popen([HERMESCTL, "setup", *arguments], stdin=far, stdout=far, stderr=far)
        os.close(far)
        shown, begin = "", 0
        with open(terminal, "rb", buffering=0) as output:
            for question, answer in answers:
                while question not in shown[begin:]:
                    try:
                        shown += output.read(4096).decode()
                    except OSError:
                        self.fail(f"{question} was not asked: {shown}")
                begin = shown.index(question, begin) + len(question)
                os.write(terminal, answer.encode() + b"\n")
            try:
                while True:
                    shown += output.read(4096).decode()
            except OSError:  # it has ended
                return process.wait(60), shown

    def test_questions(self):
        self.simulator()
        samples = os.path.join(self.folder, "samples")
        os.makedirs(os.path.join(samples, "rover"))
        for name, settings in (("supervisor", {"processes": [self.sleeper("motorcontrol")]}),
                               ("motorcontrol", {"motion": {"vx": 0.5}})):
            put(os.path.join(samples, "rover", name + ".json"), settings)
        supervisor = self.supervisor([self.motors], samples=samples)
        arguments = ("--daemons", self.address)
        status, shown = self.at_terminal(arguments, [("Which robot is it? rover;", "submarine"), ("Which robot is it?", "rover"),
                                                     ("what they record ends", "n"), ("wheels off the ground", "y"),
                                                     ("Write these settings?", "no")])
        self.assertEqual(status, 1, shown)
        self.assertIn("nothing was changed", shown)
        self.assertEqual(os.listdir(self.etc), ["supervisor.json"])
        status, shown = self.at_terminal(arguments, [("Which robot is it?", "rover"), ("what they record ends", "y"),
                                                     ("wheels off the ground", "y"), ("Write these settings?", "y"),
                                                     ("Test the wheels?", "n")])
        self.assertEqual(status, 0, shown)
        self.assertEqual(self.file("motorcontrol")["motion"], {"vx": 0.5})
        self.assertEqual(self.file("motorcontrol")["controllers"]["2"]["address"], 129)
        self.assertEqual(supervisor.call("process.list")["processes"][0]["state"], "running")

    def test_wheels(self):
        _, simulator = self.simulator()
        supervisor = self.supervisor([self.motors])
        url = f"serial://{self.motors}?baud=115200"
        process, motors = self.start("motorcontrol", {"controllers.1.url": url, "controllers.2.url": url})
        wait_for("ready", lambda: motors.call("motor.state")["ready"])
        arguments = ("--wheels", "--daemons", f"{self.address},127.0.0.1:{process.port}")
        status, shown = self.at_terminal(arguments, [("lifted", "no")])
        self.assertEqual(status, 1, shown)
        self.assertIn("no wheel was turned", shown)
        for _ in range(3):  # on a busy machine the simulated controllers may answer too late
            status, shown = self.at_terminal(arguments, [
                ("lifted", "lifted"), ("What turned?", "b"), ("What turned?", "what"), ("What turned?", "rl"),
                ("What turned?", "frb"), ("What turned?", ""), ("Write these settings?", "y")])
            if status == 0:
                break
            release(motors)
        self.assertEqual(status, 0, shown)
        self.assertRegex(shown, r"its encoder tells (0\.9|1\.0)\d rad/s")
        self.assertEqual(self.file("motorcontrol"), {"wheels": {
            "front_left": {"controller": 1, "motor": 1, "reversed": True},
            "rear_left": {"controller": 1, "motor": 2, "reversed": False},
            "front_right": {"controller": 2, "motor": 1, "reversed": True}}})
        self.assertEqual(simulator.call("sim.state")["motors"]["wheels_rps"], [0, 0, 0, 0])
        self.assertFalse(motors.call("control.state")["held"])
        self.assertEqual(supervisor.call("daemon.status")["state"], "running")


if __name__ == "__main__":
    unittest.main()
