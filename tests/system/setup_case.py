"""A supervisor whose settings files are in a folder of the test's own, a simulator at the far end of real wires, and hermesctl setup."""
import json
import os
import socket
import subprocess
import tempfile
import unittest

from support import BINARIES, HERMESCTL, SOURCE, WORLD, Process, free_port, put, text_of

SAMPLES = os.path.join(SOURCE, "deploy", "settings")


class SetupCase(unittest.TestCase):
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

    @staticmethod
    def sleeper(name, **entry):
        """A process of that name that is in nobody's way."""
        return {"name": name, "program": "/bin/sleep", "arguments": ["1000"], **entry}
