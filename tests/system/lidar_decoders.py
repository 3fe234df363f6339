#!/usr/bin/env python3
"""hermes-vector ring and a decoder that shares no code with it agree on every point to the last bit: of the real captures, and
of made ones of both sensors in every return mode with random returns. The heights of the lasers are in z, unless they are not
wanted."""
import csv
import math
import os
import random
import struct
import subprocess
import sys
import tempfile

from support import BINARIES, DATA
import velodyne_reference as reference

HOUR_US = 3600 * 10**6


def write_capture(path, seed, product, mode, packets):
    """Random returns of a head that turns unevenly, over the end of an hour, to one port or another."""
    rng = random.Random(seed)
    model = reference.MODELS[product]
    size = 2 if mode == reference.DUAL else 1
    azimuth, stamp_us, port = rng.randrange(36000), HOUR_US - 20000, rng.choice((2368, 2369, 40000))
    with open(path, "wb") as file:
        file.write(struct.pack("<IHHIIII", 0xA1B23C4D, 2, 4, 0, 0, 65535, 1))
        for _ in range(packets):
            payload = b""
            for block in range(12):
                if block % size == 0:
                    azimuth = (azimuth + rng.randrange(10, 90)) % 36000
                payload += struct.pack("<HH", 0xEEFF, azimuth)
                for slot in range(32):
                    kind = rng.randrange(4)  # no return, the same as in the block before, or any
                    distance = 0 if kind == 0 else 1000 + slot if kind == 1 else rng.randrange(65536)
                    payload += struct.pack("<HB", distance, rng.randrange(256))
            payload += struct.pack("<IBB", stamp_us % HOUR_US, mode, product)
            receive_ns = 1700002800 * 10**9 - HOUR_US * 1000 + stamp_us * 1000 + rng.randrange(200000)
            frame = (bytes(12) + b"\x08\x00\x45\x00" + struct.pack(">H", 1234) + bytes(4) + b"\x40\x11" + bytes(10) +
                     struct.pack(">HHHH", port, port, 1214, 0) + payload)
            file.write(struct.pack("<IIII", receive_ns // 10**9, receive_ns % 10**9, len(frame), len(frame)) + frame)
            stamp_us += 12 // size * model.firings * model.firing_ns // 1000


def ring(path, *options):
    text = subprocess.run([os.path.join(BINARIES, "hermes-vector"), "ring", path, *options], check=True,
                          stdout=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL).stdout
    return list(csv.DictReader(text.splitlines()))


def compare(path, lasers, returns, *options):
    """Every number that ring prints is the double that the reference has."""
    rows = iter(ring(path, "--returns", returns, *options))
    count = 0
    for turn, points in enumerate(reference.turns(path, lasers, returns, "--no-vertical-offsets" not in options)):
        for point in points:
            row = next(rows)
            assert int(row["turn"]) == turn and int(row["intensity"]) == point.intensity, (path, row, point)
            assert int(row.get("laser", point.laser)) == point.laser, (path, row, point)
            assert int(row["stamp"].replace(".", "")) == point.stamp_ns, (path, row, point)
            for name in ("azimuth", "range", "x", "y", "z"):
                assert name not in row and name == "z" or float(row[name]) == getattr(point, name), (path, name, row, point)
            count += 1
    assert next(rows, None) is None, f"{path}: ring has more points than the reference"
    return count


def check_heights(path, model):
    """z lies above that of a laser in the sensor's origin by what is documented of the laser."""
    worst = 0
    for row, plain in zip(ring(path, "--all"), ring(path, "--all", "--no-vertical-offsets"), strict=True):
        offset_mm = model.offsets[int(row["laser"])]
        worst = max(worst, abs((float(row["z"]) - float(plain["z"])) * 1000 - offset_mm))
        assert [row[name] for name in ("stamp", "range", "x", "y")] == [plain[name] for name in ("stamp", "range", "x", "y")]
    assert worst < 0.1, f"{path}: z is beside the documented heights by up to {worst} mm"
    return worst


def check_tables():
    """All beams of a sensor meet in one point ahead of its axis, as its optical drawing shows: what is wrong in a table by more
    than its last digit comes to light."""
    for model, focus_mm, digit_mm in ((reference.HDL32E, 28.954, 0.01), (reference.VLP16, 41.85, 0.1)):
        for elevation, offset_mm in zip(model.elevations, model.offsets, strict=True):
            assert abs(offset_mm + focus_mm * math.tan(math.radians(elevation))) < digit_mm, (elevation, offset_mm)


def main():
    check_tables()
    counts = {}
    with tempfile.TemporaryDirectory() as folder:
        for product, name in ((0x21, "HDL-32E"), (0x22, "VLP-16")):
            for mode in (0x37, 0x38, reference.DUAL):
                path = os.path.join(folder, f"{name}-{mode:02x}.pcap")
                seed = random.randrange(10**9)
                write_capture(path, seed, product, mode, 60)
                for returns in ("strongest", "last", "both") if mode == reference.DUAL else ("strongest",):
                    key = f"{name}, mode {mode:02x}, {returns}, seed {seed}"
                    counts[key] = compare(path, "all", returns, "--all")
                    compare(path, "level", returns)
                    compare(path, 7, returns, "--laser", "7")
                compare(path, "all", "strongest", "--all", "--no-vertical-offsets")
                heights = check_heights(path, reference.MODELS[product])
                print(f"{name}, mode {mode:02x}: z is beside the documented heights by at most {heights:.1e} mm")
    assert all(count > 1000 for count in counts.values()), counts
    for name, turns in (("hdl32e-outdoor.pcap", 4), ("vlp16-single-packet.pcap", 1)):
        path = os.path.join(DATA, name)
        if not os.path.exists(path):
            print(f"{path} is not here: made captures only; HERMES_DATA names the folder of the real recordings")
            continue
        assert len(reference.turns(path)) == turns, name
        counts[name] = compare(path, "all", "strongest", "--all")
        compare(path, "level", "strongest")
    for name, count in counts.items():
        print(f"{name}: {count} points are the same to the last bit")
    return 0


if __name__ == "__main__":
    sys.exit(main())
