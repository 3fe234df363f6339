#!/usr/bin/env python3
"""Publishes the scans of a laser scanner as `scan2d`, for hermes-scanmatcher, in plain Python 3: docs/other-lidars.md. The scanner
is an LD06 or LD19; for another one write a read_scans() like that of ld06.py."""
import collections
import math
import threading
import time

from hermes_daemon import Daemon
from ld06 import read_scans

laser = Daemon(
    "laser", "Laser scanner",
    settings={
        "device": {"type": "string", "default": "/dev/ttyUSB0", "description": "Of the scanner"},
        "field_of_view_deg": {"type": "number", "minimum": 1, "maximum": 360, "unit": "°", "default": 360, "description": "Of a scan"},
        "min_range_m": {"type": "number", "minimum": 0, "maximum": 100, "unit": "m", "default": 0.1, "description": "Nearer points are left out"},
        "max_range_m": {"type": "number", "minimum": 0, "maximum": 1000, "unit": "m", "default": 12, "description": "Farther points are left out"},
        "upside_down": {"type": "boolean", "default": False, "description": "It is mounted upside down"},
        "period_s": {"type": "number", "minimum": 0.001, "maximum": 1, "unit": "s", "default": 0.01, "description": "Of publishing"}},
    topics={"scan2d": "The points of each scan, counter-clockwise, in the sensor's frame"})
scans = collections.deque(maxlen=10)  # that were read and not yet published
fault = ""  # why no scan comes
turn, newest, lost = 0, 0.0, 0


def read():
    """Runs in a thread of its own, because read_scans() waits for the device."""
    global fault, lost
    while True:
        try:
            fault = "no whole turn comes"
            for scan in read_scans(laser.settings["device"]):
                lost += len(scans) == scans.maxlen  # the oldest
                scans.append(scan)
        except Exception as error:  # whatever a driver raises: it begins anew
            fault = str(error) or repr(error)
        time.sleep(1)


def work():
    """Publishes what was read since the last time."""
    global turn, newest
    settings = laser.settings
    while scans:
        stamp, beams = scans.popleft()
        side = -1 if settings["upside_down"] else 1
        points = sorted((side * angle, distance, seconds) for angle, distance, seconds in beams  # counter-clockwise
                        if math.isfinite(angle) and settings["min_range_m"] <= distance <= settings["max_range_m"])
        laser.publish("scan2d", {
            "stamp": stamp, "turn": turn,
            "rays": round(len(beams) * 360 / settings["field_of_view_deg"]),  # as many as in a full turn
            "x": [round(distance * math.cos(angle), 4) for angle, distance, _ in points],
            "y": [round(distance * math.sin(angle), 4) for angle, distance, _ in points],
            "t": [round(seconds, 5) for _, _, seconds in points]}, stamp)
        turn, newest = turn + 1, time.monotonic()
    if time.monotonic() - newest < 1:
        laser.set_health("scanner", "ok", f"scans come; this program was too slow for {lost}")
    else:
        laser.set_health("scanner", "error", f"no scan from {settings['device']}: {fault}")


threading.Thread(target=read, daemon=True).start()
laser.run(work, port=7483)
