"""What tests of hermes-ros2 share: a simulated robot with all sensors, the daemon beside it, and nodes of another vendor."""
import json
import math
import os
import shutil
import socket
import sys
import tempfile
import threading
import unittest

from ros2_support import PEER, Peer, free_domain, stamp_of, wire_name
from support import BINARIES, WORLD, Daemon, Process, fastest_wheel, free_port, put, wait_for

PROGRAM = os.path.join(BINARIES, "hermes-ros2")
MOUNT = (0.12, -0.05, 0.05)  # of the lidar, as the scan matcher is told; the simulator's is in the middle
SECOND_MOUNT = (0.2, 0.1, 0.5)  # of a scanner, if there is one
SKIPPED = 77
SMALL = 1e-6


def skip_without_programs():
    """Ends the test where an optional library was missing when it was built."""
    for path in (PEER, PROGRAM):
        if not os.path.exists(path):
            print(f"{path} was not built: its library (libfastrtps-dev, cyclonedds-dev) is missing")
            sys.exit(SKIPPED)


def compose(pose, inner):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return pose[0] + c * inner[0] - s * inner[1], pose[1] + s * inner[0] + c * inner[1], pose[2] + inner[2]


def inverse(pose):
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return -c * pose[0] - s * pose[1], s * pose[0] - c * pose[1], -pose[2]


def apart(a, b):
    """The largest difference of two poses (x, y, heading)."""
    return max(abs(a[0] - b[0]), abs(a[1] - b[1]), abs(math.remainder(a[2] - b[2], 2 * math.pi)))


def plane(position, orientation):
    """(x, y, heading) of a pose or transform of ROS, which has to be level."""
    norm = math.sqrt(sum(orientation[part] ** 2 for part in "xyzw"))
    assert abs(norm - 1) < SMALL and abs(orientation["x"]) + abs(orientation["y"]) < SMALL, orientation
    return position["x"], position["y"], 2 * math.atan2(orientation["z"], orientation["w"])


def pose_of(data):
    return data["x"], data["y"], data["theta"]


def static_frames(peer):
    """Of each frame that is fixed: its transform."""
    peer.read("/tf_static", "tf2_msgs/TFMessage", transient_local=True, depth=1)
    return {one["child_frame_id"]: one for one in peer.wait("/tf_static", lambda message: message["transforms"])["transforms"]}


def place(transform):
    return plane(transform["transform"]["translation"], transform["transform"]["rotation"])


def compare_scans(test, both):
    """Scans of (ROS, Hermes) have the same directions each time; each has the range of a point, is empty (+inf) where nothing came back, or
    NaN where nothing is known. Gives their frame."""
    first = both[0][0]
    kinds = {(len(ros["ranges"]), ros["angle_min"], ros["angle_max"], ros["angle_increment"], ros["header"]["frame_id"]) for ros, _ in both}
    test.assertEqual(len(kinds), 1, f"the directions change: {kinds}")
    test.assertGreater(first["angle_increment"], 0)
    span = (len(first["ranges"]) - 1) * first["angle_increment"]
    test.assert_near(first["angle_max"], first["angle_min"] + span, "angle_max", 1e-5)
    test.assertLess(span, 2 * math.pi)  # no direction is there twice
    for ros, data in both[:5]:
        test.assertEqual(ros["time_increment"], 0)
        test.assertIn(len(ros["intensities"]), (0, len(ros["ranges"])))
        compare_scan(test, ros, data)
    return first["header"]["frame_id"]


def compare_scan(test, ros, data):
    bins, step = len(ros["ranges"]), ros["angle_increment"]
    turn, points = round(2 * math.pi / step), {}
    for x, y, intensity in zip(data["x"], data["y"], data["intensity"]):
        points.setdefault(round((math.atan2(y, x) - ros["angle_min"]) / step) % turn, []).append((math.hypot(x, y), intensity))
    near = lambda i: [point for k in (i - 1, i, i + 1) for point in points.get(k % turn, [])]  # noqa: E731
    for i, found in enumerate(ros["ranges"]):
        if math.isfinite(found):
            test.assertTrue(ros["range_min"] <= found <= ros["range_max"], found)
            fitting = [point for point in near(i) if abs(point[0] - found) < SMALL]
            test.assertTrue(fitting, f"direction {i} has {found}, near it are {near(i)}")
            if ros["intensities"]:
                test.assertIn(ros["intensities"][i], [intensity for _, intensity in fitting])
        else:
            test.assertNotEqual(found, -math.inf)
    is_known = lambda i: i < bins and math.isfinite(ros["ranges"][i])  # noqa: E731
    test.assertEqual([i for i in points if not any(is_known(k % turn) for k in (i - 1, i, i + 1))], [], "points that are in no direction")
    test.assertLess(sum(not is_known(i) for i in points), 0.02 * bins, "directions with a point have no range")


class Robot:
    """The daemons of a robot."""

    def __init__(self, folder, world=WORLD, scanner=None):
        self.folder = folder
        lidar, position = free_port(0, socket.SOCK_DGRAM), free_port(0, socket.SOCK_DGRAM)
        line, gps = os.path.join(folder, "motors"), os.path.join(folder, "gps")
        self.ports = {name: free_port(0) for name in ("simulator", "motorcontrol", "velodynelogger", "seriallogger", "scanmatcher")}
        serial = f"serial://{line}?baud=115200"
        self.settings = {
            "simulator": {"world": world, "lidar.port": lidar, "lidar.position_port": position, "motors.link": line, "gps.link": gps},
            "velodynelogger": {"source.port": lidar, "source.address": "127.0.0.1", "source.position_port": position,
                               "record.folder": os.path.join(folder, "records"), "record.free_floor_bytes": 0},
            "seriallogger": {"ports": json.dumps([{"name": "gps", "url": f"serial://{gps}?baud=9600", "view": "nmea"}])},
            "motorcontrol": {"controllers.1.url": serial, "controllers.2.url": serial},
            "scanmatcher": {"source.address": f"127.0.0.1:{self.ports['velodynelogger']}", "map.folder": folder,
                            "odometry.address": f"127.0.0.1:{self.ports['motorcontrol']}", "sensor.x_m": MOUNT[0],
                            "sensor.y_m": MOUNT[1], "sensor.theta_rad": MOUNT[2]}}
        if scanner:
            self.add_scanner(scanner)
        self.processes, self.daemons = {}, {}
        for name in self.settings:
            self.start(name)
        self.motors, self.simulator, self.matcher = (self.daemons[name] for name in ("motorcontrol", "simulator", "scanmatcher"))
        wait_for("poses", lambda: self.matcher.call("matcher.state")["matched"] > 3)
        wait_for("the wheels", lambda: self.motors.call("motor.state")["ready"])

    def add_scanner(self, model):
        """A second one, of one plane."""
        x, y, theta = SECOND_MOUNT
        link, self.ports["scanner"] = os.path.join(self.folder, "scanner"), free_port(0)
        self.settings["simulator"].update({"scanner.model": model, "scanner.link": link, "scanner.x_m": x, "scanner.y_m": y,
                                           "scanner.theta_rad": theta})
        self.settings["scanner"] = {"scanner.model": model, "scanner.url": f"serial://{link}"}
        self.settings["scanmatcher"].update({"source2.address": f"127.0.0.1:{self.ports['scanner']}", "sensor2.x_m": x, "sensor2.y_m": y,
                                             "sensor2.theta_rad": theta})

    def start(self, name):
        """Also again, after it was killed."""
        self.processes[name] = Process(BINARIES, name, self.ports[name], self.folder, self.settings[name])
        if name in self.daemons:
            self.daemons[name].close()
        self.daemons[name] = self.processes[name].connect()

    def addresses(self):
        """As the setting `daemons` of the daemon takes them."""
        return json.dumps([f"127.0.0.1:{port}" for port in self.ports.values()])

    def stands(self):
        return fastest_wheel(self.simulator) < 0.02

    def stop(self):
        for daemon in self.daemons.values():
            daemon.close()
        for process in reversed(list(self.processes.values())):
            process.stop()


class Heard(threading.Thread):
    """Messages of a topic of Hermes, from now on."""

    def __init__(self, port, topic):
        super().__init__(daemon=True)
        self.messages, self.connection = [], Daemon(port=port)
        self.stream = self.connection.subscribe(topic, queue=1000)
        self.start()

    def run(self):
        try:
            for message in self.stream:
                self.messages.append(message)
        except (OSError, ValueError):
            pass  # closed

    def close(self):
        try:
            self.connection.socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass  # the daemon has ended
        self.join()
        self.connection.close()

    @staticmethod
    def stamp(message):
        return message["data"].get("stamp", message["stamp"])

    def pairs(self, found):
        """(ROS, data of Hermes) of the same time, in the order of the first."""
        by_time = {round(self.stamp(message) * 1e5): message for message in self.messages[:]}
        both = []
        for one in found:
            at = stamp_of(one)
            for key in range(round(at * 1e5) - 1, round(at * 1e5) + 2):
                if key in by_time and abs(self.stamp(by_time[key]) - at) < 2e-6:
                    both.append((one, by_time[key]["data"]))
                    break
        return both


class Ros2Case(unittest.TestCase):
    """Tests beside one robot; the daemon's settings are the class's SETTINGS, and the robot's world is its WORLD."""

    SETTINGS = {}
    WORLD = WORLD
    SCANNER = None

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        world = cls.WORLD if isinstance(cls.WORLD, str) else put(os.path.join(folder, "world.json"), cls.WORLD)
        cls.robot = Robot(folder, world, cls.SCANNER)
        cls.addClassCleanup(cls.robot.stop)
        cls.domain = free_domain()
        cls.process, cls.daemon = cls.ros2(cls.domain, **cls.SETTINGS)

    @classmethod
    def ros2(cls, domain, **settings):
        """hermes-ros2 in a domain, and a connection to it."""
        process = Process(BINARIES, "ros2", free_port(0), cls.robot.folder, {
            "daemons": cls.robot.addresses(), "domain": domain, **{name: json.dumps(value) if isinstance(value, (bool, list)) else value
                                                                   for name, value in settings.items()}})
        cls.addClassCleanup(process.stop)
        daemon = process.connect()
        cls.addClassCleanup(daemon.close)
        return process, daemon

    def peer(self, domain=None, *arguments, within=()):
        """A node of ROS 2; ended after the test."""
        peer = Peer(self.domain if domain is None else domain, *arguments, within=within)
        self.addCleanup(peer.close)
        return peer

    def assert_near(self, found, expected, what="", limit=SMALL):
        self.assertLessEqual(abs(found - expected), limit, f"{what}: found {found}, expected {expected}")

    def follow(self, daemon, hermes_topic, topic, kind, count=10, split=list, **qos):
        """Messages of a topic of ROS beside those of Hermes: (ROS, data of Hermes) with the same stamp, so many, and the peer that reads
        them. `split` gives the stamped parts of a list of messages. What Hermes sent meanwhile is there, but for what a busy machine may
        skip."""
        heard, peer = Heard(self.robot.ports[daemon], hermes_topic), self.peer()
        self.addCleanup(heard.close)
        peer.read(topic, kind, **qos)
        both = lambda: heard.pairs(split([one.message for one in peer.samples[wire_name(topic)]]))  # noqa: E731
        peer.until(f"{count} messages of {topic} with the stamps of {daemon}/{hermes_topic}", lambda: len(both()) >= count, 30)
        with peer.changed:
            found = both()
        began, ended = (stamp_of(found[i][0]) for i in (0, -1))
        meant = [message for message in heard.messages[:] if began - 2e-6 <= heard.stamp(message) <= ended + 2e-6]
        self.assertGreaterEqual(len(found), 0.9 * len(meant), f"{topic}: {len(found)} of {len(meant)} messages")
        self.assertEqual(peer.errors, [])
        return found, peer
