"""A decoder of HDL-32E and VLP-16 of its own, from the manuals' numbers alone, to compare the project's programs with: to the
last bit, since azimuths and ranges are the nearest doubles to exact quotients and the rest is the formula as it stands."""
import collections
import math
import struct

Point = collections.namedtuple("Point", "stamp_ns laser azimuth range intensity x y z")
# lasers, ns between two of them, ns of a firing, firings a block, the laser nearest to the horizon, elevations in degrees, how
# far above the sensor's origin each laser lies, in mm; how many lasers fire at once, counts a metre, and how far clockwise of the
# head each laser looks, in thousandths of a degree
Model = collections.namedtuple("Model", "lasers laser_ns firing_ns firings level elevations offsets at_once counts azimuths_mdeg",
                               defaults=(1, 500, [0] * 32))
HDL32E = Model(32, 1152, 46080, 1, 15, [
    -30.67, -9.33, -29.33, -8.00, -28.00, -6.67, -26.67, -5.33, -25.33, -4.00, -24.00, -2.67, -22.67, -1.33, -21.33, 0.00,
    -20.00, 1.33, -18.67, 2.67, -17.33, 4.00, -16.00, 5.33, -14.67, 6.67, -13.33, 8.00, -12.00, 9.33, -10.67, 10.67], [
        17.17, 4.76, 16.27, 4.07, 15.40, 3.38, 14.54, 2.70, 13.71, 2.02, 12.89, 1.35, 12.09, 0.67, 11.31, 0.00,
        10.54, -0.67, 9.78, -1.35, 9.04, -2.02, 8.30, -2.70, 7.58, -3.38, 6.86, -4.07, 6.15, -4.76, 5.45, -5.45])
VLP16 = Model(16, 2304, 55296, 2, 1, [-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15],
              [11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1, 5.1, -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2])
MODELS = {0x00: HDL32E, 0x21: HDL32E, 0x22: VLP16}
DUAL = 0x39


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


def ports(path):
    """The destination port of each datagram of such a pcap."""
    with open(path, "rb") as file:
        file.seek(24)
        while header := file.read(16):
            yield struct.unpack(">H", file.read(struct.unpack("<8xI4x", header)[0])[36:38])[0]


def absolute(microseconds, receive_ns):
    """The time with these microseconds of the hour that is nearest to the receive time; ns."""
    hour = 3600 * 10**9
    stamp = receive_ns // hour * hour + microseconds * 1000
    return min((stamp - hour, stamp, stamp + hour), key=lambda s: abs(s - receive_ns))


def groups(payload, returns):
    """Of each group of blocks that share an azimuth: azimuth, gap to the next group, and the blocks that are asked for."""
    size = 2 if payload[1204] == DUAL else 1
    chosen = {1: (0,), 2: {"last": (0,), "strongest": (1,), "both": (0, 1)}[returns]}[size]
    starts = range(0, 12, size)
    azimuths = [struct.unpack_from("<H", payload, 100 * block + 2)[0] for block in starts]
    gaps = [(after - before) % 36000 for before, after in zip(azimuths, azimuths[1:])]
    for start, azimuth, gap in zip(starts, azimuths, gaps + gaps[-1:]):
        yield azimuth, gap, [start + block for block in chosen]


def turns(path, lasers="level", returns="strongest", offsets=True):
    """The points, turn by turn, in the order of measuring; the first and the last turn may be partial. lasers: "level", "all" or
    a number. offsets: the lasers' own heights are added to z."""
    result, last_azimuth = [[]], None
    for receive_ns, payload in datagrams(path):
        if len(payload) != 1206:
            continue
        model = MODELS[payload[1205]]
        model = model if offsets else model._replace(offsets=[0.0] * model.lasers)
        wanted = {"level": [model.level], "all": range(model.lasers)}.get(lasers, [lasers])
        base = absolute(struct.unpack_from("<I", payload, 1200)[0], receive_ns)
        for azimuth, gap, blocks in groups(payload, returns):
            if last_azimuth is not None and last_azimuth - azimuth > 18000:
                result.append([])
            last_azimuth = azimuth
            for firing in range(model.firings):
                for laser in wanted:
                    result[-1] += returned(payload, model, base, (azimuth, gap), blocks, firing, laser)
            base += model.firings * model.firing_ns
    return result


def returned(payload, model, base, azimuth_gap, blocks, firing, laser):
    """The points of one laser in one firing: none without return, two where a dual return differs."""
    azimuth, gap = azimuth_gap
    block_ns, after_ns = model.firings * model.firing_ns, firing * model.firing_ns + laser // model.at_once * model.laser_ns
    mdeg_ns = 10 * (azimuth * block_ns + gap * after_ns) + model.azimuths_mdeg[laser] * block_ns
    degrees = mdeg_ns % (360000 * block_ns) / (1000 * block_ns)
    points, seen = [], {0}
    for block in blocks:
        distance, intensity = struct.unpack_from("<HB", payload, 100 * block + 4 + 3 * (firing * model.lasers + laser))
        if distance not in seen:
            seen.add(distance)
            metres, az, el = distance / model.counts, math.radians(degrees), math.radians(model.elevations[laser])
            points.append(Point(base + after_ns, laser, degrees, metres, intensity, metres * math.cos(el) * math.cos(az),
                                -metres * math.cos(el) * math.sin(az), metres * math.sin(el) + model.offsets[laser] / 1000))
    return points
