#!/usr/bin/env python3
"""Bytes of ROS 2 messages, with nothing of the project's own: written from the rules of CDR (XCDR1) and the messages' definitions
alone, to compare with what Hermes sends. What is missing or left over raises CdrError.

As a program it checks itself: bytes worked out by hand, round trips, and type hashes against a file of them, if one is named."""
import hashlib
import json
import math
import re
import struct
import sys

# One line a message: its name, then its fields in the order of the wire. string<N> is bounded by N characters, x[N] is an array and
# x[] a sequence of any length.
DEFINITIONS = """
builtin_interfaces/Time: int32 sec, uint32 nanosec
builtin_interfaces/Duration: int32 sec, uint32 nanosec
std_msgs/Header: builtin_interfaces/Time stamp, string frame_id
std_msgs/String: string data
std_msgs/Bool: bool data
std_msgs/ColorRGBA: float32 r, float32 g, float32 b, float32 a
geometry_msgs/Point: float64 x, float64 y, float64 z
geometry_msgs/Vector3: float64 x, float64 y, float64 z
geometry_msgs/Quaternion: float64 x, float64 y, float64 z, float64 w
geometry_msgs/Pose: geometry_msgs/Point position, geometry_msgs/Quaternion orientation
geometry_msgs/PoseStamped: std_msgs/Header header, geometry_msgs/Pose pose
geometry_msgs/PoseWithCovariance: geometry_msgs/Pose pose, float64[36] covariance
geometry_msgs/PoseWithCovarianceStamped: std_msgs/Header header, geometry_msgs/PoseWithCovariance pose
geometry_msgs/Twist: geometry_msgs/Vector3 linear, geometry_msgs/Vector3 angular
geometry_msgs/TwistStamped: std_msgs/Header header, geometry_msgs/Twist twist
geometry_msgs/TwistWithCovariance: geometry_msgs/Twist twist, float64[36] covariance
geometry_msgs/Transform: geometry_msgs/Vector3 translation, geometry_msgs/Quaternion rotation
geometry_msgs/TransformStamped: std_msgs/Header header, string child_frame_id, geometry_msgs/Transform transform
tf2_msgs/TFMessage: geometry_msgs/TransformStamped[] transforms
sensor_msgs/LaserScan: std_msgs/Header header, float32 angle_min, float32 angle_max, float32 angle_increment, \
float32 time_increment, float32 scan_time, float32 range_min, float32 range_max, float32[] ranges, float32[] intensities
sensor_msgs/PointField: string name, uint32 offset, uint8 datatype, uint32 count
sensor_msgs/PointCloud2: std_msgs/Header header, uint32 height, uint32 width, sensor_msgs/PointField[] fields, bool is_bigendian, \
uint32 point_step, uint32 row_step, uint8[] data, bool is_dense
sensor_msgs/BatteryState: std_msgs/Header header, float32 voltage, float32 temperature, float32 current, float32 charge, \
float32 capacity, float32 design_capacity, float32 percentage, uint8 power_supply_status, uint8 power_supply_health, \
uint8 power_supply_technology, bool present, float32[] cell_voltage, float32[] cell_temperature, string location, string serial_number
sensor_msgs/NavSatStatus: int8 status, uint16 service
sensor_msgs/NavSatFix: std_msgs/Header header, sensor_msgs/NavSatStatus status, float64 latitude, float64 longitude, \
float64 altitude, float64[9] position_covariance, uint8 position_covariance_type
sensor_msgs/Imu: std_msgs/Header header, geometry_msgs/Quaternion orientation, float64[9] orientation_covariance, \
geometry_msgs/Vector3 angular_velocity, float64[9] angular_velocity_covariance, geometry_msgs/Vector3 linear_acceleration, \
float64[9] linear_acceleration_covariance
sensor_msgs/JointState: std_msgs/Header header, string[] name, float64[] position, float64[] velocity, float64[] effort
sensor_msgs/CompressedImage: std_msgs/Header header, string format, uint8[] data
nav_msgs/Odometry: std_msgs/Header header, string child_frame_id, geometry_msgs/PoseWithCovariance pose, \
geometry_msgs/TwistWithCovariance twist
nav_msgs/Path: std_msgs/Header header, geometry_msgs/PoseStamped[] poses
nav_msgs/MapMetaData: builtin_interfaces/Time map_load_time, float32 resolution, uint32 width, uint32 height, geometry_msgs/Pose origin
nav_msgs/OccupancyGrid: std_msgs/Header header, nav_msgs/MapMetaData info, int8[] data
diagnostic_msgs/KeyValue: string key, string value
diagnostic_msgs/DiagnosticStatus: byte level, string name, string message, string hardware_id, diagnostic_msgs/KeyValue[] values
diagnostic_msgs/DiagnosticArray: std_msgs/Header header, diagnostic_msgs/DiagnosticStatus[] status
rcl_interfaces/Log: builtin_interfaces/Time stamp, uint8 level, string name, string msg, string file, string function, uint32 line
rosgraph_msgs/Clock: builtin_interfaces/Time clock
visualization_msgs/UVCoordinate: float32 u, float32 v
visualization_msgs/MeshFile: string filename, uint8[] data
visualization_msgs/Marker: std_msgs/Header header, string ns, int32 id, int32 type, int32 action, geometry_msgs/Pose pose, \
geometry_msgs/Vector3 scale, std_msgs/ColorRGBA color, builtin_interfaces/Duration lifetime, bool frame_locked, \
geometry_msgs/Point[] points, std_msgs/ColorRGBA[] colors, string texture_resource, sensor_msgs/CompressedImage texture, \
visualization_msgs/UVCoordinate[] uv_coordinates, string text, string mesh_resource, visualization_msgs/MeshFile mesh_file, \
bool mesh_use_embedded_materials
visualization_msgs/MarkerArray: visualization_msgs/Marker[] markers
rmw_dds_common/Gid: uint8[16] data
rmw_dds_common/NodeEntitiesInfo: string<256> node_namespace, string<256> node_name, rmw_dds_common/Gid[] reader_gid_seq, \
rmw_dds_common/Gid[] writer_gid_seq
rmw_dds_common/ParticipantEntitiesInfo: rmw_dds_common/Gid gid, rmw_dds_common/NodeEntitiesInfo[] node_entities_info_seq
humble/Gid: uint8[24] data
humble/NodeEntitiesInfo: string<256> node_namespace, string<256> node_name, humble/Gid[] reader_gid_seq, humble/Gid[] writer_gid_seq
humble/ParticipantEntitiesInfo: humble/Gid gid, humble/NodeEntitiesInfo[] node_entities_info_seq
"""
# Of each type without fields: its letter for struct, its number in a type description.
PLAIN = {"bool": ("?", 15), "byte": ("B", 16), "int8": ("b", 2), "uint8": ("B", 3), "int16": ("h", 4), "uint16": ("H", 5),
         "int32": ("i", 6), "uint32": ("I", 7), "int64": ("q", 8), "uint64": ("Q", 9), "float32": ("f", 10), "float64": ("d", 11)}
NESTED, STRING, BOUNDED_STRING, ARRAY, SEQUENCE = 1, 17, 21, 48, 144
LITTLE, BIG = b"\0\1\0\0", b"\0\0\0\0"


class CdrError(ValueError):
    """Bytes or values that are no such message."""


class Type:
    """What a field is: `base` is a plain type, "string" or a message; `many` is None, a number, or "" for a sequence."""

    def __init__(self, text):
        self.base, bound, self.many = re.fullmatch(r"([\w/]+)(?:<(\d+)>)?(?:\[(\d*)\])?", text).groups()
        self.bound = int(bound or 0)

    def one(self):
        single = Type(self.base)
        single.bound = self.bound
        return single


def parsed(text):
    found = {}
    for line in text.strip().splitlines():
        name, _, fields = line.partition(": ")
        found[name] = [(field, Type(kind)) for kind, field in (part.split() for part in fields.split(", "))]
    return found


MESSAGES = parsed(DEFINITIONS)


def dds_name(message):
    """The name of its type on the wire, as sensor_msgs::msg::dds_::LaserScan_."""
    package, _, name = message.replace("humble/", "rmw_dds_common/").partition("/")
    return f"{package}::msg::dds_::{name}_"


class Reader:
    """Takes values from bytes; places count from behind the encapsulation."""

    def __init__(self, data):
        self.order = {LITTLE[:2]: "<", BIG[:2]: ">"}.get(bytes(data[:2]))
        if len(data) < 4 or self.order is None:
            raise CdrError(f"expected an encapsulation of plain CDR, found {bytes(data[:4]).hex()} ({len(data)} bytes)")
        self.padding, self.data, self.at = data[3] & 3, memoryview(data)[4:], 0

    def bytes(self, count, what):
        if count > len(self.data) - self.at:
            raise CdrError(f"{what}: expected {count} bytes at {self.at}, found {len(self.data) - self.at}")
        self.at += count
        return self.data[self.at - count:self.at]

    def plain(self, letter, count, what):
        size = struct.calcsize(letter)
        self.at += -self.at % size if count else 0
        return struct.unpack(f"{self.order}{count}{letter}", self.bytes(size * count, what))

    def text(self, what):
        size = self.plain("I", 1, what)[0]
        text = bytes(self.bytes(size, what))
        if not text.endswith(b"\0") or b"\0" in text[:-1]:
            raise CdrError(f"{what}: a string of {size} bytes that does not end with its only NUL")
        try:
            return text[:-1].decode()
        except UnicodeDecodeError as error:
            raise CdrError(f"{what}: {error}") from None

    def value(self, kind, what):
        if kind.many is None:
            return self.single(kind, what)
        count = self.plain("I", 1, what)[0] if kind.many == "" else int(kind.many)
        if kind.base in PLAIN:
            letter = PLAIN[kind.base][0]
            values = self.plain(letter, count, what)
            return bytes(values) if letter == "B" else list(values)
        if count > len(self.data) - self.at:  # each has a byte at least
            raise CdrError(f"{what}: {count} elements in {len(self.data) - self.at} bytes")
        return [self.single(kind.one(), f"{what}[{i}]") for i in range(count)]

    def single(self, kind, what):
        if kind.base in MESSAGES:
            return {name: self.value(inner, f"{what}.{name}") for name, inner in MESSAGES[kind.base]}
        if kind.base == "string":
            text = self.text(what)
            if kind.bound and len(text.encode()) > kind.bound:
                raise CdrError(f"{what}: a string of over {kind.bound} bytes")
            return text
        if kind.base == "bool":
            value = self.plain("B", 1, what)[0]
            if value > 1:
                raise CdrError(f"{what}: expected 0 or 1, found {value}")
            return bool(value)
        return self.plain(PLAIN[kind.base][0], 1, what)[0]

    def end(self, what):
        """All is used, but for what fills up the last four bytes of a submessage."""
        rest = bytes(self.data[self.at:])
        if len(rest) > -self.at % 4 or (self.padding and len(rest) != self.padding):
            raise CdrError(f"{what}: {len(rest)} bytes are left behind {self.at}, {self.padding} of padding are told")


class Writer:
    """Puts values into bytes; what a dictionary does not have is zero or empty."""

    def __init__(self):
        self.data = bytearray()

    def plain(self, letter, values, what):
        if values:
            self.data += bytes(-len(self.data) % struct.calcsize(letter))
        try:
            self.data += struct.pack(f"<{len(values)}{letter}", *values)
        except (struct.error, OverflowError) as error:
            raise CdrError(f"{what}: {error}") from None

    def value(self, kind, value, what):
        if kind.many is None:
            self.single(kind, value, what)
            return
        value = [None] * int(kind.many or 0) if value is None else value
        if kind.many == "":
            self.plain("I", [len(value)], what)
        elif len(value) != int(kind.many):
            raise CdrError(f"{what}: expected {kind.many} elements, found {len(value)}")
        if kind.base in PLAIN:
            self.plain(PLAIN[kind.base][0], [element or 0 for element in value], what)
            return
        for i, element in enumerate(value):
            self.single(kind.one(), element, f"{what}[{i}]")

    def single(self, kind, value, what):
        if kind.base in MESSAGES:
            value = value or {}
            if unknown := value.keys() - {name for name, _ in MESSAGES[kind.base]}:
                raise CdrError(f"{what}: {kind.base} has no {', '.join(sorted(unknown))}")
            for name, inner in MESSAGES[kind.base]:
                self.value(inner, value.get(name), f"{what}.{name}")
        elif kind.base == "string":
            text = (value or "").encode() + b"\0"
            if kind.bound and len(text) > kind.bound + 1:
                raise CdrError(f"{what}: a string of over {kind.bound} bytes")
            self.plain("I", [len(text)], what)
            self.data += text
        else:
            self.plain(PLAIN[kind.base][0], [value or 0], what)


def decode(message, data):
    """The fields of such a message (as "sensor_msgs/LaserScan"), by name; sequences of octets are bytes."""
    reader = Reader(data)
    value = reader.single(Type(message), message)
    reader.end(message)
    return value


def encode(message, value):
    """Its bytes, with the encapsulation."""
    writer = Writer()
    writer.single(Type(message), value, message)
    return LITTLE + bytes(writer.data)


def decode_graph(data):
    """A sample of ros_discovery_info, and whether it is of Humble (gids of 24 bytes) or "jazzy" (16, since Iron); exactly one fits."""
    found = []
    for package, release in (("humble", "humble"), ("rmw_dds_common", "jazzy")):
        try:
            found.append((decode(package + "/ParticipantEntitiesInfo", data), release))
        except CdrError as error:
            reason = error
    if len(found) != 1:
        raise CdrError(f"{len(found)} forms of ros_discovery_info fit {len(data)} bytes: {reason if not found else ''}")
    return found[0]


def full_name(message):
    return message.replace("/", "/msg/")


def referenced(message):
    """The messages inside of it."""
    found = set()
    for _, kind in MESSAGES[message]:
        if kind.base in MESSAGES:
            found |= {kind.base} | referenced(kind.base)
    return found


def described(message):
    fields = []
    for name, kind in MESSAGES[message]:
        number = NESTED if kind.base in MESSAGES else BOUNDED_STRING if kind.bound else STRING if kind.base == "string" else PLAIN[kind.base][1]
        number += 0 if kind.many is None else ARRAY if kind.many else SEQUENCE
        fields.append({"name": name, "type": {"type_id": number, "capacity": int(kind.many or 0), "string_capacity": kind.bound,
                                              "nested_type_name": full_name(kind.base) if kind.base in MESSAGES else ""}})
    return {"type_name": full_name(message), "fields": fields}


def type_hash(message):
    """RIHS01 of a message by REP 2016: SHA-256 of its type description and those of the messages in it, sorted by name."""
    description = {"type_description": described(message),
                   "referenced_type_descriptions": [described(other) for other in sorted(referenced(message), key=full_name)]}
    return "RIHS01_" + hashlib.sha256(json.dumps(description).encode()).hexdigest()


def by_hand(text):
    return LITTLE + bytes.fromhex(text)


# Bytes that no program wrote.
HAND = [
    ("std_msgs/String", {"data": "hi"}, by_hand("03000000 686900")),
    ("std_msgs/Bool", {"data": True}, by_hand("01")),
    ("rosgraph_msgs/Clock", {"clock": {"sec": -2, "nanosec": 258}}, by_hand("feffffff 02010000")),
    ("geometry_msgs/Twist", {"linear": {"x": 0.5, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": -2.0}},
     by_hand("000000000000e03f" + 32 * "00" + "00000000000000c0")),
    ("geometry_msgs/TwistStamped", {"header": {"stamp": {"sec": 1, "nanosec": 2}, "frame_id": "b"}, "twist": {
        "linear": {"x": 1.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}},
     by_hand("01000000 02000000 02000000 6200 0000 000000000000f03f" + 40 * "00")),
    ("sensor_msgs/PointField", {"name": "x", "offset": 4, "datatype": 7, "count": 1},
     by_hand("02000000 7800 0000 04000000 07 000000 01000000")),
    ("sensor_msgs/NavSatFix", {
        "header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}, "status": {"status": -1, "service": 1}, "latitude": 1.0,
        "longitude": 2.0, "altitude": 0.0, "position_covariance": [0.0] * 9, "position_covariance_type": 3},
     by_hand(16 * "0" + "01000000 00 ff 0100 000000000000f03f 0000000000000040" + 80 * "00" + "03")),
    ("diagnostic_msgs/KeyValue", {"key": "", "value": "ab"}, by_hand("01000000 00 000000 03000000 616200")),
    ("tf2_msgs/TFMessage", {"transforms": []}, by_hand("00000000")),
    ("nav_msgs/OccupancyGrid", {
        "header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "map"}, "info": {
            "map_load_time": {"sec": 0, "nanosec": 0}, "resolution": 0.5, "width": 2, "height": 1, "origin": {
                "position": {"x": 0.0, "y": 0.0, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}}, "data": [-1, 100]},
     by_hand("0000000000000000 04000000 6d617000 0000000000000000 0000003f 02000000 01000000 00000000" + 48 * "00" +
             "000000000000f03f 02000000 ff64")),
]


def check_hand():
    for message, value, data in HAND:
        assert encode(message, value) == data, (message, encode(message, value).hex(), data.hex())
        assert decode(message, data) == value, (message, decode(message, data))
        assert decode(message, data + bytes(-len(data) % 4)) == value, message  # as a submessage is filled up
        for wrong in (data[:-1], data + bytes(-len(data) % 4) + b"\0", data + bytes(8), data[:3], b"\0\3" + data[2:]):
            try:
                decode(message, wrong)
            except CdrError:
                continue
            raise AssertionError(f"{message}: taken though it is wrong: {wrong.hex()}")
    assert decode("geometry_msgs/Point", BIG + struct.pack(">3d", 1, 2, 3)) == {"x": 1.0, "y": 2.0, "z": 3.0}


def sample(kind, seed):
    """A value that differs from field to field."""
    if kind.many is not None:
        values = [sample(kind.one(), seed + i) for i in range(int(kind.many or seed % 4))]
        return bytes(values) if PLAIN.get(kind.base, "?")[0] == "B" else values
    if kind.base in MESSAGES:
        return {name: sample(inner, 31 * seed + i) for i, (name, inner) in enumerate(MESSAGES[kind.base])}
    if kind.base == "string":
        return "ä" * (seed % 5)
    letter = PLAIN[kind.base][0]
    return {"?": bool(seed % 2), "f": seed % 997 / 8, "d": math.sqrt(seed)}.get(letter, seed % 101)


def check_round_trips():
    for message in MESSAGES:
        for seed in range(20):
            value = sample(Type(message), seed)
            data = encode(message, value)
            assert decode(message, data) == value, message
            try:
                decode(message, data[:-1])
            except CdrError:
                continue
            raise AssertionError(f"{message}: taken without its last byte")
    for package in ("humble", "rmw_dds_common"):
        for seed in range(1, 20):
            value = sample(Type(package + "/ParticipantEntitiesInfo"), seed)
            data = encode(package + "/ParticipantEntitiesInfo", value)
            assert decode_graph(data) == (value, "humble" if package == "humble" else "jazzy"), (package, seed)


def check_hashes(path):
    with open(path, encoding="utf-8") as file:
        known = dict(line.split() for line in file if line.strip())
    mine = {full_name(message): type_hash(message) for message in MESSAGES if not message.startswith("humble/")}
    wrong = [name for name in mine if known.get(name, mine[name]) != mine[name]]
    assert not wrong, wrong
    return len(mine.keys() & known.keys())


def main():
    check_hand()
    check_round_trips()
    # As a real Jazzy tells them: a slip in the order of fields changes the hash.
    assert type_hash("sensor_msgs/LaserScan") == "RIHS01_64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828"
    assert type_hash("nav_msgs/Odometry") == "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0"
    print(f"{len(HAND)} messages by hand, {len(MESSAGES)} round trips", end="")
    print(f", {check_hashes(sys.argv[1])} type hashes" if len(sys.argv) > 1 else "")


if __name__ == "__main__":
    main()
