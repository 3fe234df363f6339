#!/usr/bin/env python3
"""From what is plugged in to settings, against a simulator at the far end of real wires: hermesctl setup writes settings that the daemons
take, asks a person, tests the wheels, and puts back what was there."""
import json
import os
import pty
import subprocess
import termios
import unittest

from setup_case import SAMPLES, SetupCase
from support import BINARIES, HERMESCTL, put, release, text_of, wait_for


class SetupSettings(SetupCase):
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
