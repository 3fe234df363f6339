#!/usr/bin/env python3
"""Each kind of motor controllers on its line: a client drives the simulated base, the odometry is where the robot truly is, and when the motor
control is killed the robot goes no farther than was told."""
import math
import os
import tempfile
import time

from drive_ctl import Keys
from support import BINARIES, Process, free_port, simulated_hall, wait_for

TWIST = {"vx": 0.2, "omega": 0.1}
CAN_ID = 10
VESC = {"motors.vesc.can_id": CAN_ID, "motors.vesc.timeout_s": 0.2, "motors.vesc.brake_current_a": 20}, {"controllers.1.address": CAN_ID}
CAR = {"frame.layout": "ackermann", "frame.rear_motors": 2}
# Kind: baud, time-out, what both have, what the simulator has, what the motor control has.
BASES = {
    "arduino": (57600, 2, {"frame.layout": "differential"}, {}, {}),
    "vesc": (115200, 0.2, {"frame.layout": "two_wheels"}, *VESC),
    "vesc, a car": (115200, 0.2, CAR, VESC[0], {**VESC[1], "wheels.rear_left.controller": 1, "wheels.rear_right.controller": 1}),
    "opencr": (115200, 0.5, {"frame.layout": "differential", "frame.counts_per_turn": 4096}, {}, {}),
    "roboteq": (115200, 0.2, {"frame.layout": "two_wheels"}, {}, {"pid.qpps": 12000}),
}


def truth(simulator):
    pose = simulator.call("sim.state")["pose"]
    return pose["x"], pose["y"], pose["theta"]


def drive(motors, simulator, way):
    """Until the robot is so far from where it was."""
    begin = truth(simulator)

    def is_there():
        motors.call("motor.drive", **TWIST)
        time.sleep(0.05)  # as a client drives, at 20 Hz
        return math.dist(begin[:2], truth(simulator)[:2]) > way

    wait_for("the way", is_there)


def bend(address, simulator):
    """A car turns by the key that turns alone."""
    keys = Keys(address)

    def is_bend():
        keys.press(b"d")
        twist = simulator.call("sim.state")["twist"]
        return twist["vx"] > 0.1 and twist["omega"] < -0.05

    wait_for("a bend by one key", is_bend, 20)
    keys.press(b"q")
    assert keys.end()[0] == 0


def check(name, folder):
    baud, timeout_s, both, simulated, driven = BASES[name]
    kind = name.split(",")[0]
    both = {"frame.counts_per_turn": 3600, **both}
    process, link = simulated_hall(folder, **{"motors.kind": kind, "motors.full_speed": 12000, **both, **simulated})
    with process:
        simulator = process.connect()
        settings = {"controllers.kind": kind, "controllers.1.url": f"serial://{link}?baud={baud}", "controllers.timeout_s": timeout_s,
                    "pid.qpps": 10000, **both, **driven}
        with Process(BINARIES, "motorcontrol", free_port(0), folder, settings) as control:
            motors = control.connect()
            wait_for("readiness", lambda: motors.call("motor.state")["ready"], 20)
            motors.call("control.acquire", timeout_s=5)
            drive(motors, simulator, 0.5)
            assert motors.call("motor.stop", wait_s=5)["confirmed"]
            pose, (x, y, theta) = motors.call("motor.state")["pose"], truth(simulator)
            off, turned = math.dist((pose["x"], pose["y"]), (x, y)), abs(math.remainder(pose["theta"] - theta, 2 * math.pi))
            assert off < 0.01 and turned < 0.02, (name, off, turned)
            if name.endswith("a car"):
                motors.call("control.release")
                bend(f"127.0.0.1:{control.port}", simulator)
            motors.call("control.acquire", timeout_s=5)
            drive(motors, simulator, 0.1)
            longest_m = motors.call("motor.state")["longest_way_m"] * TWIST["vx"] / motors.call("settings.get", path="motion.vx")
            begin = truth(simulator)
            control.process.kill()
            wait_for("a stand", lambda: simulator.call("sim.state")["twist"]["vx"] == 0, 20)
            way = math.dist(begin[:2], truth(simulator)[:2])
            assert way < longest_m + 0.05, (name, way, longest_m)
        assert process.stop() == 0, process.last_words()
    print(f"{name}: odometry {1000 * off:.0f} mm and {1000 * turned:.0f} mrad off; killed it went on for {way:.3f} m")


def main():
    for name in BASES:
        with tempfile.TemporaryDirectory() as folder:
            check(name, os.path.realpath(folder))


if __name__ == "__main__":
    main()
