"""An HDL-32E decoder of its own, from the manual's numbers alone, to compare the project's programs with."""
import collections
import math
import struct

Point = collections.namedtuple("Point", "stamp_ns azimuth range intensity x y")
LASER = 15  # looks along the horizon
FIRING_NS = 46080
LASER_NS = 1152


def datagrams(path):
    """Receive time (ns) and payload of each UDP datagram of a classic pcap of Ethernet frames."""
    with open(path, "rb") as file:
        magic = file.read(24)[:4]
        order, unit = {b"\xd4\xc3\xb2\xa1": ("<", 1000), b"\x4d\x3c\xb2\xa1": ("<", 1),
                       b"\xa1\xb2\xc3\xd4": (">", 1000), b"\xa1\xb2\x3c\x4d": (">", 1)}[magic]
        while True:
            header = file.read(16)
            if len(header) < 16:
                return
            seconds, fraction, size, _ = struct.unpack(order + "4I", header)
            frame = file.read(size)
            assert frame[12:14] == b"\x08\x00" and frame[14] == 0x45 and frame[23] == 17, "UDP over plain IPv4 expected"
            yield seconds * 10**9 + fraction * unit, frame[42:42 + struct.unpack(">H", frame[38:40])[0] - 8]


def absolute(microseconds, receive_ns):
    """The time with these microseconds of the hour that is nearest to the receive time; ns."""
    hour = 3600 * 10**9
    stamp = receive_ns // hour * hour + microseconds * 1000
    return min((stamp - hour, stamp, stamp + hour), key=lambda s: abs(s - receive_ns))


def turns(path):
    """The points of the horizontal ring, turn by turn, in the order of measuring; the first and the last may be partial."""
    result, last_azimuth = [[]], None
    for receive_ns, payload in datagrams(path):
        if len(payload) != 1206:
            continue
        azimuths = [struct.unpack_from("<H", payload, 100 * block + 2)[0] for block in range(12)]
        base = absolute(struct.unpack_from("<I", payload, 1200)[0], receive_ns)
        for block, azimuth in enumerate(azimuths):
            if last_azimuth is not None and last_azimuth - azimuth > 18000:
                result.append([])
            last_azimuth = azimuth
            before, after = (block, block + 1) if block < 11 else (10, 11)
            gap = (azimuths[after] - azimuths[before]) % 36000
            distance, intensity = struct.unpack_from("<HB", payload, 100 * block + 4 + 3 * LASER)
            if distance == 0:
                continue
            degrees = (azimuth + gap * LASER * LASER_NS / FIRING_NS) % 36000 / 100
            metres = distance * 0.002
            result[-1].append(Point(base + block * FIRING_NS + LASER * LASER_NS, degrees, metres, intensity,
                                    metres * math.cos(math.radians(degrees)), -metres * math.sin(math.radians(degrees))))
    return result
