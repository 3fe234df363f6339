#!/usr/bin/env python3
"""Stands for a laser scanner LD06 on the robot of hermes-simulator, in plain Python 3: sends the packets that it would send to a
pseudo-terminal, 4,500 beams and 10 turns a second."""
import argparse
import json
import math
import os
import random
import struct
import sys
import threading
import time
import tty

from hermes import Daemon, DaemonError
from ld06 import HEAD, POINTS, crc8

BEAMS_PER_S, DEGREES_PER_S, RANGE_M = 4500, 3600, 12
truth = {}  # the newest message: where the robot is; or why there is none


def follow(port):
    try:
        with Daemon(port=port) as simulator:
            for message in simulator.subscribe("truth"):
                truth.update(message["data"], stamp=message["stamp"])
    except (OSError, ValueError, KeyError, TypeError, DaemonError) as error:
        truth["fault"] = f"the simulator: {error}"


def distance(x, y, angle, edges):
    """From a place to the nearest edge in this direction; infinite where there is none."""
    dx, dy, nearest = math.cos(angle), math.sin(angle), math.inf
    for ax, ay, ux, uy in edges:
        across = dx * uy - dy * ux
        if across and 0 <= ((ax - x) * dy - (ay - y) * dx) / across <= 1:
            along = ((ax - x) * uy - (ay - y) * ux) / across
            if 0 < along < nearest:
                nearest = along
    return nearest


def packet(begin, degrees, mount, sigma, edges):
    """The twelve beams from this time and angle on, clockwise."""
    step, since = DEGREES_PER_S / BEAMS_PER_S, begin - truth["stamp"]
    theta = truth["theta"] + since * truth["omega"]
    x = truth["x"] + since * (math.cos(theta) * truth["vx"] - math.sin(theta) * truth["vy"])
    y = truth["y"] + since * (math.sin(theta) * truth["vx"] + math.cos(theta) * truth["vy"])
    x, y = x + math.cos(theta) * mount[0] - math.sin(theta) * mount[1], y + math.sin(theta) * mount[0] + math.cos(theta) * mount[1]
    returns = b""
    for i in range(POINTS):
        metres = distance(x, y, theta + mount[2] - math.radians(degrees + i * step), edges) + random.gauss(0, sigma)
        returns += struct.pack("<HB", round(1000 * metres), 200) if 0.02 < metres < RANGE_M else bytes(3)
    last = (degrees + (POINTS - 1) * step) % 360
    data = HEAD + struct.pack("<HH", DEGREES_PER_S, round(100 * degrees)) + returns
    data += struct.pack("<HH", round(100 * last), round(1000 * begin) % 30000)
    return data + bytes([crc8(data)])


def main():
    parser = argparse.ArgumentParser(description="Stands for a laser scanner LD06 on the robot of hermes-simulator.")
    parser.add_argument("world", help="the file of the simulator's world")
    parser.add_argument("link", help="the name that the serial line gets")
    parser.add_argument("--mount", type=float, nargs=3, default=(0, 0, 0), metavar=("X", "Y", "THETA"), help="on the robot; m, rad")
    parser.add_argument("--sigma", type=float, default=0.01, help="standard deviation of the ranges; m")
    parser.add_argument("--port", type=int, default=7490, help="of the simulator")
    arguments = parser.parse_args()
    with open(arguments.world, encoding="utf-8") as file:
        try:
            edges = [(ax, ay, bx - ax, by - ay) for ax, ay, bx, by in json.load(file)["edges"]]
        except (ValueError, KeyError, TypeError) as error:
            sys.exit(f"simulated_ld06.py: {arguments.world}: expected a world of the simulator: {error!r}")
    line, near = os.openpty()
    tty.setraw(near)
    os.set_blocking(line, False)
    if os.path.islink(arguments.link) and os.readlink(arguments.link).startswith("/dev/pts/"):  # of the last run
        os.remove(arguments.link)
    os.symlink(os.ttyname(near), arguments.link)
    threading.Thread(target=follow, args=(arguments.port,), daemon=True).start()
    begin, sent = time.time(), 0
    while "fault" not in truth:
        due = begin + sent * POINTS / BEAMS_PER_S
        time.sleep(max(0, due + 0.01 - time.time()))
        if "stamp" in truth and time.time() < due + 0.1:  # on a busy computer some are lost
            try:
                degrees = sent * POINTS * DEGREES_PER_S / BEAMS_PER_S % 360
                os.write(line, packet(due, degrees, arguments.mount, arguments.sigma, edges))
            except BlockingIOError:
                pass  # nobody reads
        sent += 1
    sys.exit(f"simulated_ld06.py: {truth['fault']}")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
    except OSError as error:
        sys.exit(f"simulated_ld06.py: {error}")
