#!/usr/bin/env python3
"""What daemons say first: one that cannot work as yet says why, and no other line looks like a fault. Where a file is that a client
names by a relative path."""
import os
import re
import socket
import subprocess
import tempfile
import unittest

from support import BINARIES, HERMESCTL, WORLD, Process, free_port, text_of, wait_for


class FirstWords(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        self.addCleanup(holder.cleanup)
        self.folder = holder.name

    def start(self, name, **settings):
        process = Process(BINARIES, name, free_port(0), self.folder, settings)
        self.addCleanup(process.stop)
        return process, process.connect()

    def log(self, name):
        return text_of(os.path.join(self.folder, name + ".log"))

    def simulator(self, **settings):
        return self.start("simulator", **{"lidar.port": free_port(0, socket.SOCK_DGRAM), "lidar.position_port": 0, **settings})

    def test_a_simulator_without_a_world(self):
        process, simulator = self.simulator()
        wait_for("the line of the log", lambda: "lidar is warn: no world is loaded" in self.log("simulator"))
        shown = subprocess.run([HERMESCTL, "list", "--daemons", f"127.0.0.1:{process.port}"], capture_output=True, text=True,
                               timeout=60, check=True).stdout
        self.assertIn("sends no packets", shown)
        simulator.call("sim.load", world=WORLD)
        wait_for("packets", lambda: simulator.call("sim.state")["packets"] > 0)
        wait_for("no warning", lambda: all(one["level"] == "ok" for one in simulator.call("daemon.status")["health"]
                                           if one["name"] == "lidar"))

    def test_a_logger_knows_its_disk(self):
        _, logger = self.start("velodynelogger", **{"source.port": free_port(0, socket.SOCK_DGRAM), "source.position_port": 0,
                                                    "record.folder": os.path.join(self.folder, "recordings")})
        disk = [one for one in logger.call("daemon.status")["health"] if one["name"] == "disk"]
        self.assertEqual([one["level"] for one in disk], ["ok"])
        wait_for("the free space", lambda: any("MB are free" in one["message"] for one in logger.call("daemon.status")["health"]))
        self.assertNotIn("disk is", self.log("velodynelogger"))

    def test_a_matcher_that_begins(self):
        lidar, position = free_port(0, socket.SOCK_DGRAM), free_port(0, socket.SOCK_DGRAM)
        self.start("simulator", **{"world": WORLD, "lidar.port": lidar, "lidar.position_port": position})
        logger, _ = self.start("velodynelogger", **{"source.port": lidar, "source.position_port": position,
                                                    "record.folder": os.path.join(self.folder, "recordings")})
        _, matcher = self.start("scanmatcher", **{"source.address": f"127.0.0.1:{logger.port}", "matcher.start": "nothing"})
        for _ in range(5):
            matcher.call("matcher.start", mode="mapping")
            wait_for("scans", lambda: matcher.call("matcher.state")["scans"] > 3)
            matcher.call("matcher.stop")
            matcher.call("map.clear")
        self.assertEqual(re.findall(r".* (?:warning|error) .*", self.log("scanmatcher")), [])

    def test_a_matcher_without_its_source(self):
        _, matcher = self.start("scanmatcher", **{"source.address": f"127.0.0.1:{free_port(0)}"})
        matcher.call("matcher.start", mode="mapping")
        wait_for("the fault", lambda: "source is error: no connection to" in self.log("scanmatcher"))

    def test_a_relative_path(self):
        _, simulator = self.simulator()
        relative = os.path.relpath(WORLD)
        loaded = simulator.call("sim.load", world=relative)
        self.assertEqual(loaded["path"], WORLD)
        self.assertEqual(simulator.call("sim.state")["world"], WORLD)


if __name__ == "__main__":
    unittest.main()
