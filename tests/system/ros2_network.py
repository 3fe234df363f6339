#!/usr/bin/env python3
"""Which networks hermes-ros2 is on: another computer, here a name space of the network of its own, sees and drives the robot where it is told
so, and by no other way. Skipped where such a name space cannot be made (it needs root)."""
import os
import subprocess
import sys
import unittest

from ros2_commands import HALL, TWIST, CommandCase, twist
from ros2_robot import SKIPPED, skip_without_programs
from ros2_support import free_domain, ros_cdr
from support import SOURCE

NAME = f"hermes-{os.getpid()}"
LINK = f"ros{os.getpid() % 1000000}"
HERE, THERE = (f"198.18.{os.getpid() % 256}.{host}" for host in (1, 2))
WITHIN = ["ip", "netns", "exec", NAME]
DATAGRAMS = os.path.join(SOURCE, "tests", "support", "rtps_datagrams.py")


def ip(*words):
    return subprocess.run(["ip", *words], capture_output=True, check=False).returncode == 0


def second_computer():
    """Whether there is one now, with a cable to this one."""
    try:
        return (ip("netns", "add", NAME) and ip("link", "add", LINK, "type", "veth", "peer", "name", "cable", "netns", NAME) and
                ip("addr", "add", HERE + "/30", "dev", LINK) and ip("link", "set", LINK, "up") and
                ip("-n", NAME, "addr", "add", THERE + "/30", "dev", "cable") and ip("-n", NAME, "link", "set", "cable", "up") and
                ip("-n", NAME, "link", "set", "lo", "up"))
    except OSError:
        return False


class Networks(CommandCase):
    WORLD, SETTINGS = HALL, {"commands": True}

    def send(self, address, domain, within=()):
        """Datagrams of somebody who hears no answer; ended after the test."""
        sample = ros_cdr.encode(TWIST, twist(0.15)).hex()
        process = subprocess.Popen([*within, sys.executable, DATAGRAMS, address, str(domain), "rt/cmd_vel", ros_cdr.dds_name(TWIST), sample, "60"])
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        return process

    def test_nobody_from_elsewhere(self):
        self.send(HERE, self.domain, WITHIN)
        self.assert_stands()
        peer = self.peer(None, "--own", THERE, "--others", HERE, within=WITHIN)
        peer.write("/cmd_vel", TWIST)
        peer.send("/cmd_vel", twist(0.15), count=0, hz=20)
        self.assert_stands()
        self.assertEqual(peer.listed()["participants"], {})
        self.send("127.0.0.1", self.domain)  # the same from here: it is what Hermes understands
        self.wait_for_drive(0.15)

    def test_network_that_is_named(self):
        domain = free_domain()
        self.ros2(domain, commands=True, networks=[LINK])
        peer = self.peer(domain, "--own", THERE, "--others", HERE, within=WITHIN)
        peer.read("/odom", "nav_msgs/Odometry")
        peer.write("/cmd_vel", TWIST)
        peer.wait_for_count("/odom", 10)
        peer.send("/cmd_vel", twist(0.15), count=0, hz=20)
        self.wait_for_drive(0.15)
        peer.close()


if __name__ == "__main__":
    skip_without_programs()
    try:
        if not second_computer():
            print("no name space of the network can be made here")
            sys.exit(SKIPPED)
        unittest.main(verbosity=2)
    finally:
        ip("link", "del", LINK)
        ip("netns", "del", NAME)
