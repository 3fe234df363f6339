#!/usr/bin/env python3
"""Services of hermes-ros2, called in the form of rmw_cyclonedds, with a header before each request and reply; what has another form, as the
requests of rmw_fastrtps, is none."""
import os
import struct
import unittest

from recorded_robot import Driver
from ros2_commands import HALL, CommandCase
from ros2_robot import skip_without_programs
from ros2_support import ros_cdr
from support import wait_for

CLIENT = "clientid=1.2.3.4.5.6.7.8.9.a.b.c.d.e.f.10;"
# Behind the header; a request without fields has one octet.
ros_cdr.MESSAGES.update(ros_cdr.parsed("""
service/Request: uint64 guid, int64 sequence, uint8 structure_needs_at_least_one_member
service/Triggered: uint64 guid, int64 sequence, bool success, string message
service/Map: uint64 guid, int64 sequence, nav_msgs/OccupancyGrid map
"""))


class Client:
    """Of one service: its requests and what was answered."""

    def __init__(self, peer, service, kind="std_srvs::srv::dds_::Trigger", reply="service/Triggered", user_data=CLIENT):
        self.peer, self.request, self.response, self.reply, self.count = peer, f"rq/{service}Request", f"rr/{service}Reply", reply, 0
        peer.open("read", self.response, kind + "_Response_", depth=10, user_data=user_data)
        peer.open("write", self.request, kind + "_Request_", depth=10, user_data=user_data)
        peer.wait_for_match(self.request, "writer")
        peer.wait_for_match(self.response, "reader")

    def call(self):
        """The reply; asked again where the daemon did not know of this client as yet."""
        def is_answered():
            self.count += 1
            self.peer.send(self.request, ros_cdr.encode("service/Request", {"guid": 77, "sequence": self.count}))
            try:
                self.peer.until("a reply", lambda: len(self.peer.samples[self.response]) > before, 1)
            except AssertionError:
                return False
            return True
        before = len(self.replies())
        wait_for("a reply", is_answered)
        return self.replies()[-1]

    def replies(self):
        return [ros_cdr.decode(self.reply, data) for data in self.peer.messages(self.response)]


class Services(CommandCase):
    WORLD, SETTINGS = HALL, {"commands": True}

    def service(self, *arguments, **options):
        return Client(self.peer(), *arguments, **options)

    def test_stop(self):
        client = self.service("stop")
        anna = Driver(self.robot.ports["motorcontrol"], "anna", vx=0.15)
        self.wait_for_drive(0.15)
        reply = client.call()
        self.assertEqual((reply["guid"], reply["success"]), (77, True), reply)
        self.assertIn(reply["sequence"], range(1, client.count + 1))
        wait_for("standstill", self.robot.stands, 5)
        self.assert_stands()
        anna.end()

    def test_reset_odometry(self):
        client = self.service("reset_odometry")
        self.robot.motors.call("odometry.reset", x=3)
        self.assertTrue(client.call()["success"])
        pose = self.robot.motors.call("motor.state")["pose"]
        self.assertLess(max(map(abs, pose.values())), 0.01, pose)

    def test_maps(self):
        grid = self.service("get_map", "nav_msgs::srv::dds_::GetMap", "service/Map").call()["map"]
        self.assertEqual(len(grid["data"]), grid["info"]["width"] * grid["info"]["height"])
        self.assertEqual((grid["header"]["frame_id"], set(grid["data"])), ("map", {-1, 0, 100}))
        client = self.service("save_map")
        before = set(os.listdir(self.robot.folder))
        reply = client.call()
        self.assertTrue(reply["success"], reply)
        (made,) = [name for name in set(os.listdir(self.robot.folder)) - before if name.endswith(".csv")]
        self.assertTrue(os.path.getsize(os.path.join(self.robot.folder, made)) > 100)
        self.assertTrue(client.call()["success"])  # again

    def test_what_is_no_request(self):
        """Of rmw_fastrtps, which has no header; of clients that do not tell that they are such; and noise."""
        anna = Driver(self.robot.ports["motorcontrol"], "anna", vx=0.15)
        right = ros_cdr.encode("service/Request", {"guid": 77, "sequence": 1})
        plain = ros_cdr.LITTLE + b"\0"
        noise = plain, right[:12], b"", ros_cdr.LITTLE, b"\0\7" + right[2:]
        for user_data, requests in (("", (plain, right)), ("clientid=;", (plain, b"")), (CLIENT, noise)):
            client = self.service("stop", user_data=user_data)
            for request in requests:
                client.peer.send(client.request, request, count=20, hz=50)
                client.peer.send(client.request, request)
                self.assertGreater(self.moved(50)[0], 0.1, (user_data, request))
            self.assertEqual(client.replies(), [])
            client.peer.close()
        anna.end()

    def test_flood(self):
        """Requests that nobody waits for hold nothing up."""
        client = self.service("get_map", "nav_msgs::srv::dds_::GetMap", "service/Map")
        client.call()
        request = ros_cdr.encode("service/Request", {"guid": 77, "sequence": 1})
        client.peer.send(client.request, request, count=0, hz=2000)
        other = self.peer()
        other.read("/odom", "nav_msgs/Odometry")
        other.wait_for_count("/odom", 100, 10)
        self.assertEqual(struct.unpack_from("<Q", client.peer.messages(client.response)[-1], 4)[0], 77)
        client.peer.close()


class Refused(CommandCase):
    """As the daemon is without settings: who may only look changes nothing."""

    WORLD = HALL

    def test_services(self):
        peer, before = self.peer(), set(os.listdir(self.robot.folder))
        self.robot.motors.call("odometry.reset", x=3)
        there = wait_for("services", lambda: [one["topic"] for one in peer.listed()["readers"].values() if one["topic"].startswith("rq/")])
        print("services without commands:", sorted(there))
        for service in ("reset_odometry", "save_map"):
            if f"rq/{service}Request" in there:
                self.assertFalse(Client(self.peer(), service).call()["success"])
        self.assertGreater(self.robot.motors.call("motor.state")["pose"]["x"], 2.9)
        self.assertEqual(set(os.listdir(self.robot.folder)) - before - {"ros2.log"}, set())
        self.assertTrue(Client(self.peer(), "stop").call()["success"])


if __name__ == "__main__":
    skip_without_programs()
    unittest.main(verbosity=2)
