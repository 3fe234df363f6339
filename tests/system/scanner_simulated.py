#!/usr/bin/env python3
"""The simulated laser scanner as a program sees it that knows nothing but an LD06 (docs/examples/ld06.py): it measures the hall from
its place on the robot, faults do what they should, a pulled line comes back."""
import math
import os
import sys
import tempfile
import time

from support import SOURCE, refusal, simulated_hall, wait_for

sys.path.insert(0, os.path.join(SOURCE, "docs", "examples"))
from ld06 import read_scans  # noqa: E402

WIDTH, LENGTH = 5, 9  # from the middle of the hall
MOUNT = 0.3, -0.2, 0.7


def shows_the_hall(points, pose):
    """Whether the points of a turn are those of a robot that stands so."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    x, y = pose[0] + MOUNT[0] * c - MOUNT[1] * s, pose[1] + MOUNT[0] * s + MOUNT[1] * c
    for angle, distance, _ in points:
        c, s = math.cos(pose[2] + MOUNT[2] + angle), math.sin(pose[2] + MOUNT[2] + angle)
        to_walls = (math.copysign(WIDTH, c) - x) / c, (math.copysign(LENGTH, s) - y) / s
        if abs(distance - min(to_walls)) > 0.02:
            return False
    return 440 < len(points) < 460


def check_faults(simulator, scans, link):
    assert "none, silence" in str(refusal(simulator, "sim.fault", device="scanner", kind="no_fix"))
    for kind in "silence", "stalled":
        simulator.call("sim.fault", device="scanner", kind=kind)
        before = wait_for("end of what was on its way", lambda: same_after_a_while(simulator))
        simulator.call("sim.fault", device="scanner", kind="none")
        wait_for("scanner that sends again", lambda: simulator.call("sim.state")["scanner"]["bytes"] > before)
    simulator.call("sim.fault", device="scanner", kind="corrupt", share=0.001)
    next(scans)  # by the checksums, from packets that were not damaged
    simulator.call("sim.fault", device="scanner", kind="pulled")
    assert not os.path.lexists(link)
    try:
        for _ in scans:
            pass
    except OSError:
        pass
    simulator.call("sim.fault", device="scanner", kind="none")
    next(read_scans(link))


def same_after_a_while(simulator):
    """The bytes that were sent, when for 0.3 s no more of them are."""
    def sent():
        return simulator.call("sim.state")["scanner"]["bytes"]
    before = sent()
    time.sleep(0.3)
    return before if sent() == before else None


def main():
    with tempfile.TemporaryDirectory() as folder:
        link = os.path.join(folder, "devices", "scanner")
        process, _ = simulated_hall(folder, size=WIDTH, **{
            "scanner.model": "ld06", "scanner.link": link, "scanner.x_m": MOUNT[0], "scanner.y_m": MOUNT[1],
            "scanner.theta_rad": MOUNT[2], "lidar.sigma_m": 0, "lidar.port": 0})
        with process:
            simulator = process.connect()
            for pose in (0, 0, 0), (1, -1, 0.5):
                simulator.call("sim.place", x=pose[0], y=pose[1], theta=pose[2])
                scans = read_scans(link)
                wait_for("scan of the hall", lambda: shows_the_hall(next(scans)[1], pose), 10)
            state = simulator.call("sim.state")
            assert state["packets"] == 0, "the lidar is off"
            scanner = state["scanner"]
            assert scanner["model"] == "ld06" and scanner["link"] == link and os.path.realpath(link) == scanner["device"], scanner
            assert scanner["revolutions"] > 2 and scanner["bytes"] > 5000, scanner
            check_faults(simulator, scans, link)
        process, _ = simulated_hall(folder)
        with process:
            refusal(process.connect(), "sim.fault", "scanner.model", device="scanner", kind="silence")


if __name__ == "__main__":
    main()
