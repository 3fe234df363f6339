#!/usr/bin/env python3
"""Simulator and logger as processes of their own: scans lie on the walls of the world, the pace is that of the sensor, the
recording replays to the same scans, bad input is refused with a message, a signal ends them in order."""
import bisect
import json
import math
import os
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

from support import BINARIES, WORLD, Daemon, Listener, Process, free_port, put, refusal, text_of, wait_for
import velodyne_reference as reference

SIGMA = 0.01


def wall_distance(edges, x, y):
    best = math.inf
    for x1, y1, x2, y2 in edges:
        dx, dy = x2 - x1, y2 - y1
        k = min(1.0, max(0.0, ((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy)))
        best = min(best, math.hypot(x1 + k * dx - x, y1 + k * dy - y))
    return best


def check_geometry(edges, scans, truth):
    """Every point, taken from where the robot was at that moment, lies on a wall within four sigma."""
    stamps = [message["stamp"] for message in truth]
    checked = far = 0
    for message in scans:
        scan = message["data"]
        angles = [math.atan2(y, x) for x, y in zip(scan["x"], scan["y"])]
        # The head begins straight ahead and turns clockwise; reversed: from just left of ahead all the way round.
        falls = sum(1 for a, b in zip(angles, angles[1:]) if b < a - 0.02)
        assert falls <= 1, f"turn {scan['turn']} is not counter-clockwise"
        for i in range(0, len(scan["x"]), 37):
            stamp = scan["stamp"] + scan["t"][i]
            after = bisect.bisect(stamps, stamp)
            if not 0 < after < len(truth):
                continue
            a, b = truth[after - 1]["data"], truth[after]["data"]
            k = (stamp - stamps[after - 1]) / (stamps[after] - stamps[after - 1])
            theta = a["theta"] + k * math.remainder(b["theta"] - a["theta"], 2 * math.pi)
            c, s = math.cos(theta), math.sin(theta)
            x = a["x"] + k * (b["x"] - a["x"]) + c * scan["x"][i] - s * scan["y"][i]
            y = a["y"] + k * (b["y"] - a["y"]) + s * scan["x"][i] + c * scan["y"][i]
            checked += 1
            far += wall_distance(edges, x, y) > 4 * SIGMA + 0.004  # and what rounding and interpolation add
    assert checked > 1000, checked
    assert far <= 1 + checked * 2e-4, f"{far} of {checked} points are off the walls"
    return checked


def check_refusals(folder):
    """Bad input ends a program with status 1 or 2 and a message that names what is wrong."""
    empty = os.path.join(folder, "empty.json")
    put(empty, '{"name": "empty", "edges": []}\n')
    listen = ["--listen", f"tcp://127.0.0.1:{free_port(0)}?protocol=json"]
    for program, arguments, status, words in (
            ("simulator", ["--set", f"world={empty}"], 1, [empty, "no edges"]),
            ("simulator", ["--set", "world=/nonexistent.json"], 1, ["/nonexistent.json", "No such file"]),
            ("simulator", ["--set", "lidar.rpms=600"], 1, ["lidar.rpms"]),
            ("simulator", ["--set", f"world={WORLD}", "--set", "lidar.host=nowhere"], 1, ["nowhere", "IPv4"]),
            ("velodynelogger", ["--set", "source.pcap=/nonexistent.pcap"], 1, ["/nonexistent.pcap", "No such file"])):
        done = subprocess.run([os.path.join(BINARIES, "hermes-" + program)] + listen + arguments, timeout=20, check=False,
                              capture_output=True, text=True, stdin=subprocess.DEVNULL, cwd=folder)
        assert done.returncode in (1, 2) and done.returncode >= status, (program, arguments, done)
        for word in words:
            assert word in done.stderr, (program, arguments, word, done.stderr)


def check_late_port(folder):
    """A port that another program has is received on as soon as that ends; until then health says what is missing."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", 0))
        port = other.getsockname()[1]
        process = Process(BINARIES, "velodynelogger", free_port(0), folder,
                          {"source.port": port, "source.address": "127.0.0.1", "record.folder": folder})
        logger = process.connect()
        health = lambda: next(item for item in logger.call("daemon.status")["health"] if item["name"] == "lidar")  # noqa: E731
        assert health()["level"] == "error" and f"UDP port {port}" in health()["message"], health()
    try:
        wait_for("the port", lambda: logger.call("source.status")["source"]["state"] == "live")
        assert health()["level"] != "error", health()
        # Of a capture that kept only the beginnings of frames nothing is decoded: told where its end is told.
        cut = os.path.join(folder, "cut.pcap")
        frame = bytes(12) + b"\x08\x00\x45" + bytes(8) + b"\x11" + bytes(10) + struct.pack(">4H", 2368, 2368, 1214, 0) + bytes(54)
        with open(cut, "wb") as file:
            file.write(struct.pack("<IHHIIII", 0xa1b2c3d4, 2, 4, 0, 0, 96, 1))
            for second in range(3):
                file.write(struct.pack("<IIII", second, 0, len(frame), 1248) + frame)
        logger.call("source.open", pcap=cut, speed=0)
        wait_for("the end", lambda: logger.call("source.status")["source"]["state"] == "ended")
        assert health()["level"] == "warn" and "gave no scan" in health()["message"], health()
        assert "of 3 records were left out: 3 cut" in health()["message"], health()
    finally:
        process.stop()


def drive(folder):
    lidar_port = free_port(0, socket.SOCK_DGRAM)
    processes = []
    try:
        for name, settings in (("velodynelogger", {"source.port": lidar_port, "source.address": "127.0.0.1",
                                                   "source.position_port": 0, "record.folder": folder,
                                                   "decode.clock": "gps"}),  # an independent decoder knows no other
                               ("simulator", {"world": WORLD, "lidar.port": lidar_port, "lidar.sigma_m": SIGMA})):
            processes.append(Process(BINARIES, name, free_port(0), folder, settings))
        logger, simulator = [process.connect() for process in processes]
        scans, truth, lidar = (Listener(processes[0].port, "scan2d"), Listener(processes[1].port, "truth"),
                               Listener(processes[0].port, "lidar"))
        truth.wait(2)
        scans.wait(2)
        recorded = logger.call("record.start", name="drive")["path"]
        before, begin = simulator.call("sim.state"), time.monotonic()
        simulator.call("sim.drive")
        scans.wait(len(scans.messages) + 50)
        after = simulator.call("sim.state")
        seconds = after["stamp"] - before["stamp"]
        assert abs((after["packets"] - before["packets"]) / seconds - 1808.45) < 2, (before, after)
        wait_for("keeping of the time", lambda: abs(simulator.call("sim.state")["stamp"] - before["stamp"] -
                                                    (time.monotonic() - begin)) < 0.5, 10)  # after a stall of the machine
        assert after["driving"] and abs(after["twist"]["vx"] - 0.8) < 0.01, after
        for method, params in (("source.open", {"pcap": recorded}), ("source.open", {"live": True}), ("source.close", {})):
            refusal(logger, method, "being recorded", **params)
        status = logger.call("record.stop")
        assert not any(status["losses"].values()) and status["counts"]["packets"] > 8000, status
        check_state(lidar, logger)
        check_refusals(folder)
        check_late_port(folder)
        check_faults(simulator, logger)
        check_replay(logger, processes[0].port, recorded)
        check_end(processes)
        return scans.messages, truth.messages
    finally:
        for process in processes:
            if process.process.poll() is None:
                process.stop()


def check_state(lidar, logger):
    def is_at_its_pace():  # of the last second, in which the machine may have stalled
        state = lidar.messages[-1]["data"]
        return abs(state["rpm"] - 600) < 3 and abs(state["packet_rate_hz"] - 1808) < 200

    wait_for("the pace of the sensor", is_at_its_pace, 10)
    state = lidar.messages[-1]["data"]
    for name in ("lost", "out_of_order", "kernel_drops", "turns_dropped", "wrong_size", "wrong_flag"):
        assert state[name] == 0, state
    wait_for("the state running", lambda: logger.call("daemon.status")["state"] == "running", 10)
    assert [entry["name"] for entry in logger.call("record.list")] == ["drive"]


def check_faults(simulator, logger):
    simulator.call("sim.fault", device="lidar", kind="loss", share=0.2)
    wait_for("notice of lost packets", lambda: logger.call("source.status")["lost"] >= 50, 10)
    simulator.call("sim.fault", device="lidar", kind="none")


def check_replay(logger, port, recorded):
    expected = reference.turns(recorded)
    stream = Daemon(port=port, timeout=30).subscribe("scan2d", queue=1000)
    logger.call("source.open", pcap=recorded, speed=0)
    scans = (message["data"] for message in stream)
    scan = next(scan for scan in scans if scan["turn"] == 0)  # behind the last turns of the live source
    for turn in expected:
        assert len(scan["x"]) == len(turn), (scan["turn"], len(scan["x"]), len(turn))
        assert scan["partial"] == (turn in (expected[0], expected[-1])), scan["turn"]
        for x, y, t, intensity, point in zip(scan["x"], scan["y"], scan["t"], scan["intensity"], reversed(turn)):
            assert abs(x - point.x) < 2e-5 and abs(y - point.y) < 2e-5 and intensity == point.intensity, (scan["turn"], x, y, point)
            assert abs(scan["stamp"] + t - point.stamp_ns * 1e-9) < 2e-6, (scan["turn"], scan["stamp"], t, point)
        if turn is not expected[-1]:
            scan = next(scans)
    refusal(logger, "record.start", "only what is received", name="replayed")


def check_end(processes):
    for process in processes:
        process.process.send_signal(signal.SIGTERM)
        begin = time.monotonic()
        assert process.process.wait(10) == 0, process.last_words()
        assert time.monotonic() - begin < 3, f"{process.name} took its time to end"


def main():
    edges = json.loads(text_of(WORLD))["edges"]
    with tempfile.TemporaryDirectory() as folder:
        scans, truth = drive(folder)
    # Without the packets lost on purpose.
    scans = [message for message in scans if not message["data"]["partial"]][:50]
    print(f"{len(scans)} scans, {check_geometry(edges, scans, truth)} points checked against the walls")
    return 0


if __name__ == "__main__":
    sys.exit(main())
