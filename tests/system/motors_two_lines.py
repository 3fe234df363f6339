#!/usr/bin/env python3
"""Motor control and simulator as processes, each controller on a serial line of its own: one line is pulled while the robot
drives and put back. The robot stops, goes on without a restart, and its odometry is where the robot truly is."""
import math
import os
import tempfile
import time

from lateness import Lateness
from support import BINARIES, Process, free_port, refusal, simulated_hall, wait_for

SPEED = 0.4  # m/s


def seconds_until(what, condition, limit_s=10):
    began = time.monotonic()
    wait_for(what, condition, limit_s)
    return time.monotonic() - began


def is_ready(motors):
    return motors.call("motor.state")["ready"]


def true_speed(simulator):
    twist = simulator.call("sim.state")["twist"]
    return math.hypot(twist["vx"], twist["vy"])


def drive(simulator, motors):
    """Until the robot goes at SPEED."""
    motors.call("control.acquire", timeout_s=10)

    def goes():
        motors.call("motor.drive", vx=SPEED)
        time.sleep(0.05)
        return abs(true_speed(simulator) - SPEED) < 0.05

    wait_for("driving", goes)


def compare_ways(simulator, motors):
    """Robot and odometry began at zero; when the robot stands they agree within 5 mm. Gives how far it has gone."""
    wait_for("standing", lambda: true_speed(simulator) == 0)
    truth = simulator.call("sim.state")["pose"]

    def away():
        told = motors.call("motor.state")["pose"]
        return math.hypot(truth["x"] - told["x"], truth["y"] - told["y"])

    wait_for(f"agreement of the odometry with the robot at {truth}", lambda: away() < 0.005)
    return truth["x"]


def pull_and_put_back(simulator, motors, line, lateness):
    drive(simulator, motors)
    lateness.take_longest()
    simulator.call("sim.fault", device=line, kind="pulled")
    noticed = seconds_until("notice of the pulled line", lambda: not is_ready(motors))
    message = str(refusal(motors, "motor.drive", vx=SPEED))
    assert f"controller {line[-1]} (0x80 on serial://" in message, message
    stood = seconds_until("standing", lambda: true_speed(simulator) == 0)
    late = 2 * lateness.take_longest()  # what holds up a nap here holds up the daemons too
    assert noticed < 0.5 + late and stood < 1 + late, (noticed, stood, late)
    time.sleep(1)  # the pauses between the attempts to open the line have grown
    simulator.call("sim.fault", device=line, kind="none")
    lateness.take_longest()
    back = seconds_until("recovery", lambda: is_ready(motors))
    late = 2 * lateness.take_longest()
    assert back < 0.6 + late, f"only {back:.2f} s after the line was put back the controllers were ready ({late:.2f} s late)"
    way = compare_ways(simulator, motors)
    assert motors.call("motor.state")["counter_jumps"] == 0
    print(f"{line}: noticed after {noticed:.3f} s, stood {stood:.3f} s later, ready {back:.3f} s after its return, {way:.3f} m")


def main():
    with tempfile.TemporaryDirectory() as folder:
        rear = os.path.join(folder, "rear")
        simulated, front = simulated_hall(folder, **{"motors.link2": rear, "motors.address2": 128})
        with simulated, Process(BINARIES, "motorcontrol", free_port(0), folder, {
                "controllers.1.url": f"serial://{front}", "controllers.2.url": f"serial://{rear}", "controllers.2.address": 128,
                "safety.command_timeout_s": 1}) as driven:
            simulator, motors = simulated.connect(), driven.connect()
            wait_for("readiness", lambda: is_ready(motors))
            with Lateness() as lateness:
                for line in ("line1", "line2", "line1"):
                    pull_and_put_back(simulator, motors, line, lateness)
            drive(simulator, motors)  # again
            statuses = [process.stop() for process in (driven, simulated)]
            assert statuses == [0, 0], f"{statuses}: {driven.last_words()}"


if __name__ == "__main__":
    main()
