#!/usr/bin/env python3
"""The simulated laser scanner as a program sees it that knows nothing but an LD06 (docs/examples/ld06.py): it measures the hall from
its place on the robot, faults do what they should, a pulled line comes back. And scanners on a network."""
import math
import os
import socket
import sys
import tempfile
import time

from support import SOURCE, free_port, refusal, simulated_hall, wait_for

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
    refusal(simulator, "sim.fault", "ld06 has no fault health", device="scanner", kind="health")  # it sends and hears nothing
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


def connected(port):
    client = socket.create_connection(("127.0.0.1", port), 5)
    client.settimeout(5)
    return client


def told(client, end):
    """What comes, until this has come."""
    text = b""
    while end not in text:
        more = client.recv(4096)
        assert more, f"closed after {text[-200:]}"
        text += more
    return text


def expect(client, answer, end):
    """That the answer comes first, then something that ends so."""
    text = told(client, end)
    assert text.startswith(answer), text[:200]


def is_closed(client):
    """Whether the other end closes it."""
    try:
        while client.recv(4096):
            pass
    except ConnectionError:
        pass
    return True


def check_network(folder, model, start, answer, end):
    """start: a request upon which the scanner sends again and again what ends so."""
    port = free_port(0)
    process, _ = simulated_hall(folder, **{"scanner.model": model, "scanner.port": port, "lidar.port": 0})
    with process:
        simulator = process.connect()
        assert simulator.call("sim.state")["scanner"]["device"] == f"tcp://127.0.0.1:{port}"
        with connected(port) as client:
            client.sendall(start)
            expect(client, answer, end)
            with connected(port) as second:
                assert is_closed(second)
            for _ in range(5):
                told(client, end)
        with connected(port) as client:  # another one, to which nothing comes unasked
            client.settimeout(0.3)
            try:
                assert not client.recv(100), "it was not asked"
                raise AssertionError("it was refused")
            except socket.timeout:
                pass
            client.settimeout(5)
            client.sendall(start)
            expect(client, answer, end)
            simulator.call("sim.fault", device="scanner", kind="pulled")
            assert is_closed(client)
            assert simulator.call("sim.state")["scanner"]["device"] == ""
            try:
                connected(port).close()
                raise AssertionError("it is pulled")
            except ConnectionRefusedError:
                pass
        for _ in range(2):  # the second time it is in place
            simulator.call("sim.fault", device="scanner", kind="none")
        with connected(port) as client:
            client.sendall(start)
            expect(client, answer, end)


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
        check_network(folder, "hokuyo-ust10lx", b"MD0000108001000\n", b"MD0000108001000\n00P\n\n", b"\n\nMD0000108001000\n99b\n")
        check_network(folder, "sick-tim571", b"\2sEN LMDscandata 1\3", b"\2sEA LMDscandata 1\3", b" 0 1 B not defined 0 0 0\3")
        process, _ = simulated_hall(folder)
        with process:
            refusal(process.connect(), "sim.fault", "scanner.model", device="scanner", kind="silence")


if __name__ == "__main__":
    main()
