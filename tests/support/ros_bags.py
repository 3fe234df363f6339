"""Writes bags for tests, and the messages in them: .bag by Debian's python3-rosbag, .db3 by sqlite3, .mcap by a writer of its own."""
import io
import os
import sqlite3
import struct
import sys
import zlib

HEADER = "uint32 seq\ntime stamp\nstring frame_id\n"
RULE = "=" * 80 + "\n"
POINT = "float64 x\nfloat64 y\nfloat64 z\n"
QUATERNION = "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
POSE = {"geometry_msgs/Pose": "Point position\nQuaternion orientation\n", "geometry_msgs/Point": POINT, "geometry_msgs/Quaternion": QUATERNION}
TWIST = {"geometry_msgs/Twist": "Vector3 linear\nVector3 angular\n", "geometry_msgs/Vector3": POINT}
# Of each type its md5 (as the real ones have it), its text and those of the types in it.
TYPES = {
    "sensor_msgs/LaserScan": ("90c7ef2dc6895d81024acba2ac42f369", "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
                              "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n",
                              {"std_msgs/Header": HEADER}),
    "sensor_msgs/MultiEchoLaserScan": ("6fefb0c6da89d7c8abe4b339f5c2f8fb", "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
                                       "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nLaserEcho[] ranges\n"
                                       "LaserEcho[] intensities\n", {"std_msgs/Header": HEADER, "sensor_msgs/LaserEcho": "float32[] echoes\n"}),
    "sensor_msgs/PointCloud2": ("1158d486dd51d683ce2f1be655c3c181", "Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n"
                                "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
                                {"std_msgs/Header": HEADER, "sensor_msgs/PointField": "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"}),
    "nav_msgs/Odometry": ("cd5e73d190d741a2f92e81eda573aca7", "Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
                          "geometry_msgs/TwistWithCovariance twist\n",
                          {"std_msgs/Header": HEADER, "geometry_msgs/PoseWithCovariance": "Pose pose\nfloat64[36] covariance\n",
                           "geometry_msgs/TwistWithCovariance": "Twist twist\nfloat64[36] covariance\n", **POSE, **TWIST}),
    "tf2_msgs/TFMessage": ("94810edda583a504dfda3829e70d7eec", "geometry_msgs/TransformStamped[] transforms\n",
                           {"geometry_msgs/TransformStamped": "Header header\nstring child_frame_id\nTransform transform\n", "std_msgs/Header": HEADER,
                            "geometry_msgs/Transform": "Vector3 translation\nQuaternion rotation\n", "geometry_msgs/Vector3": POINT,
                            "geometry_msgs/Quaternion": QUATERNION}),
}


def definition(kind):
    _, text, parts = TYPES[kind]
    return text + "".join(f"{RULE}MSG: {name}\n{part}" for name, part in parts.items())


class Bytes:
    """A message as ROS 1 (form "ros1") or ROS 2 (form "cdr") has it: little-endian, or, of CDR, big-endian."""

    def __init__(self, form, big=False):
        self.form, self.order, self.bytes = form, ">" if big else "<", bytearray()

    def numbers(self, letter, *values):
        size = struct.calcsize("<" + letter)
        if self.form == "cdr" and values:
            self.bytes += bytes(-len(self.bytes) % size)
        self.bytes += struct.pack(f"{self.order}{len(values)}{letter}", *values)
        return self

    def text(self, text):
        text = text.encode() + (b"\0" if self.form == "cdr" else b"")
        self.numbers("I", len(text)).bytes.extend(text)
        return self

    def array(self, letter, values):
        return self.numbers("I", len(values)).numbers(letter, *values)

    def header(self, stamp, frame):
        if self.form == "ros1":
            self.numbers("I", 0)
        nanoseconds = round(stamp * 1e9)
        return self.numbers("I", nanoseconds // 10**9, nanoseconds % 10**9).text(frame)

    def done(self):
        return bytes((b"\0\0\0\0" if self.order == ">" else b"\0\1\0\0") + self.bytes if self.form == "cdr" else self.bytes)


def turned(theta):
    """The quaternion of a turn about z, or that itself."""
    import math
    return theta if isinstance(theta, tuple) else (0, 0, math.sin(theta / 2), math.cos(theta / 2))


def laser_scan(out, stamp, ranges, frame="laser", first=-1.5, step=0.01, time_step=0.0, nearest=0.05, farthest=30.0):
    out.header(stamp, frame).numbers("f", first, first + step * (len(ranges) - 1), step, time_step, 0.1, nearest, farthest)
    return out.array("f", ranges).array("f", []).done()


def multi_echo_scan(out, stamp, ranges, frame="laser", first=-1.5, step=0.01):
    out.header(stamp, frame).numbers("f", first, first + step * (len(ranges) - 1), step, 0.0, 0.1, 0.05, 30.0).numbers("I", len(ranges))
    for distance in ranges:
        out.array("f", [distance, distance + 1])
    return out.numbers("I", 0).done()


def cloud(out, stamp, points, frame="lidar", with_rings=True):
    """points: x, y, z, ring."""
    fields = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7)] + ([("ring", 16, 4)] if with_rings else [])
    out.header(stamp, frame).numbers("I", 1, len(points), len(fields))
    for name, offset, kind in fields:
        out.text(name).numbers("I", offset).numbers("B", kind).numbers("I", 1)
    data = b"".join(struct.pack(f"{out.order}fff4xH2x", *point) for point in points)
    return out.numbers("B", out.order == ">").numbers("I", 20, 20 * len(points)).array("B", data).numbers("B", 1).done()


def odometry(out, stamp, pose, twist=(0, 0, 0), frame="odom", child="base_link"):
    x, y, theta = pose
    out.header(stamp, frame).text(child).numbers("d", x, y, 0, *turned(theta)).numbers("d", *[0] * 36)
    return out.numbers("d", twist[0], twist[1], 0, 0, 0, twist[2]).numbers("d", *[0] * 36).done()


def transforms(out, *all_of_them):
    """Of each: stamp, parent, child, (x, y, z), turn about z or quaternion."""
    out.numbers("I", len(all_of_them))
    for stamp, parent, child, place, turn in all_of_them:
        out.header(stamp, parent).text(child).numbers("d", *place, *turned(turn))
    return out.done()


def rosbag():
    """Debian's module, or None."""
    try:
        import rosbag as module
        return module
    except ImportError:
        return None


def with_rosbag():
    """Runs this script by Debian's Python where the one before it in the path has no module rosbag."""
    if not rosbag() and os.path.exists("/usr/bin/python3") and not os.environ.get("HERMES_TRIED_PYTHON"):
        os.environ["HERMES_TRIED_PYTHON"] = "1"
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])


def write_bag(path, messages, compression="none", chunk_bytes=8192):
    """messages: topic, type, time in seconds, bytes of ROS 1."""
    import genpy
    with rosbag().Bag(path, "w", compression=compression, chunk_threshold=chunk_bytes) as bag:
        for topic, kind, time, data in messages:
            kind_of = type("Type", (), {"_type": kind, "_md5sum": TYPES[kind][0], "_full_text": definition(kind)})
            bag.write(topic, (kind, data, TYPES[kind][0], kind_of), genpy.Time.from_sec(time), raw=True)


def ros2_type(kind):
    return kind.replace("/", "/msg/")


def write_db3(path, messages, journal="delete"):
    """messages: topic, type, time in seconds, CDR. The database is left as it is while it is open where the journal is "wal"."""
    database = sqlite3.connect(path)
    database.execute(f"PRAGMA journal_mode={journal}")
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                     "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    database.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    ids = {}
    for topic, kind, time, data in messages:
        if topic not in ids:
            ids[topic] = len(ids) + 1
            database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", (ids[topic], topic, ros2_type(kind)))
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", (ids[topic], round(time * 1e9), data))
    database.commit()
    if journal != "wal":
        database.close()
    return database


def write_metadata(folder, files, mode="", compression=""):
    with open(os.path.join(folder, "metadata.yaml"), "w", encoding="utf-8") as text:
        text.write("rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  relative_file_paths:\n")
        text.writelines(f"    - {file}\n" for file in files)
        text.write(f"  compression_format: \"{compression}\"\n  compression_mode: \"{mode}\"\n")


def write_mcap(path, messages, ros1=False, pack=None, compression="", chunk_messages=20, with_end=True, with_chunks=True,
               encoding="", definition_of=definition):
    """messages: topic, type, time in seconds, bytes. pack: of the records of a chunk."""
    file = io.BytesIO()

    def text(value):
        value = value.encode() if isinstance(value, str) else value
        return struct.pack("<I", len(value)) + value

    def record(op, content):
        return struct.pack("<BQ", op, len(content)) + content

    file.write(b"\x89MCAP0\r\n" + record(1, text("ros1" if ros1 else "ros2") + text("test")))
    ids = {}

    def records(part):
        out = b""
        for number, (topic, kind, time, data) in enumerate(part):
            if topic not in ids:
                ids[topic] = len(ids) + 1
                out += record(3, struct.pack("<H", ids[topic]) + text(kind if ros1 else ros2_type(kind)) + text(encoding or ("ros1msg" if ros1 else "ros2msg")) +
                              text(definition_of(kind)))
                out += record(4, struct.pack("<HH", ids[topic], ids[topic]) + text(topic) + text("ros1" if ros1 else "cdr") + text(b""))
            nanoseconds = round(time * 1e9)
            out += record(5, struct.pack("<HIQQ", ids[topic], number, nanoseconds, nanoseconds) + data)
        return out

    for begin in range(0, len(messages), chunk_messages):
        part = messages[begin:begin + chunk_messages]
        raw = records(part)
        if not with_chunks:
            file.write(raw)
            continue
        packed = pack(raw) if pack else raw
        times = [round(time * 1e9) for _, _, time, _ in part]
        file.write(record(6, struct.pack("<QQQI", min(times), max(times), len(raw), zlib.crc32(raw)) + text(compression) +
                          struct.pack("<Q", len(packed)) + packed))
    if with_end:
        file.write(record(15, bytes(4)) + record(2, bytes(20)) + b"\x89MCAP0\r\n")
    with open(path, "wb") as out:
        out.write(file.getvalue())
