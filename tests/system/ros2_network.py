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
from support import SOURCE, wait_for

NAME = f"hermes-{os.getpid()}"
NET = f"198.18.{os.getpid() % 256}"
CABLES = [f"ros{os.getpid() % 1000000}{letter}" for letter in "ab"]
HERE, THERE = ([f"{NET}.{4 * number + host}" for number in range(len(CABLES))] for host in (1, 2))
WITHIN = ["ip", "netns", "exec", NAME]
DATAGRAMS = os.path.join(SOURCE, "tests", "support", "rtps_datagrams.py")


def ip(*words):
    return subprocess.run(["ip", *words], capture_output=True, check=False).returncode == 0


def second_computer():
    """Whether there is one now, with two cables to this one."""
    try:
        return ip("netns", "add", NAME) and ip("-n", NAME, "link", "set", "lo", "up") and all(
            ip("link", "add", cable, "type", "veth", "peer", "name", cable, "netns", NAME) and
            ip("addr", "add", here + "/30", "dev", cable) and ip("link", "set", cable, "up") and
            ip("-n", NAME, "addr", "add", there + "/30", "dev", cable) and ip("-n", NAME, "link", "set", cable, "up")
            for cable, here, there in zip(CABLES, HERE, THERE))
    except OSError:
        return False


class Networks(CommandCase):
    WORLD, SETTINGS = HALL, {"commands": True}

    def send(self, address, domain, told="127.0.0.1", within=()):
        """Datagrams of somebody who hears no answer and tells this address as its own; ended after the test."""
        words = [address, str(domain), "rt/cmd_vel", ros_cdr.dds_name(TWIST), ros_cdr.encode(TWIST, twist(0.15)).hex(), "60", told]
        process = subprocess.Popen([*within, sys.executable, DATAGRAMS, *words])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_nobody_from_elsewhere(self):
        self.send(HERE[0], self.domain, within=WITHIN)
        self.assert_stands()
        peer = self.peer(None, "--own", THERE[0], "--others", HERE[0], within=WITHIN)
        peer.write("/cmd_vel", TWIST)
        peer.send("/cmd_vel", twist(0.15), count=0, hz=20)
        self.assert_stands()
        self.assertEqual(peer.listed()["participants"], {})
        self.send("127.0.0.1", self.domain)  # the same from here: it is what Hermes understands
        self.wait_for_drive(0.15)

    def test_network_that_is_named(self):
        domain = free_domain()
        self.ros2(domain, commands=True, networks=[CABLES[0]])
        self.send(HERE[1], domain, THERE[0], WITHIN)  # by the other cable
        self.assert_stands()
        blind = self.send(HERE[0], domain, THERE[0], WITHIN)
        self.wait_for_drive(0.15)
        blind.kill()
        wait_for("standstill", self.robot.stands, 5)
        peer = self.peer(domain, "--own", THERE[0], "--others", HERE[0], within=WITHIN)
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
        for end in CABLES:
            ip("link", "del", end)
        ip("netns", "del", NAME)
