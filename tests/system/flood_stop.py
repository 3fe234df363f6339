#!/usr/bin/env python3
"""Clients that send requests as fast as they can do not hold up an emergency stop, nor does a hang-up of the terminal leave the
robot moving."""
import json
import math
import os
import signal
import socket
import statistics
import sys
import tempfile
import threading
import time

sys.path.insert(0, os.path.join(os.environ["HERMES_SOURCE"], "deploy", "demo"))
from processes import Process, free_port  # noqa: E402

BINARIES = os.environ["HERMES_BIN"]
FLOODERS, TRIALS, LONGEST_S = 8, 9, 0.1


def wait_for(what, condition, limit_s=10):
    deadline = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < deadline, f"{what} did not happen within {limit_s} s"
        time.sleep(0.02)


def flood(port, ends):
    """Motion commands, without a pause and without reading."""
    commands = b'{"jsonrpc":"2.0","method":"motor.drive","params":{"vx":0.3}}\n' * 200
    with socket.create_connection(("127.0.0.1", port), 10) as connection:
        connection.settimeout(0.5)
        while not ends.is_set():
            try:
                connection.sendall(commands)
            except socket.timeout:
                pass  # a half command only costs an error reply
            except OSError:
                return


def is_ready(motors):
    return motors.call("motor.state")["ready"]


def speed_of(simulator):
    twist = simulator.call("sim.state")["twist"]
    return math.hypot(twist["vx"], twist["vy"])


def check_stops(motors, port):
    ends = threading.Event()
    flooders = [threading.Thread(target=flood, args=(port, ends)) for _ in range(FLOODERS)]
    for flooder in flooders:
        flooder.start()
    try:
        time.sleep(0.5)  # let their queues fill
        taken = []
        for _ in range(TRIALS):
            began = time.monotonic()
            motors.call("motor.estop")
            taken.append(time.monotonic() - began)
            motors.call("motor.reset_estop")
        assert statistics.median(taken) < LONGEST_S, f"emergency stops took {taken} s"
        return statistics.median(taken)
    finally:
        ends.set()
        for flooder in flooders:
            flooder.join()


def check_hang_up(process, motors, simulator):
    motors.call("control.acquire", client="test", timeout_s=5)
    deadline = time.monotonic() + 10
    while speed_of(simulator) < 0.2:
        assert time.monotonic() < deadline, "the robot does not move"
        motors.call("motor.drive", vx=0.3)
    process.process.send_signal(signal.SIGHUP)
    assert process.process.wait(10) == 0, process.last_words()
    wait_for("standing", lambda: speed_of(simulator) == 0, 2)


def main():
    with tempfile.TemporaryDirectory() as folder:
        link, world = os.path.join(folder, "motors"), os.path.join(folder, "hall.json")
        with open(world, "w", encoding="utf-8") as file:
            json.dump({"name": "hall", "edges": [[-9, -9, 9, -9], [9, -9, 9, 9], [9, 9, -9, 9], [-9, 9, -9, -9]],
                       "poses": [[0, 0, 0]]}, file)
        simulated = Process(BINARIES, "simulator", free_port(0), folder,
                            {"motors.link": link, "world": world, "lidar.port": free_port(0, socket.SOCK_DGRAM)})
        try:
            simulator = simulated.connect()
            url = f"serial://{link}?baud=115200"
            driven = Process(BINARIES, "motorcontrol", free_port(0), folder,
                             {"controllers.1.url": url, "controllers.2.url": url})
            try:
                motors = driven.connect()
                wait_for("readiness", lambda: is_ready(motors))
                median = check_stops(motors, driven.port)
                wait_for("readiness", lambda: is_ready(motors))
                check_hang_up(driven, motors, simulator)
            finally:
                driven.stop()
        finally:
            simulated.stop()
    print(f"{FLOODERS} flooding clients: an emergency stop takes {1000 * median:.1f} ms")


if __name__ == "__main__":
    main()
