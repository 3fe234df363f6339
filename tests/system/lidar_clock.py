#!/usr/bin/env python3
"""A lidar without GPS, whose hour begins anywhere and whose clock drifts: its scans are stamped by the host's clock, so that the
matcher finds the odometry of each."""
import os
import random
import shutil
import socket
import tempfile
import time
import unittest

from support import BINARIES, WORLD, Daemon, Process, free_port, wait_for


class LidarClock(unittest.TestCase):
    def start(self, name, **settings):
        process = Process(BINARIES, name, free_port(0), self.folder, settings)
        self.addCleanup(process.stop)
        return process, process.connect()

    def robot(self, **clock):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        lidar, position = free_port(0, socket.SOCK_DGRAM), free_port(0, socket.SOCK_DGRAM)
        line = os.path.join(self.folder, "motors")
        self.start("simulator", **{"world": WORLD, "lidar.port": lidar, "lidar.position_port": position, "motors.link": line,
                                   "lidar.gps": "false", **clock})
        serial = f"serial://{line}?baud=115200"
        motors, self.motors = self.start("motorcontrol", **{"controllers.1.url": serial, "controllers.2.url": serial})
        logger, self.logger = self.start("velodynelogger", **{"source.port": lidar, "source.position_port": position,
                                                              "record.folder": self.folder})
        _, self.matcher = self.start("scanmatcher", **{
            "source.address": f"127.0.0.1:{logger.port}", "odometry.address": f"127.0.0.1:{motors.port}", "matcher.start": "mapping",
            "map.folder": self.folder})
        wait_for("the wheels", lambda: self.motors.call("motor.state")["ready"])
        wait_for("scans", lambda: self.matcher.call("matcher.state")["scans"] > 0)
        self.scans = Daemon(port=logger.port, timeout=20)
        self.addCleanup(self.scans.close)

    def test_the_odometry_of_each_scan_is_found(self):
        ahead = random.uniform(0, 3600)
        print(f"the sensor's clock is {ahead:.0f} s ahead")
        self.robot(**{"lidar.clock_s": ahead, "lidar.drift_ppm": 100})
        wait_for("a clock that has settled", lambda: "stamped by this host's" in str(self.logger.call("daemon.status")["health"]))
        before = self.matcher.call("matcher.state")
        self.motors.call("control.acquire", timeout_s=5)
        stream = self.scans.subscribe("scan2d")
        sooner = []
        for _ in range(30):
            self.motors.call("motor.drive", vx=0.1)
            scan = next(stream)["data"]
            self.assertEqual(scan["clock"], "host")
            sooner.append(time.time() - scan["stamp"] - scan["duration_s"])
        self.motors.call("motor.stop")
        self.assertLess(-0.005, min(sooner))  # no scan is of a time to come
        self.assertLess(min(sooner), 0.1)
        self.assertLess(scan["clock_error_s"], 0.1)
        after = self.matcher.call("matcher.state")
        self.assertGreater(after["scans"], before["scans"] + 25)
        self.assertEqual(after["by_odometry"] - before["by_odometry"], after["scans"] - before["scans"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
