#!/usr/bin/env python3
"""hermes-ros2 with DDS security, and nodes of another vendor: with an operator's keys one drives, with an observer's it looks, with keys of
somebody else or none it sees nothing."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

from ros2_commands import HALL, TWIST, CommandCase, twist
from ros2_robot import skip_without_programs
from ros2_support import PeerError, ros_cdr
from support import HERMESCTL, SOURCE, wait_for

DATAGRAMS = os.path.join(SOURCE, "tests", "support", "rtps_datagrams.py")


def keys(store, name, role):
    """The folder of an enclave."""
    subprocess.run([HERMESCTL, "keys", "ros2", store, name, "--role", role], check=True, stdout=subprocess.DEVNULL)
    return os.path.join(store, "enclaves", name)


class Security(CommandCase):
    WORLD = HALL

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        store, foreign = os.path.join(folder, "ours"), os.path.join(folder, "theirs")
        cls.SETTINGS = {"commands": True, "enclave": keys(store, "robot1", "daemon")}
        cls.operator, cls.observer = keys(store, "anna", "operator"), keys(store, "visitor", "observer")
        cls.stranger = keys(foreign, "anna", "operator")
        super().setUpClass()

    def with_keys(self, folder):
        """A node that reads odometry and publishes velocities, where it may."""
        peer = self.peer(None, *(("--keys", folder) if folder else ()))
        peer.read("/odom", "nav_msgs/Odometry")
        peer.write("/cmd_vel", TWIST)
        peer.send("/cmd_vel", twist(0.15), count=0, hz=20)
        return peer

    def test_operator(self):
        peer = self.with_keys(self.operator)
        peer.wait_for_count("/odom", 10)
        self.wait_for_drive(0.15)
        peer.close()

    def test_observer(self):
        peer = self.peer(None, "--keys", self.observer)
        peer.read("/odom", "nav_msgs/Odometry")
        peer.wait_for_count("/odom", 10)
        with self.assertRaises(PeerError):  # its own library knows what it may
            peer.write("/cmd_vel", TWIST)
        self.assert_stands()

    def test_who_has_no_keys_of_ours(self):
        operator = self.with_keys(self.operator)
        for folder in (None, self.stranger):
            peer = self.with_keys(folder)
            operator.stop("/cmd_vel")
            wait_for("standstill", self.robot.stands)
            before = len(operator.samples_of("/odom"))
            self.assert_stands()
            operator.wait_for_count("/odom", before + 50)  # the daemon tells
            self.assertEqual((peer.samples_of("/odom"), peer.writers_of("/odom")), ([], []))
            peer.close()
        operator.close()

    def test_datagrams_without_keys(self):
        words = ["127.0.0.1", str(self.domain), "rt/cmd_vel", ros_cdr.dds_name(TWIST), ros_cdr.encode(TWIST, twist(0.15)).hex(), "60", "127.0.0.1"]
        process = subprocess.Popen([sys.executable, DATAGRAMS, *words])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.assert_stands()


if __name__ == "__main__":
    skip_without_programs()
    unittest.main(verbosity=2)
