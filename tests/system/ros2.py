#!/usr/bin/env python3
"""hermes-ros2 as a node of ROS 2 sees it that is of another vendor: each message of a robot that drives round is what Hermes' own topic says
at the same time, and frames are those that ROS expects."""
import math
import struct
import unittest
import xml.etree.ElementTree

from recorded_robot import Driver
from ros2_robot import (MOUNT, SECOND_MOUNT, SMALL, Heard, Ros2Case, apart, compare_scans, compose, inverse, place, plane, pose_of,
                        skip_without_programs, static_frames)
from ros2_support import stamp_of
from support import wait_for

WHEELS = ("front_left", "front_right", "rear_left", "rear_right")
PLANAR = (0, 1, 5, 6, 7, 11, 30, 31, 35)  # where x, y and heading are in a covariance of x, y, z and three angles


def moves(parent, child):
    """What gives the transforms between two frames in a list of TFMessages."""
    return lambda messages: [one for message in messages for one in message["transforms"]
                             if (one["header"]["frame_id"], one["child_frame_id"]) == (parent, child)]


class Messages(Ros2Case):
    """Of a robot that drives in a circle."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        driver = Driver(cls.robot.ports["motorcontrol"], "anna", vx=0.15, omega=0.3)
        cls.addClassCleanup(driver.end)
        wait_for("a drive", lambda: cls.robot.motors.call("motor.state")["twist"]["vx"] > 0.1)

    def test_a_peer_hears_another(self):
        """What is wrong with the other tests' own means shows here."""
        one, other = self.peer(), self.peer()
        other.read("/a", "sensor_msgs/PointCloud2", depth=1)
        one.write("/a", "sensor_msgs/PointCloud2", depth=1)
        one.wait_for_match("/a", "writer")
        cloud = {"header": {"frame_id": "b"}, "data": bytes(range(256)) * 5000}
        one.send("/a", cloud, count=100, hz=10)
        self.assertEqual(other.wait("/a")["data"], cloud["data"])

    def test_scan(self):
        both, peer = self.follow("velodynelogger", "scan2d", "/scan", "sensor_msgs/LaserScan")
        frame = compare_scans(self, both)
        self.assertIn(frame, static_frames(peer))
        for ros, data in both:
            self.assert_near(ros["scan_time"], 0.1, "scan_time", 0.02)  # the simulated head turns ten times a second
            self.assertTrue(data["lost_packets"] or not any(map(math.isnan, ros["ranges"])))

    def test_points(self):
        both, peer = self.follow("velodynelogger", "cloud", "/points", "sensor_msgs/PointCloud2", count=3, depth=1)
        self.assertIn(both[0][0]["header"]["frame_id"], static_frames(peer))
        for ros, data in both[:2]:
            fields = [(field["name"], field["offset"], field["datatype"], field["count"]) for field in ros["fields"]]
            self.assertEqual(fields[:5], [("x", 0, 7, 1), ("y", 4, 7, 1), ("z", 8, 7, 1), ("intensity", 12, 7, 1), ("ring", 16, 4, 1)])
            self.assertEqual((ros["is_bigendian"], ros["height"] * ros["width"]), (False, len(data["x"])))
            self.assertEqual((ros["row_step"], len(ros["data"])), (ros["width"] * ros["point_step"], ros["height"] * ros["row_step"]))
            found = [struct.unpack_from("<4fH", ros["data"], i * ros["point_step"]) for i in range(len(data["x"]))]
            for (x, y, z, intensity, _), *point in zip(found, data["x"], data["y"], data["z"], data["intensity"]):
                self.assertLess(max(abs(a - b) / max(1, abs(b)) for a, b in zip((x, y, z, intensity), point)), SMALL, point)
            self.compare_rings(found, data["laser"])

    def compare_rings(self, found, lasers):
        """Each laser has a ring of its own; they are counted from the lowest to the highest."""
        self.assertEqual(len({(point[4], laser) for point, laser in zip(found, lasers)}), len(set(lasers)))
        rings = {}
        for x, y, z, _, ring in found:
            rings.setdefault(ring, []).append(math.atan2(z, math.hypot(x, y)))
        heights = [sorted(rings[ring])[len(rings[ring]) // 2] for ring in sorted(rings)]
        self.assertEqual(heights, sorted(heights), "rings are not in the order of their elevations")

    def test_odometry(self):
        both, _ = self.follow("motorcontrol", "odometry", "/odom", "nav_msgs/Odometry", count=50)
        for ros, data in both:
            self.assertEqual((ros["header"]["frame_id"], ros["child_frame_id"]), ("odom", "base_link"))
            pose, twist = ros["pose"]["pose"], ros["twist"]["twist"]
            self.assertLess(apart(plane(pose["position"], pose["orientation"]), pose_of(data["pose"])), SMALL)
            for i, value in zip(PLANAR, data["covariance"]):
                self.assert_near(ros["pose"]["covariance"][i], value, f"covariance[{i}]")
            for name, value in zip(("vx", "vy", "omega"), (twist["linear"]["x"], twist["linear"]["y"], twist["angular"]["z"])):
                self.assert_near(value, data["twist"][name], name)
            self.assertEqual([twist["linear"]["z"], twist["angular"]["x"], twist["angular"]["y"], pose["position"]["z"]], [0] * 4)

    def test_frames_of_wheels_and_matcher(self):
        both, peer = self.follow("motorcontrol", "odometry", "/tf", "tf2_msgs/TFMessage", 50, moves("odom", "base_link"), depth=100)
        for ros, data in both:
            self.assertLess(apart(place(ros), pose_of(data["pose"])), SMALL)
        poses = Heard(self.robot.ports["scanmatcher"], "pose")
        self.addCleanup(poses.close)
        wait_for("a pose", lambda: poses.messages)
        wait_for("poses that come after it", lambda count=len(peer.samples_of("/tf")): len(peer.samples_of("/tf")) > count + 50)
        told = [pose_of(one["data"]["map_to_odometry"]) for one in poses.messages[:]]
        shown = [place(one) for one in moves("map", "odom")(peer.messages("/tf")) if stamp_of(one) > poses.messages[0]["stamp"] + 0.3]
        self.assertGreater(len(set(shown)), 3)
        for one in told[2:-3]:
            self.assertLess(min(apart(one, other) for other in shown), SMALL, "a correction that is not shown")

    def test_frames_form_a_tree(self):
        """map, odom, base_link, sensors (REP 105); what they lead to is where the matcher says that the sensor is."""
        peer = self.peer()
        peer.read("/tf", "tf2_msgs/TFMessage", depth=100)
        peer.wait("/tf")  # what is written before the endpoints have found each other is lost
        heard = Heard(self.robot.ports["scanmatcher"], "pose")
        self.addCleanup(heard.close)
        last = lambda parent, child: max(map(stamp_of, moves(parent, child)(peer.messages("/tf"))), default=0)  # noqa: E731
        wait_for("20 poses", lambda: len(heard.messages) > 20)
        until = heard.messages[20]["stamp"]
        wait_for("the frames up to then", lambda: last("map", "odom") > until + 0.2 and last("odom", "base_link") > until + 0.2)
        fixed, parents = static_frames(peer), {}
        self.assertFalse({"map", "odom", "base_link"} & fixed.keys())
        moving = [one for message in peer.messages("/tf") for one in message["transforms"]]
        for one in moving + list(fixed.values()):
            self.assertEqual(parents.setdefault(one["child_frame_id"], one["header"]["frame_id"]), one["header"]["frame_id"])
        self.assertEqual((parents.pop("odom"), parents.pop("base_link")), ("map", "odom"))
        self.assertFalse({one["child_frame_id"] for one in moving} & fixed.keys())
        for child in parents:
            at, steps = child, 0
            while at != "base_link":
                at, steps = parents[at], steps + 1
                self.assertLess(steps, 10, f"{child} does not lead to base_link: {parents}")
        mount = place(fixed[self.scan_frame(peer)])
        self.assertLess(apart(mount, MOUNT), SMALL)
        self.compare_chain(moving, mount, heard.messages[:20])

    def compare_chain(self, moving, mount, poses):
        def at(parent, child, stamp):
            """The transform then, between the two beside it, as tf2 finds it."""
            them = sorted(((stamp_of(one), place(one)) for one in moves(parent, child)([{"transforms": moving}])), key=lambda one: one[0])
            before, after = ([one for one in them if (one[0] <= stamp) == is_before] for is_before in (True, False))
            if not before or not after:
                return None
            (t, a), (u, b) = before[-1], after[0]
            share = (stamp - t) / (u - t)
            return tuple(x + share * math.remainder(y - x, 2 * math.pi) for x, y in zip(a, b))
        checked = 0
        for pose in poses:
            links = [at("map", "odom", pose["stamp"]), at("odom", "base_link", pose["stamp"])]
            if all(links):
                found = compose(compose(*links), mount)
                self.assertLess(apart(found, pose_of(pose["data"])), 0.03, (found, pose))
                checked += 1
        self.assertGreater(checked, 10)

    @staticmethod
    def scan_frame(peer):
        peer.read("/scan", "sensor_msgs/LaserScan")
        return peer.wait("/scan")["header"]["frame_id"]

    def test_pose(self):
        """That of the robot, not of the sensor."""
        both, _ = self.follow("scanmatcher", "pose", "/pose", "geometry_msgs/PoseWithCovarianceStamped")
        for ros, data in both:
            self.assertEqual(ros["header"]["frame_id"], "map")
            pose, found = ros["pose"]["pose"], [ros["pose"]["covariance"][i] for i in PLANAR]
            at = plane(pose["position"], pose["orientation"])
            self.assertLess(apart(at, compose(pose_of(data), inverse(MOUNT))), SMALL)
            if data["covariance"]:
                for value, expected in zip(found, self.moved(data["covariance"], at, pose_of(data))):
                    self.assert_near(value, expected, "covariance", SMALL)

    @staticmethod
    def moved(covariance, to, origin):
        """The covariance of the pose `to` that is fixed to `origin`, whose covariance this is."""
        jacobian = [[1, 0, -(to[1] - origin[1])], [0, 1, to[0] - origin[0]], [0, 0, 1]]
        rows = [covariance[3 * i:3 * i + 3] for i in range(3)]
        half = [[sum(jacobian[i][k] * rows[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
        return [sum(half[i][k] * jacobian[j][k] for k in range(3)) for i in range(3) for j in range(3)]

    def test_battery(self):
        both, _ = self.follow("motorcontrol", "power", "/battery", "sensor_msgs/BatteryState", 5)
        for ros, data in both:
            volts, battery = [one["battery_v"] for one in data["controllers"]], data["battery"]
            self.assertTrue(min(volts) - 1e-5 <= ros["voltage"] <= max(volts) + 1e-5, (ros, volts))
            for found, expected in ((ros["percentage"], battery.get("charge")), (ros["current"], battery.get("current_a"))):
                if expected is None:
                    self.assertTrue(math.isnan(found))
                else:
                    self.assert_near(abs(found), expected, "battery", 1e-5)
            self.assertFalse(ros["current"] > 0, "the current of a battery that is discharged is negative")
            self.assertTrue(math.isnan(ros["temperature"]) and ros["present"], ros)

    def test_fix(self):
        both, peer = self.follow("seriallogger", "fix", "/fix", "sensor_msgs/NavSatFix", 3)
        self.assertIn(both[0][0]["header"]["frame_id"], {"base_link", *static_frames(peer)})
        for ros, data in both:
            self.assert_near(ros["latitude"], data["lat_deg"], "latitude", 1e-9)
            self.assert_near(ros["longitude"], data["lon_deg"], "longitude", 1e-9)
            self.assertTrue(math.isnan(ros["altitude"]) or abs(ros["altitude"] - data["alt"]) < SMALL, ros)
            self.assertEqual((ros["status"]["status"] >= 0, ros["status"]["service"] & 1), (data["valid"], 1))
            self.assertLessEqual(ros["position_covariance_type"], 3)

    def test_joints_are_those_of_the_description(self):
        both, peer = self.follow("motorcontrol", "wheels", "/joint_states", "sensor_msgs/JointState", 20)
        peer.read("/robot_description", "std_msgs/String", transient_local=True, depth=1)
        robot = xml.etree.ElementTree.fromstring(peer.wait("/robot_description")["data"])
        self.assertEqual(robot.tag, "robot")
        joints = {joint.get("name"): joint for joint in robot.findall("joint")}
        links = {link.get("name") for link in robot.findall("link")}
        self.assertIn("base_link", links)
        for joint in joints.values():
            self.assertLessEqual({joint.find("parent").get("link"), joint.find("child").get("link")}, links)
        for ros, data in both:
            self.assertEqual({len(ros["position"]), len(ros["velocity"])}, {len(ros["name"])})
            self.assertEqual(len(ros["name"]), sum(wheel in data for wheel in WHEELS))
            for name, position, velocity in zip(ros["name"], ros["position"], ros["velocity"]):
                self.assertEqual(joints[name].get("type"), "continuous")
                (wheel,) = [wheel for wheel in WHEELS if wheel in name]
                self.assert_near(position, data[wheel]["angle"], name)
                self.assert_near(velocity, data[wheel]["speed"], name)


class TwoScanners(Ros2Case):
    """Of a robot that has one with a field of view besides; it stands, as is told by two sources."""

    SCANNER = "hokuyo-urg04lx"

    def test_second_scan(self):
        both, peer = self.follow("scanner", "scan2d", "/scanner/scan", "sensor_msgs/LaserScan", 5)
        frame = compare_scans(self, both)
        self.assertLess(apart(place(static_frames(peer)[frame]), SECOND_MOUNT), SMALL)
        for ros, _ in both:
            behind = [found for i, found in enumerate(ros["ranges"]) if abs(ros["angle_min"] + i * ros["angle_increment"]) > 2.2]
            self.assertFalse([found for found in behind if not math.isnan(found)], "it cannot look back")
        peer.read("/scan", "sensor_msgs/LaserScan")
        self.assertNotEqual(peer.wait("/scan")["header"]["frame_id"], frame)


if __name__ == "__main__":
    skip_without_programs()
    unittest.main(verbosity=2)
