#!/usr/bin/env python3
"""Nodes of ROS 2 that command the robot: by cmd_vel where that is allowed and nobody else drives, until they fall silent or are killed; by
initialpose; and its stop, always."""
import math
import signal
import time
import unittest

from recorded_robot import Driver
from ros2_robot import MOUNT, SMALL, Heard, Ros2Case, apart, compose, inverse, pose_of, skip_without_programs
from ros2_support import free_domain, ros_cdr
from support import PATIENCE, Daemon, release, wait_for

TWIST, STAMPED = "geometry_msgs/Twist", "geometry_msgs/TwistStamped"


# So large that the robot meets no wall.
HALL = {"name": "hall", "poses": [[0, 0, 0]], "edges": [[-12, -9, 12, -9], [12, -9, 12, 9], [12, 9, -12, 9], [-12, 9, -12, -9]]}
GRAPH, GRAPH_TYPE = "ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"


def twist(vx=0.0, vy=0.0, omega=0.0):
    return {"linear": {"x": vx, "y": vy, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": omega}}


class CommandCase(Ros2Case):
    """What tests of commands share; each begins with a robot that stands and that nobody drives."""

    WORLD = HALL

    def setUp(self):
        self.motors = self.robot.motors
        self.addCleanup(self.end_stop)
        wait_for("standstill", lambda: self.robot.stands() and not self.motors.call("control.state")["held"])
        wait_for("readiness", lambda: self.motors.call("motor.state")["ready"])

    def end_stop(self):
        if self.motors.call("motor.state")["estop"]:
            release(self.motors)

    def true_twist(self):
        return self.robot.simulator.call("sim.state")["twist"]

    def driver(self, message, kind=TWIST, hz=20):
        """A node that publishes this on cmd_vel, as one that does not know who listens."""
        peer = self.peer()
        peer.write("/cmd_vel", kind)
        peer.send("/cmd_vel", message, count=0, hz=hz)
        return peer

    def wait_for_drive(self, vx, omega=0.0):
        def is_driving():
            now = self.true_twist()
            return abs(now["vx"] - vx) < 0.02 and abs(now["omega"] - omega) < 0.05
        try:
            wait_for(f"a drive with {vx} m/s", is_driving, 20)
        except AssertionError as error:
            state = self.motors.call("motor.state")
            raise AssertionError(f"{error}: {state['halted']}; {state['control']}, target {state['target']}") from None

    def moved(self, cycles=100):
        """How far the wheels bring the robot in so many cycles of the motor control, two seconds: x, y, heading."""
        with Daemon(port=self.robot.ports["motorcontrol"]) as motors:
            poses = [pose_of(message["data"]["pose"]) for _, message in zip(range(cycles + 10), motors.subscribe("odometry", queue=1000))][10:]
        return [last - first for first, last in zip(poses[0], poses[-1])]

    def assert_stands(self, cycles=100):
        self.assertLess(max(map(abs, self.moved(cycles))), 0.003)


class Commands(CommandCase):
    SETTINGS = {"commands": True}

    def test_killed_publisher(self):
        peer = self.driver(twist(0.2, 0.0, 0.3))
        self.wait_for_drive(0.2, 0.3)
        holder = self.motors.call("control.state")["holder"]
        self.assertRegex(holder, "(?i)ros")
        peer.kill()
        began = time.monotonic()
        wait_for("standstill", self.robot.stands, 5)
        print(f"stands {time.monotonic() - began:.2f} s after the publisher was killed; the control was held by {holder}")
        self.assertLess(time.monotonic() - began, 1.0 * PATIENCE)
        wait_for("the end of the control", lambda: not self.motors.call("control.state")["held"])

    def test_name_of_who_drives(self):
        """The graph tells which node a writer is of."""
        peer, other = self.driver(twist(0.1)), self.peer()
        mine = lambda: [guid for guid, one in other.listed()["writers"].items()  # noqa: E731
                        if one["topic"] == "rt/cmd_vel" and guid[:24] == peer.guid[:24]]
        writer = bytes.fromhex(wait_for("the writer", mine)[0])
        peer.open("write", GRAPH, GRAPH_TYPE, transient_local=True, depth=1)
        node = {"node_namespace": "/", "node_name": "teleop_keyboard", "writer_gid_seq": [{"data": writer}]}
        peer.send(GRAPH, ros_cdr.encode("rmw_dds_common/ParticipantEntitiesInfo",
                                        {"gid": {"data": bytes.fromhex(peer.guid)}, "node_entities_info_seq": [node]}))
        self.wait_for_drive(0.1)
        item = lambda: next(one for one in self.daemon.call("daemon.status")["health"] if one["name"] == "commands")["message"]  # noqa: E731
        wait_for("its name", lambda: "teleop_keyboard" in item())
        peer.stop("/cmd_vel")
        wait_for("the end of the control", lambda: not self.motors.call("control.state")["held"])
        peer.send("/cmd_vel", twist(-0.1), count=0, hz=20)
        wait_for("its name", lambda: "teleop_keyboard" in (self.motors.call("control.state")["holder"] or ""))
        peer.close()

    def test_silent_publisher(self):
        peer = self.driver(twist(0.0, 0.15))
        wait_for("a drive to the left", lambda: abs(self.true_twist()["vy"] - 0.15) < 0.02)
        peer.stop("/cmd_vel")
        wait_for("standstill", self.robot.stands, 5)
        peer.send("/cmd_vel", twist(0.0, -0.15), count=0, hz=20)
        wait_for("a drive to the right", lambda: abs(self.true_twist()["vy"] + 0.15) < 0.02)
        peer.close()
        wait_for("standstill", self.robot.stands, 5)

    def test_stamped(self):
        """A stamp of zero tells no age; commands that are old are none."""
        peer = self.driver({"header": {"frame_id": "base_link"}, "twist": twist(-0.15)}, STAMPED)
        self.wait_for_drive(-0.15)
        old = {"header": {"stamp": {"sec": int(time.time()) - 60}}, "twist": twist(-0.15)}
        peer.send("/cmd_vel", old, count=0, hz=20)
        wait_for("standstill", self.robot.stands, 5)
        self.assert_stands()
        peer.close()

    def test_readers(self):
        peer = self.peer()
        wait_for("two readers", lambda: len(peer.readers_of("/cmd_vel")) == 2)
        readers = peer.readers_of("/cmd_vel")
        self.assertEqual({reader["type"] for reader in readers}, {ros_cdr.dds_name(TWIST), ros_cdr.dds_name(STAMPED)})
        self.assertEqual({reader["reliable"] for reader in readers}, {False})  # it matches who is reliable and who is not

    def test_who_holds_the_control_keeps_it(self):
        anna = Driver(self.robot.ports["motorcontrol"], "anna", vx=0.1)
        try:
            self.wait_for_drive(0.1)
            peer = self.driver(twist(-0.3))
            self.assertGreater(self.moved()[0], 0.1)
            self.assertEqual(self.motors.call("control.state")["holder"], "anna")
            peer.close()
        finally:
            anna.end()

    def test_who_takes_the_control_over_keeps_it(self):
        peer = self.driver(twist(0.15))
        self.wait_for_drive(0.15)
        with self.robot.processes["motorcontrol"].connect() as anna:
            anna.call("control.acquire", client="anna", timeout_s=30, take_over=True)
            wait_for("standstill", self.robot.stands, 5)
            self.assert_stands()
            self.assertEqual(self.motors.call("control.state")["holder"], "anna")
            peer.close()
            anna.call("control.release")

    def test_stop_of_a_person(self):
        """Who publishes on and on does not drive on."""
        peer = self.driver(twist(0.15))
        self.wait_for_drive(0.15)
        self.motors.call("motor.stop")
        wait_for("standstill", self.robot.stands, 5)
        self.assert_stands()
        peer.stop("/cmd_vel")
        wait_for("the end of the control", lambda: not self.motors.call("control.state")["held"])
        self.assert_stands(50)
        peer.send("/cmd_vel", twist(0.15), count=0, hz=20)  # as somebody does who begins anew
        self.wait_for_drive(0.15)
        peer.close()

    def test_emergency_stop(self):
        peer, other = self.driver(twist(0.15)), self.peer()
        other.write("/emergency_stop", "std_msgs/Bool")
        wait_for("who is to stop", lambda: other.readers_of("/emergency_stop"))
        other.wait_for_match("/emergency_stop", "writer", 2)  # a reader for each kind of writer
        self.wait_for_drive(0.15)
        other.send("/emergency_stop", {"data": False})
        other.send("/emergency_stop", {"data": True}, count=5, hz=5)
        wait_for("the stop", lambda: self.motors.call("motor.state")["estop"], 5)
        wait_for("standstill", self.robot.stands, 5)
        other.send("/emergency_stop", {"data": False}, count=5, hz=10)  # no release
        self.assert_stands()
        self.assertTrue(self.motors.call("motor.state")["estop"])
        release(self.motors)
        self.assert_stands()  # who publishes on and on does not drive when a person lets the robot move again
        peer.close()

    def test_two_nodes(self):
        """One drives at a time: the other does once the first has paused."""
        one = self.driver(twist(0.15))
        self.wait_for_drive(0.15)
        other = self.driver(twist(-0.15))
        self.assertGreater(self.moved()[0], 0.25)
        one.stop("/cmd_vel")
        self.wait_for_drive(-0.15)
        other.close()
        one.close()

    def test_bridge_that_dies(self):
        domain = free_domain()
        process, _ = self.ros2(domain, commands=True)
        peer = self.peer(domain)
        peer.write("/cmd_vel", TWIST)
        peer.send("/cmd_vel", twist(0.15), count=0, hz=20)
        self.wait_for_drive(0.15)
        process.process.kill()
        wait_for("standstill", self.robot.stands, 5)
        self.assert_stands()
        self.assertFalse(self.motors.call("control.state")["held"])

    def test_bridge_that_hangs(self):
        """What it was told before it went on is void."""
        domain = free_domain()
        process, _ = self.ros2(domain, commands=True)
        peer = self.peer(domain)
        peer.write("/cmd_vel", TWIST)
        peer.send("/cmd_vel", twist(0.15), count=0, hz=20)
        self.wait_for_drive(0.15)
        process.process.send_signal(signal.SIGSTOP)
        try:
            wait_for("standstill", self.robot.stands, 5)
            self.assert_stands()
            peer.kill()
        finally:
            process.process.send_signal(signal.SIGCONT)
        self.assert_stands()

    def test_what_is_no_command(self):
        """Numbers that are none, bytes that are missing or too many, and types that do not fit move nothing; what is right then does."""
        right = ros_cdr.encode(TWIST, twist(0.15))
        peer = self.peer()
        peer.write("/cmd_vel", TWIST)
        for wrong in (twist(math.nan), twist(0.1, math.inf), twist(0.1, 0, -math.inf), right[:-8], right[:20], right[:4], right + bytes(8),
                      b"\0\7" + right[2:]):
            peer.send("/cmd_vel", wrong, count=0, hz=50)
            self.assert_stands(25)
        peer.send("/cmd_vel", right, count=0, hz=20)
        self.wait_for_drive(0.15)
        peer.close()

    def test_initial_pose(self):
        """That of the robot: the matcher is told where the sensor is then."""
        heard = Heard(self.robot.ports["scanmatcher"], "commands")
        poses = Heard(self.robot.ports["scanmatcher"], "pose")
        self.addCleanup(heard.close)
        self.addCleanup(poses.close)
        x, y, theta = compose(pose_of(wait_for("a pose", lambda: poses.messages)[-1]["data"]), inverse(MOUNT))
        told = x + 0.03, y - 0.02, theta + 0.01
        pose = {"position": {"x": told[0], "y": told[1]}, "orientation": {"z": math.sin(told[2] / 2), "w": math.cos(told[2] / 2)}}
        message = {"header": {"frame_id": "map"}, "pose": {"pose": pose}}
        peer = self.peer()
        peer.write("/initialpose", "geometry_msgs/PoseWithCovarianceStamped")
        wait_for("a reader", lambda: peer.readers_of("/initialpose"))
        bad = {"header": {"frame_id": "map"}, "pose": {"pose": {**pose, "position": {"x": math.nan}}}}
        elsewhere = {**message, "header": {"frame_id": "moon"}}
        for other in (bad, elsewhere):
            peer.send("/initialpose", other, count=10, hz=20)
        sets = lambda: [one["data"] for one in heard.messages if one["data"]["method"] == "pose.set"]  # noqa: E731

        def is_told():
            peer.send("/initialpose", message)
            return sets()
        wait_for("the pose", is_told)
        for one in sets():
            params = one["params"]
            self.assertLess(apart(pose_of(params), compose(told, MOUNT)), SMALL, params)


class Refused(CommandCase):
    """As the daemon is without settings."""

    def test_commands(self):
        for kind, message in ((TWIST, twist(0.2)), (STAMPED, {"twist": twist(0.2)})):
            peer = self.driver(message, kind)
            peer.read("/odom", "nav_msgs/Odometry")
            peer.wait_for_count("/odom", 10)
            self.assert_stands()
            self.assertFalse(self.motors.call("control.state")["held"])
            peer.close()

    def test_stop(self):
        peer = self.peer()
        peer.write("/emergency_stop", "std_msgs/Bool")
        wait_for("who is to stop", lambda: peer.readers_of("/emergency_stop"))
        peer.send("/emergency_stop", {"data": True}, count=20, hz=5)
        wait_for("the stop", lambda: self.motors.call("motor.state")["estop"])
        peer.close()


if __name__ == "__main__":
    skip_without_programs()
    unittest.main(verbosity=2)
