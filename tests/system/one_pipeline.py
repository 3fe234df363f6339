#!/usr/bin/env python3
"""What is tuned on a capture holds for the robot: logger and matcher as processes give the poses that `hermes-vector map` gives."""
import math
import os
import socket
import subprocess
import tempfile

from support import BINARIES, DATA, WORLD, Daemon, Process, free_port, wait_for

PACKETS = 14500  # eight seconds


def record(folder):
    """The path of a capture of a simulated sensor that drives round."""
    port = free_port(0, socket.SOCK_DGRAM)
    settings = {"source.port": port, "source.address": "127.0.0.1", "source.position_port": 0, "record.folder": folder}
    with Process(BINARIES, "velodynelogger", free_port(0), folder, settings) as logger, \
            Process(BINARIES, "simulator", free_port(0), folder,
                    {"world": WORLD, "lidar.port": port, "lidar.sigma_m": 0.01}) as simulator:
        to_logger, to_simulator = logger.connect(), simulator.connect()
        path = to_logger.call("record.start", name="drive")["path"]
        to_simulator.call("sim.drive")
        wait_for("a drive", lambda: to_logger.call("record.status")["counts"]["packets"] > PACKETS)
        to_logger.call("record.stop")
        return path


def offline(path, folder):
    """(stamp, x, y, theta) of each scan."""
    out = os.path.join(folder, "offline.tum")
    subprocess.run([os.path.join(BINARIES, "hermes-vector"), "map", path, "--out-trajectory", out, "--force"], check=True,
                   stdout=subprocess.DEVNULL)
    with open(out, encoding="utf-8") as file:
        rows = [[float(word) for word in line.split()] for line in file if not line.startswith("#")]
    return [(r[0], r[1], r[2], 2 * math.atan2(r[6], r[7])) for r in rows]


def live(path, folder, count):
    """The same of the daemons."""
    with Process(BINARIES, "velodynelogger", free_port(0), folder, {"source.port": free_port(0, socket.SOCK_DGRAM), "decode.clock": "gps"}) as logger, \
            Process(BINARIES, "scanmatcher", free_port(0), folder,
                    {"source.address": f"127.0.0.1:{logger.port}", "source.queue": 10000}) as matcher:
        to_logger, control = logger.connect(), matcher.connect()
        stream = Daemon(port=matcher.port, timeout=60).subscribe("pose", queue=10000)
        wait_for("the matcher's connection", lambda: [item for item in control.call("daemon.status")["health"]
                                                      if item["name"] == "source" and item["level"] == "ok"])
        to_logger.call("source.open", pcap=path, speed=0)
        messages = [next(stream) for _ in range(count)]
        return [(m["stamp"], m["data"]["x"], m["data"]["y"], m["data"]["theta"]) for m in messages]


def compare(path, folder):
    expected = offline(path, folder)
    found = live(path, folder, len(expected))
    worst = 0.0
    for a, b in zip(expected, found):
        assert abs(a[0] - b[0]) < 2e-6, (a, b)
        worst = max(worst, abs(a[1] - b[1]), abs(a[2] - b[2]), abs(math.remainder(a[3] - b[3], 2 * math.pi)))
    assert worst <= 1e-9, f"the poses differ by up to {worst}"
    way = sum(math.hypot(b[1] - a[1], b[2] - a[2]) for a, b in zip(expected, expected[1:]))
    print(f"{os.path.basename(path)}: {len(expected)} poses over {way:.1f} m are the same, the farthest by {worst:.1e}")
    return way


def main():
    with tempfile.TemporaryDirectory() as folder:
        assert compare(record(folder), folder) > 1
        outdoor = os.path.join(DATA, "hdl32e-outdoor.pcap")
        if os.path.exists(outdoor):
            compare(outdoor, folder)


if __name__ == "__main__":
    main()
