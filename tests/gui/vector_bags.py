#!/usr/bin/env python3
"""hermes-vector reads bags: whoever wrote them, a drive becomes the same map as its CARMEN log, and what cannot be read is told."""
import json
import math
import os
import random
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import ros_bags as bags  # noqa: E402

PROGRAM = os.path.join(os.environ["HERMES_BIN"], "hermes-vector")
RAYS, STEP, FIRST = 181, math.pi / 180, -math.pi / 2
MOUNT = (0.2, 0.1, 0.3)
WALLS = [((-3, -2), (7, -2)), ((7, -2), (7, 4)), ((7, 4), (-3, 4)), ((-3, 4), (-3, -2)), ((2, 1), (3, 1)), ((3, 1), (3, 2.5)), ((0, 4), (0, 3))]
LZ4 = shutil.which("lz4")
ZSTD = shutil.which("zstd")


def compose(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2])


def distance(pose, angle):
    """Along a ray to the nearest wall."""
    x, y, direction = pose[0], pose[1], pose[2] + angle
    dx, dy = math.cos(direction), math.sin(direction)
    nearest = math.inf
    for (ax, ay), (bx, by) in WALLS:
        ex, ey = bx - ax, by - ay
        det = dx * ey - dy * ex
        if abs(det) < 1e-12:
            continue
        t = ((ax - x) * ey - (ay - y) * ex) / det
        u = ((ax - x) * dy - (ay - y) * dx) / det
        if t > 0 and 0 <= u <= 1:
            nearest = min(nearest, t)
    return nearest


class Drive:
    """Of each scan its stamp, the robot's odometry and the ranges."""

    def __init__(self):
        noise = random.Random(4)
        self.scans = []
        robot = (0, 0, 0)
        for i in range(60):
            ranges = [round(distance(compose(robot, MOUNT), FIRST + k * STEP) + noise.gauss(0, 0.005), 4) for k in range(RAYS)]
            self.scans.append((1700000000 + 0.2 * i, robot, ranges))
            robot = compose(robot, (0.06, 0, 0.02 * math.sin(i / 6)))

    def carmen(self):
        def pose(p):
            return f"{p[0]:.9f} {p[1]:.9f} {math.atan2(math.sin(p[2]), math.cos(p[2])):.9f}"
        return "".join(f"FLASER {RAYS} {' '.join(map(str, ranges))} {pose(compose(robot, MOUNT))} {pose(robot)} {t:.6f} robot {t:.6f}\n"
                       for t, robot, ranges in self.scans)


DRIVE = Drive()
LASER, ODOMETRY, FRAMES = "sensor_msgs/LaserScan", "nav_msgs/Odometry", "tf2_msgs/TFMessage"
LEVEL = MOUNT[2]
# Turned about x by half a turn after the turn about z: hangs upside down.
HANGING = (math.cos(MOUNT[2] / 2), math.sin(MOUNT[2] / 2), 0, 0)


def messages(form="ros1", slash="", scan=None, odometry="topic", turn=LEVEL, mount=True, big=False, child="base_link"):
    """The drive as messages of a bag. scan: makes the message of a scanner of bytes, stamp and ranges."""
    def out():
        return bags.Bytes(form, big)
    scan = scan or (LASER, lambda o, t, ranges: bags.laser_scan(o, t, ranges, slash + "laser", FIRST, STEP))
    found = []
    if mount:
        at = (DRIVE.scans[0][0], slash + "base_link", slash + "laser", (*MOUNT[:2], 0.3), turn)
        found.append(("/tf_static", FRAMES, at[0], bags.transforms(out(), at)))
    for t, robot, ranges in DRIVE.scans:
        if odometry == "topic":
            found.append(("/odom", ODOMETRY, t + 0.001, bags.odometry(out(), t, robot, child=slash + child if child else "")))
        elif odometry == "tf":
            foot = (t, slash + "odom", slash + "base_footprint", (*robot[:2], 0), robot[2])
            found.append(("/tf", FRAMES, t + 0.001, bags.transforms(out(), (t, "elsewhere", "thing", (1, 2, 3), t), foot)))
        found.append(("/scan", scan[0], t + 0.03, scan[1](out(), t, ranges)))
    if odometry == "tf":
        foot = (0, slash + "base_footprint", slash + "base_link", (0, 0, 0.1), 0)
        found.insert(0, ("/tf_static", FRAMES, DRIVE.scans[0][0], bags.transforms(out(), foot)))
    return found


class VectorBags(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        with open(cls.path("log"), "w", encoding="ascii") as log:
            log.write(DRIVE.carmen())
        cls.expected, cls.walls = cls.trajectory(cls, "log", "--seconds-per-turn", "0", "--field-of-view", "180")
        assert len(cls.expected) == len(DRIVE.scans)

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    def run_program(self, *arguments):
        ran = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=60, check=False)
        if "this program was built without" in ran.stderr:
            raise unittest.SkipTest(ran.stderr)
        return ran

    def trajectory(self, name, *options):
        out = self.path("t.tum"), self.path("map.csv")
        ran = VectorBags.run_program(self, "map", self.path(name), "--out-trajectory", out[0], "--out-map", out[1], "--force", *options)
        assert ran.returncode == 0, ran.stderr
        VectorBags.told, VectorBags.summary = ran.stderr, json.loads(ran.stdout)
        with open(out[0], encoding="ascii") as poses, open(out[1], encoding="ascii") as walls:
            return [tuple(map(float, line.split())) for line in poses if line[0] != "#"], len(walls.readlines())

    def expect_the_drive(self, name, *options, tolerance=0.002):
        """The poses of the log, and as many walls."""
        poses, found = self.trajectory(name, *options)
        self.assertEqual(len(poses), len(self.expected), name)
        for (t, x, y, *_), (time, ex, ey, *_) in zip(poses, self.expected):
            self.assertAlmostEqual(t, time, places=5)
            self.assertLess(math.hypot(x - ex, y - ey), tolerance, f"{name}: stamp {t}")
        self.assertEqual(found, self.walls, name)
        self.assertEqual(self.summary["by_odometry"], len(poses) - 1)

    def info(self, name):
        ran = self.run_program("info", self.path(name))
        self.assertEqual(ran.returncode, 0, ran.stderr)
        return json.loads(ran.stdout)

    def refused(self, name, *words, options=()):
        ran = self.run_program("map", self.path(name), *options)
        self.assertEqual(ran.returncode, 1, ran.stderr)
        for word in words:
            self.assertIn(word, ran.stderr)
        self.assertTrue(ran.stderr.startswith(f"hermes-vector: {self.path(name)}"), ran.stderr)

    def test_bags_of_ros1(self):
        if not bags.rosbag():
            self.skipTest("there is no python3-rosbag")
        for compression in ("none", "bz2", "lz4"):
            bags.write_bag(self.path("a.bag"), messages(), compression)
            self.expect_the_drive("a.bag")
            self.assertEqual(self.told, "")
            info = self.info("a.bag")
            self.assertEqual({t["name"]: (t["type"], t["messages"]) for t in info["topics"]},
                             {"/scan": (LASER, 60), "/odom": (ODOMETRY, 60), "/tf_static": (FRAMES, 1)})
            self.assertEqual((info["odometry"], info["messages"]), ("/odom", 121))
            self.assertAlmostEqual(info["seconds"], 59 * 0.2 + 0.03, places=4)
            scanner = info["scanners"][0]
            self.assertEqual([scanner[k] for k in ("topic", "frame", "robot", "rays")], ["/scan", "laser", "base_link", RAYS])
            for found, expected in zip(scanner["sensor"], MOUNT):
                self.assertAlmostEqual(found, expected, places=5)

    def test_bags_that_were_not_closed(self):
        if not bags.rosbag():
            self.skipTest("there is no python3-rosbag")
        for compression in ("none", "bz2", "lz4"):
            bags.write_bag(self.path("whole.bag"), messages(), compression)
            with open(self.path("whole.bag"), "rb") as file:
                whole = bytearray(file.read())
            at = whole.index(b"index_pos=") + len("index_pos=")
            index = struct.unpack("<Q", whole[at:at + 8])[0]
            whole[at:at + 8] = bytes(8)
            with open(self.path("open.bag"), "wb") as file:
                file.write(whole)
            self.expect_the_drive("open.bag")
            with open(self.path("cut.bag"), "wb") as file:
                file.write(whole[:index // 2])
            poses, _ = self.trajectory("cut.bag")
            self.assertTrue(10 < len(poses) < 50)
            self.assertRegex(self.told, r"byte \d+: the (chunk|record) is cut off")
            info = self.info("cut.bag")
            self.assertIn("cut off", info["problem"])
            self.assertEqual(next(t["messages"] for t in info["topics"] if t["name"] == "/scan"), len(poses))

    def test_databases(self):
        bags.write_db3(self.path("a.db3"), messages("cdr"))
        self.expect_the_drive("a.db3")
        bags.write_db3(self.path("big.db3"), messages("cdr", big=True))
        self.expect_the_drive("big.db3")
        database = bags.write_db3(self.path("open.db3"), messages("cdr"), "wal")
        shutil.copy(self.path("open.db3"), self.path("killed.db3"))
        shutil.copy(self.path("open.db3-wal"), self.path("killed.db3-wal"))
        database.close()
        self.assertLess(os.path.getsize(self.path("killed.db3")), 10000)
        self.expect_the_drive("killed.db3")
        with open(self.path("a.db3"), "rb") as whole, open(self.path("cut.db3"), "wb") as cut:
            cut.write(whole.read()[:60000])
        poses, _ = self.trajectory("cut.db3")
        self.assertTrue(10 < len(poses) < 50)
        self.assertRegex(self.told, "table messages.*malformed")

    def folder_of(self, name, mode="", pack=None):
        folder = self.path(name)
        os.mkdir(folder)
        everything = messages("cdr")
        parts = [everything[:50], everything[50:]]
        for i, part in enumerate(parts):
            if mode == "message":
                part = [(*m[:3], pack(m[3])) for m in part]
            bags.write_db3(os.path.join(folder, f"part_{i}.db3"), part)
        return folder

    def test_split_databases(self):
        folder = self.folder_of("split")
        bags.write_metadata(folder, ["part_0.db3", "part_1.db3"])
        self.expect_the_drive("split")
        self.assertEqual(self.info("split")["messages"], 121)
        os.remove(os.path.join(folder, "metadata.yaml"))
        self.expect_the_drive("split")
        bags.write_metadata(folder, ["../split/part_0.db3", "missing.db3", ".", "part_1.db3"])
        self.expect_the_drive("split")
        self.assertIn("missing.db3: there is no such file", self.told)
        bags.write_metadata(folder, ["part_0.db3"], "file", "fancy")
        self.refused("split", "fancy", "zstd")

    @unittest.skipUnless(ZSTD, "there is no zstd")
    def test_packed_databases(self):
        def pack(data):
            return subprocess.run([ZSTD, "-q", "-c"], input=data, stdout=subprocess.PIPE, check=True).stdout
        folder = self.folder_of("messages", "message", pack)
        bags.write_metadata(folder, ["part_0.db3", "part_1.db3"], "message", "zstd")
        self.expect_the_drive("messages")
        folder = self.folder_of("files")
        for i in (0, 1):
            path = os.path.join(folder, f"part_{i}.db3")
            subprocess.run([ZSTD, "-q", "--rm", path, "-o", path + ".zstd"], check=True)
        bags.write_metadata(folder, ["part_0.db3", "part_1.db3.zstd"], "file", "zstd")
        self.expect_the_drive("files")
        self.expect_the_drive_in_mcap(pack, "zstd")
        with open(os.path.join(folder, "part_0.db3.zstd"), "rb") as whole, open(self.path("cut.db3.zstd"), "wb") as cut:
            cut.write(whole.read()[:5000])
        self.refused("cut.db3.zstd", "zstd: it is cut off", "byte 5000")

    def expect_the_drive_in_mcap(self, pack, compression):
        bags.write_mcap(self.path("packed.mcap"), messages("cdr"), pack=pack, compression=compression)
        self.expect_the_drive("packed.mcap")

    def test_mcap(self):
        bags.write_mcap(self.path("ros2.mcap"), messages("cdr"))
        self.expect_the_drive("ros2.mcap")
        self.assertEqual(self.info("ros2.mcap")["kind"], "MCAP")
        bags.write_mcap(self.path("ros1.mcap"), messages(), ros1=True)
        self.expect_the_drive("ros1.mcap")
        bags.write_mcap(self.path("fast.mcap"), messages("cdr"), with_chunks=False)
        self.expect_the_drive("fast.mcap")
        bags.write_mcap(self.path("open.mcap"), messages("cdr"), with_end=False)
        self.expect_the_drive("open.mcap")
        if LZ4:
            self.expect_the_drive_in_mcap(lambda data: subprocess.run([LZ4, "-c"], input=data, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                                                      check=True).stdout, "lz4")

    def test_scanners_of_other_kinds(self):
        def backwards(out, t, ranges):
            spoiled = [math.nan, math.inf, 0.01, 30.0, 31.0] + ranges[::-1] + [-1.0, -math.inf]
            return bags.laser_scan(out, t, spoiled, "laser", -FIRST + 5 * STEP, -STEP)

        def echoes(out, t, ranges):
            return bags.multi_echo_scan(out, t, ranges, "laser", FIRST, STEP)

        def points(ranges, heights):
            return [(r * math.cos(FIRST + i * STEP), r * math.sin(FIRST + i * STEP), z, ring)
                    for i, r in enumerate(ranges) for ring, z in heights]

        def rings(out, t, ranges):
            return bags.cloud(out, t, points(ranges, [(0, -1.0), (1, 0.01), (2, 1.0)]), "laser")

        def slices(out, t, ranges):
            return bags.cloud(out, t, points(ranges, [(0, -0.5), (0, 0.0), (0, 0.5)]), "laser", with_rings=False)

        for name, scan in (("backwards", (LASER, backwards)), ("echoes", ("sensor_msgs/MultiEchoLaserScan", echoes))):
            bags.write_db3(self.path(name + ".db3"), messages("cdr", scan=scan))
            self.expect_the_drive(name + ".db3")
        for name, scan, options in (("rings", rings, ()), ("slices", slices, ()), ("chosen", rings, ("--laser", "2")),
                                    ("higher", slices, ("--height", "0.45"))):
            for big in (False, True):
                bags.write_db3(self.path(f"{name}{big}.db3"), messages("cdr", scan=("sensor_msgs/PointCloud2", scan), big=big))
                poses, _ = self.trajectory(f"{name}{big}.db3", *options)
                for (_, x, y, *_), (_, ex, ey, *_) in zip(poses, self.expected):
                    self.assertLess(math.hypot(x - ex, y - ey), 0.05, name)

    def test_frames(self):
        bags.write_db3(self.path("tf.db3"), messages("cdr", odometry="tf"))
        self.expect_the_drive("tf.db3")
        self.assertEqual(self.info("tf.db3")["odometry"], "tf: odom to base_footprint")
        bags.write_mcap(self.path("slash.mcap"), messages(slash="/", odometry="tf"), ros1=True)
        self.expect_the_drive("slash.mcap")

        def mirrored(out, t, ranges):
            return bags.laser_scan(out, t, ranges[::-1], "laser", FIRST, STEP)
        bags.write_db3(self.path("hangs.db3"), messages("cdr", scan=(LASER, mirrored), turn=HANGING))
        self.expect_the_drive("hangs.db3")
        self.assertTrue(self.info("hangs.db3")["scanners"][0]["upside_down"])
        bags.write_db3(self.path("untold.db3"), messages("cdr", mount=False))
        self.expect_the_drive("untold.db3", "--sensor", ",".join(map(str, MOUNT)))
        self.assertEqual(self.told, "")
        self.trajectory("untold.db3")
        self.assertIn("where laser is on the robot is not told", self.told)
        bags.write_db3(self.path("nameless.db3"), messages("cdr", mount=False, child=""))
        self.trajectory("nameless.db3")
        self.assertIn("where laser is on the robot is not told", self.told)
        for child in ("", "base_footprint"):  # which tf does not have
            bags.write_db3(self.path(f"{child}.db3"), messages("cdr", child=child))
            self.expect_the_drive(f"{child}.db3")
            self.assertEqual(self.told, "")
        bags.write_db3(self.path("none.db3"), messages("cdr", odometry="none"))
        self.trajectory("none.db3")
        self.assertIn("there is no odometry", self.told)
        self.assertEqual(self.summary["by_odometry"], 0)

    def test_definitions(self):
        bags.write_mcap(self.path("rule.mcap"), messages("cdr"), definition_of=lambda kind: f"{bags.RULE}MSG: {kind}\n{bags.definition(kind)}")
        self.expect_the_drive("rule.mcap")
        bags.write_mcap(self.path("idl.mcap"), messages("cdr"), encoding="ros2idl", definition_of=lambda kind: "module sensor_msgs {\n")
        self.expect_the_drive("idl.mcap")
        bags.write_mcap(self.path("fields.mcap"), messages("cdr"), definition_of=lambda kind: "Header header\nfloat32 angle\n")
        self.refused("fields.mcap", "other fields")

    def test_several_scanners(self):
        two = messages("cdr") + [("/back/scan", LASER, t, bags.laser_scan(bags.Bytes("cdr"), t, ranges, "back")) for t, _, ranges in DRIVE.scans[:7]]
        bags.write_db3(self.path("two.db3"), two)
        self.refused("two.db3", "/scan (sensor_msgs/LaserScan, 60 messages)", "/back/scan", "--topic")
        self.refused("two.db3", "found no scanner /front", options=("--topic", "/front"))
        self.expect_the_drive("two.db3", "--topic", "scan")
        self.assertIn("left out: /back/scan", self.told)
        self.assertEqual(len(self.trajectory("two.db3", "--topic", "/back/scan")[0]), 7)

    def test_stamps(self):
        def unstamped(out, t, ranges):
            return bags.laser_scan(out, 0, ranges, "laser", FIRST, STEP)
        bags.write_db3(self.path("unstamped.db3"), messages("cdr", scan=(LASER, unstamped)))
        self.trajectory("unstamped.db3")
        self.assertIn("60 scan(s) without a stamp", self.told)
        twice = messages("cdr")
        again = [(topic, kind, t + 100, data) for topic, kind, t, data in twice]
        bags.write_db3(self.path("back.db3"), twice + again)
        self.trajectory("back.db3")
        self.assertIn("have a stamp before", self.told)

    def test_what_is_no_drive(self):
        bags.write_db3(self.path("other.db3"), messages("cdr"))
        with sqlite3.connect(self.path("other.db3")) as database:
            database.execute("UPDATE topics SET serialization_format = 'fancy' WHERE name = '/scan'")
        self.refused("other.db3", "serialization fancy")
        with sqlite3.connect(self.path("other.db3")) as database:
            database.execute("UPDATE topics SET name = '\x1b[2Jevil' WHERE name = '/scan'")
        self.refused("other.db3", "topic ?[2Jevil")
        bags.write_db3(self.path("empty.db3"), [m for m in messages("cdr") if m[0] == "/odom"])
        self.refused("empty.db3", "no topic of a scanner")
        for name, content, word in (("zero.bag", b"", "an empty file"), ("old.bag", b"#ROSBAG V1.2\nabc", "found #ROSBAG V1.2"),
                                    ("text.db3", b"hello", "another file"), ("none.mcap", b"\x89MCAP0\r\n", "no topic")):
            with open(self.path(name), "wb") as file:
                file.write(content)
            self.refused(name, word)
        with sqlite3.connect(self.path("songs.db3")) as database:
            database.execute("CREATE TABLE songs(id)")
        self.refused("songs.db3", "found no table topics")
        self.assertEqual(self.run_program("map", self.path("log"), "--topic", "/scan").returncode, 2)


if __name__ == "__main__":
    bags.with_rosbag()
    if not bags.rosbag():
        print("bags of ROS 1 are left out: there is no python3-rosbag")
    unittest.main(verbosity=2)
