#!/usr/bin/env python3
"""hermes-ros2 among nodes of ROS 2: its types and their hashes, qualities of service, its name in the graph in the form that the others have,
health and log, and a name space."""
import random
import signal
import socket
import struct
import time
import unittest

from ros2_robot import Heard, Ros2Case, skip_without_programs
from ros2_support import free_domain, ros_cdr, stamp_of, wire_name
from support import BINARIES, PATIENCE, Process, free_port, release, wait_for

GRAPH, GRAPH_TYPE = "ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"
LEVELS = {"ok": 0, "warn": 1, "error": 2, "stale": 3}
LOG_LEVELS = {"debug": 10, "info": 20, "warning": 30, "error": 40}
# Of each topic: its type, and whether late readers get what was last.
OFFERED = {
    "/scan": ("sensor_msgs/LaserScan", False), "/points": ("sensor_msgs/PointCloud2", False), "/odom": ("nav_msgs/Odometry", False),
    "/tf": ("tf2_msgs/TFMessage", False), "/tf_static": ("tf2_msgs/TFMessage", True), "/map": ("nav_msgs/OccupancyGrid", True),
    "/map_walls": ("visualization_msgs/MarkerArray", True), "/pose": ("geometry_msgs/PoseWithCovarianceStamped", None),
    "/battery": ("sensor_msgs/BatteryState", False), "/fix": ("sensor_msgs/NavSatFix", False),
    "/joint_states": ("sensor_msgs/JointState", False), "/diagnostics": ("diagnostic_msgs/DiagnosticArray", False),
    "/rosout": ("rcl_interfaces/Log", True), "/robot_description": ("std_msgs/String", True)}


class Graph(Ros2Case):
    def test_types_and_qualities(self):
        peer = self.peer()
        for topic, (kind, is_kept) in OFFERED.items():
            (writer,) = wait_for(f"a writer of {topic}", lambda topic=topic: peer.writers_of(topic))
            found = writer["type"], writer["user_data"], writer["reliable"], writer["has_type_information"]
            self.assertEqual(found, (ros_cdr.dds_name(kind), f"typehash={ros_cdr.type_hash(kind)};", True, False), topic)
            if is_kept is not None:
                self.assertEqual(writer["transient_local"], is_kept, topic)
            self.assertEqual(abs(writer["lifespan_s"] - 10) < 0.1, topic == "/rosout", topic)
        participants = peer.listed()["participants"].values()
        self.assertTrue(participants)
        for participant in participants:
            self.assertIn("enclave=/;", participant["user_data"])

    def test_readers_of_each_kind_are_served(self):
        """RViz asks for reliability, Nav2 for the newest only."""
        rviz, nav2 = self.peer(), self.peer()
        for peer, is_reliable in ((rviz, True), (nav2, False)):
            for topic, kind in (("/scan", "sensor_msgs/LaserScan"), ("/odom", "nav_msgs/Odometry"), ("/tf", "tf2_msgs/TFMessage")):
                peer.read(topic, kind, reliable=is_reliable)
            peer.read("/points", "sensor_msgs/PointCloud2", reliable=is_reliable, depth=1)  # larger than a datagram
        for peer in (rviz, nav2):
            for topic in ("/scan", "/odom", "/tf", "/points"):
                peer.wait_for_count(topic, 10)
            self.assertEqual((peer.errors, peer.incompatible), ([], []))

    def own_samples(self, peer, of):
        """Those of the graph that the daemon wrote."""
        return [sample.message for sample in peer.samples_of(GRAPH) if sample.guid[:24] in of]

    def graph_of(self, peer):
        """What the daemon tells of itself once the peer has told of itself: (message, form)."""
        daemon = {guid[:24] for guid, writer in peer.listed()["writers"].items() if writer["topic"] == "rt/odom"}
        peer.until("its name", lambda: self.own_samples(peer, daemon))
        return ros_cdr.decode_graph(self.own_samples(peer, daemon)[-1])

    def test_graph_in_the_form_of_others(self):
        for package, size, release in (("humble", 24, "humble"), ("rmw_dds_common", 16, "jazzy")):
            domain = free_domain()
            process, _ = self.ros2(domain)
            peer = self.peer(domain)
            peer.open("read", GRAPH, GRAPH_TYPE, transient_local=True, depth=1)
            wait_for("the daemon", lambda: peer.writers_of("/odom"))
            peer.read("/odom", "nav_msgs/Odometry")
            peer.wait_for_count("/odom", 20)
            self.assertEqual(peer.samples_of(GRAPH), [])  # nobody has told yet which form they read
            gid = bytes.fromhex(peer.guid) + bytes(size - 16)
            peer.open("write", GRAPH, GRAPH_TYPE, transient_local=True, depth=1)
            peer.wait_for_match(GRAPH, "writer", 2)  # the peer's own reader, too
            for noise in (b"", ros_cdr.LITTLE, gid, ros_cdr.LITTLE + gid + b"\xff" * 4, ros_cdr.LITTLE + bytes(5000), b"\0\1\0\0" + b"\xff" * 99):
                peer.send(GRAPH, noise, count=3, hz=100)
            peer.send(GRAPH, ros_cdr.encode(package + "/ParticipantEntitiesInfo", {"gid": {"data": gid}, "node_entities_info_seq": [
                {"node_namespace": "/", "node_name": "rviz"}]}))
            self.compare_graph(peer, size, release)
            process.stop()

    def compare_graph(self, peer, size, release):
        message, form = self.graph_of(peer)
        self.assertEqual(form, release)
        (node,) = message["node_entities_info_seq"]
        self.assertEqual(node["node_namespace"], "/")
        self.assertRegex(node["node_name"], "^hermes")
        self.assertIn(message["gid"]["data"][:16].hex(), peer.listed()["participants"])

        def differences():
            """What is told of readers and writers, and is not there, or the other way round; both grow at the beginning."""
            message, _ = self.graph_of(peer)
            (node,), listed, prefix = message["node_entities_info_seq"], peer.listed(), bytes(message["gid"]["data"])[:12].hex()
            gids = [bytes(gid["data"]) for side in ("writer", "reader") for gid in node[side + "_gid_seq"]]
            told = {gid[:16].hex() for gid in gids if not any(gid[16:size])}
            there = {guid: one["topic"] for side in ("writers", "readers") for guid, one in listed[side].items()
                     if guid.startswith(prefix) and one["topic"][:3] in ("rt/", "rq/", "rr/")}
            return told ^ there.keys()
        wait_for("its readers and writers in the graph", lambda: not differences())

    def test_graph_as_it_is_set(self):
        for graph, size in (("humble", 24), ("jazzy", 16), ("none", 0)):
            domain = free_domain()
            process, _ = self.ros2(domain, graph=graph)
            peer = self.peer(domain)
            peer.open("read", GRAPH, GRAPH_TYPE, transient_local=True, depth=1)
            wait_for("the daemon", lambda: peer.writers_of("/odom"))
            if size:
                self.compare_graph(peer, size, graph)
            else:
                peer.read("/odom", "nav_msgs/Odometry")
                peer.wait_for_count("/odom", 20)
                self.assertEqual(peer.samples_of(GRAPH), [])
            process.stop()

    def test_diagnostics(self):
        peer = self.peer()
        peer.read("/diagnostics", "diagnostic_msgs/DiagnosticArray", depth=100)
        told = lambda: {(status["name"], status["level"]) for message in peer.messages("/diagnostics") for status in message["status"]}  # noqa: E731

        def missing():
            """Health items that were not told as they are now."""
            return [(name, item) for name, daemon in self.robot.daemons.items() for item in daemon.call("daemon.status")["health"]
                    if not any(name in key and item["name"] in key and level == LEVELS[item["level"]] for key, level in told())]
        try:
            wait_for("all health items", lambda: not missing(), 20)
        except AssertionError as error:
            raise AssertionError(f"{error}: without {missing()}, found {sorted(told())}") from None

    def test_log(self):
        peer = self.peer()
        peer.read("/rosout", "rcl_interfaces/Log", transient_local=True, depth=1000)
        peer.wait_for_match("/rosout", "reader")
        motors = self.robot.motors
        motors.call("motor.estop")
        records = lambda: [one for one in motors.call("log.tail", count=20) if one["level"] in ("warning", "error")]  # noqa: E731
        record = wait_for("a warning", records)[-1]
        found = peer.wait("/rosout", lambda message: record["text"] in message["msg"])
        self.assertEqual(found["level"], LOG_LEVELS[record["level"]])
        self.assertLess(abs(found["stamp"]["sec"] + found["stamp"]["nanosec"] * 1e-9 - record["stamp"]), 2e-6)
        self.assertIn("motorcontrol", found["name"])
        late = self.peer()
        late.read("/rosout", "rcl_interfaces/Log", transient_local=True, depth=1000)
        late.wait("/rosout", lambda message: record["text"] in message["msg"])
        release(motors)

    def test_name_space(self):
        domain = free_domain()
        process, _ = self.ros2(domain, namespace="robot1", frame_prefix="robot1/")
        peer = self.peer(domain)
        peer.read("/robot1/scan", "sensor_msgs/LaserScan")
        frames = {peer.wait("/robot1/scan")["header"]["frame_id"]}
        (topic,) = [writer["topic"][2:] for writer in peer.listed()["writers"].values() if writer["topic"] in ("rt/tf", "rt/robot1/tf")]
        peer.read(topic, "tf2_msgs/TFMessage", depth=100)
        peer.wait_for_count(topic, 30)
        for one in [one for message in peer.messages(topic) for one in message["transforms"]]:
            frames |= {one["header"]["frame_id"], one["child_frame_id"]}
        self.assertEqual([frame for frame in frames if not frame.startswith("robot1/")], [])
        topics = {writer["topic"] for writer in peer.listed()["writers"].values() if writer["topic"].startswith("rt/")}
        common = {wire_name(topic) for topic in ("/tf", "/tf_static", "/diagnostics", "/rosout")}  # ROS has them once, whoever writes
        self.assertEqual([topic for topic in topics - common if not topic.startswith("rt/robot1/")], [])
        process.stop()

    def test_reader_that_hangs_holds_up_nobody(self):
        """It asks for reliability, and falls silent."""
        hung, other = self.peer(), self.peer()
        for peer in (hung, other):
            peer.read("/scan", "sensor_msgs/LaserScan")
            peer.wait_for_count("/scan", 3)
        hung.process.send_signal(signal.SIGSTOP)
        try:
            count = len(other.samples_of("/scan"))
            other.wait_for_count("/scan", count + 40)  # four seconds
        finally:
            hung.process.send_signal(signal.SIGCONT)
        stamps = [stamp_of(message) for message in other.messages("/scan")[count:]]
        self.assertLess(max(b - a for a, b in zip(stamps, stamps[1:])), 0.15, "scans are missing")
        hung.wait("/scan", lambda message: stamp_of(message) > stamps[-1])

    def test_daemon_that_dies_comes_back(self):
        peer = self.peer()
        peer.read("/scan", "sensor_msgs/LaserScan")
        peer.wait_for_count("/scan", 3)
        self.robot.processes["velodynelogger"].process.kill()
        self.robot.processes["velodynelogger"].process.wait()
        count = len(peer.samples_of("/scan"))
        self.robot.start("velodynelogger")
        peer.wait_for_count("/scan", count + 10)

    def test_replay_is_not_told(self):
        """It says nothing of the robot of now."""
        lidar = self.robot.daemons["velodynelogger"]
        lidar.call("record.start", name="drive")
        wait_for("packets", lambda: lidar.call("record.status")["counts"]["packets"] > 2000)
        lidar.call("record.stop")
        peer, heard = self.peer(), Heard(self.robot.ports["velodynelogger"], "scan2d")
        self.addCleanup(heard.close)
        peer.read("/scan", "sensor_msgs/LaserScan")
        peer.wait_for_count("/scan", 3)
        lidar.call("source.open", recording="drive", loop=True)
        wait_for("the replay", lambda: [one for one in heard.messages if one["data"]["replayed"]])
        count = len(peer.samples_of("/scan"))
        wait_for("20 scans of it", lambda: len([one for one in heard.messages if one["data"]["replayed"]]) > 20)
        self.assertLessEqual(len(peer.samples_of("/scan")), count + 2)  # those that were on their way
        lidar.call("source.open", live=True)
        peer.wait_for_count("/scan", count + 10)

    def test_noise_on_its_ports(self):
        """Datagrams that mean nothing end nothing, and fill no log."""
        noise, sender = random.Random(1), socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        with sender, open(self.process.log_name, encoding="utf-8") as log:
            before = len(log.readlines())
            for _ in range(10000):
                body = noise.randbytes(noise.randrange(1, 120))
                head = b"RTPS\2\1\1\x0f" + noise.randbytes(12) + struct.pack("<BBH", noise.choice((7, 9, 21, 22)), 5, len(body))
                sender.sendto(head + body, ("127.0.0.1", 7400 + 250 * self.domain + 10 + noise.randrange(4)))
            peer = self.peer()
            peer.read("/odom", "nav_msgs/Odometry")
            peer.wait_for_count("/odom", 20)
            self.assertLess(len(log.readlines()), 100, before)
        with open(f"/proc/{self.process.process.pid}/status", encoding="ascii") as status:
            (resident,) = [int(line.split()[1]) for line in status if line.startswith("VmRSS")]
        self.assertLess(resident, 150000)  # kB

    def test_network_that_is_not_there(self):
        """The end tells which."""
        process = Process(BINARIES, "ros2", free_port(0), self.robot.folder, {"networks": '["nope0"]', "domain": free_domain()})
        self.addCleanup(process.stop)
        self.assertEqual(wait_for("the end", lambda: process.process.poll() is not None and process.process.returncode), 1)
        self.assertRegex(process.last_words().splitlines()[-1], "^hermes-ros2: .*nope0")

    def test_end(self):
        domain = free_domain()
        process, _ = self.ros2(domain)
        peer = self.peer(domain)
        wait_for("the daemon", lambda: peer.writers_of("/odom"))
        peer.read("/odom", "nav_msgs/Odometry")
        peer.wait_for_count("/odom", 3)
        began = time.monotonic()
        self.assertEqual(process.stop(), 0)
        self.assertLess(time.monotonic() - began, 2 * PATIENCE)



if __name__ == "__main__":
    skip_without_programs()
    unittest.main(verbosity=2)
