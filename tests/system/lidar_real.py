#!/usr/bin/env python3
"""The recording of a real HDL-32E gives the same rings, point for point, by hermes-vector ring, by a replay in the logger,
sent over UDP to the logger, and by a decoder that shares no code with the project."""
import csv
import io
import os
import socket
import subprocess
import sys
import tempfile
import time

from support import BINARIES, DATA, Daemon, Process, free_port
import velodyne_reference as reference

CAPTURE = os.path.join(DATA, "hdl32e-outdoor.pcap")
HOUR_S = 3600


def check_ring(expected):
    text = subprocess.run([os.path.join(BINARIES, "hermes-vector"), "ring", CAPTURE], check=True, capture_output=True,
                          text=True, stdin=subprocess.DEVNULL).stdout
    rows = list(csv.DictReader(io.StringIO(text)))
    points = [(turn, point) for turn, points in enumerate(expected) for point in points]
    assert len(rows) == len(points), f"ring gives {len(rows)} points, the reference {len(points)}"
    for row, (turn, point) in zip(rows, points):
        assert int(row["turn"]) == turn and int(row["intensity"]) == point.intensity, row
        for name, value, tolerance in (("stamp", point.stamp_ns * 1e-9, 2e-6), ("azimuth", point.azimuth, 1e-3),
                                       ("range", point.range, 1e-4), ("x", point.x, 1e-4), ("y", point.y, 1e-4)):
            assert abs(float(row[name]) - value) <= tolerance, (name, row, point)


def check_scans(scans, expected, what):
    assert len(scans) == len(expected), f"{what}: {len(scans)} scans, {len(expected)} turns in the reference"
    # Live, the hour is that of today and not that of the recording.
    hours = round((scans[0]["stamp"] + scans[0]["t"][-1] - expected[0][0].stamp_ns * 1e-9) / HOUR_S) * HOUR_S
    for scan, points in zip(scans, expected):
        assert scan["partial"] == (points in (expected[0], expected[-1])), what
        assert len(scan["x"]) == len(points), f"{what}: {len(scan['x'])} points, {len(points)} in the reference"
        for x, y, t, intensity, point in zip(scan["x"], scan["y"], scan["t"], scan["intensity"], reversed(points)):
            assert abs(x - point.x) < 2e-5 and abs(y - point.y) < 2e-5 and intensity == point.intensity, (what, x, y, point)
            assert abs(scan["stamp"] + t - hours - point.stamp_ns * 1e-9) < 2e-6, (what, scan["stamp"], t, point)


def send_over_udp(port):
    """The capture's packets at the pace at which they were received."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        begin, first_ns = time.monotonic(), None
        for receive_ns, payload in reference.datagrams(CAPTURE):
            first_ns = receive_ns if first_ns is None else first_ns
            while time.monotonic() - begin < (receive_ns - first_ns) * 1e-9:
                pass
            sender.sendto(payload, ("127.0.0.1", port))


def status_when(logger, condition, limit_s=20):
    deadline = time.monotonic() + limit_s
    while True:
        status = logger.call("source.status")
        if condition(status):
            return status
        assert time.monotonic() < deadline, status
        time.sleep(0.02)


def receive(stream, count):
    return [next(stream)["data"] for _ in range(count)]


def check_losses(status):
    assert status["packets"] == 500, status
    for name in ("lost", "out_of_order", "kernel_drops", "turns_dropped", "wrong_size", "wrong_flag", "wrong_value"):
        assert status[name] == 0, status


def main():
    if not os.path.exists(CAPTURE):
        print(f"skipped: {CAPTURE} is not here; HERMES_DATA names the folder of the real recordings")
        return 77
    expected = reference.turns(CAPTURE)
    assert sum(map(len, expected)) > 1000 and len(expected) >= 3
    if os.path.exists(os.path.join(BINARIES, "hermes-vector")):
        check_ring(expected)
    with tempfile.TemporaryDirectory() as folder:
        lidar_port = free_port(0, socket.SOCK_DGRAM)
        with Process(BINARIES, "velodynelogger", free_port(0), folder,
                     {"source.port": lidar_port, "source.address": "127.0.0.1", "source.position_port": 0,
                      "record.folder": folder}) as process:
            logger = process.connect()
            stream = Daemon(port=process.port, timeout=30).subscribe("scan2d", queue=100)

            logger.call("record.start", name="live")
            send_over_udp(lidar_port)
            check_losses(status_when(logger, lambda s: s["packets"] == 500))
            assert logger.call("record.stop")["counts"]["packets"] == 500
            logger.call("source.close")  # delivers the last, partial turn
            check_scans(receive(stream, len(expected)), expected, "live")

            for speed in (0, 1, 5):
                logger.call("source.open", pcap=CAPTURE, speed=speed)
                check_scans(receive(stream, len(expected)), expected, f"replay at speed {speed}")
                check_losses(status_when(logger, lambda s: s["source"]["state"] == "ended"))
            assert process.stop() == 0, process.last_words()
        # What was recorded live is what was sent, byte for byte.
        sent = [payload for _, payload in reference.datagrams(CAPTURE)]
        assert [payload for _, payload in reference.datagrams(os.path.join(folder, "live", "velodynelogger-0001.pcap"))] == sent
    print(f"{len(expected)} turns, {sum(map(len, expected))} points: the same by ring, live, by replay and by the reference")
    return 0


if __name__ == "__main__":
    sys.exit(main())
