"""Who stands beside the robot: sees why it stopped, and lets it go on as a person would."""
import time

import processes  # noqa: F401  finds docs/examples
from drive import DriveError  # of docs/examples

MOST_PAUSES = 50  # in one drive
PATIENCE_S = 60.0  # until the controllers answer again
STILL_S = 0.5  # a robot that did not move for so long stands
CONTROL_LOST, DEVICE_FAULT = -32002, -32004
RELEASED = "controller_1", "controller_2", "encoder"  # causes that a silent controller has; not the emergency stop, the battery


class Attendant:
    """On a machine that is busy with other things the simulated controllers may answer so late that the motor control stops the
    robot, or that it finds them disobedient and holds the robot until somebody releases it. The attendant waits until the robot
    stands, releases it, says so and counts it. What a person stopped stays stopped."""

    def __init__(self, motors, simulator):
        self.motors, self.simulator = motors, simulator
        self.pauses = self.releases = 0

    def help(self, error):
        """Back when the robot may drive on after this DriveError, which is raised again where it may not."""
        self.pauses += 1
        is_wanted = error.halted.startswith("stopped by")
        if error.code not in (DEVICE_FAULT, CONTROL_LOST) or is_wanted or self.pauses > MOST_PAUSES:
            raise error
        deadline = time.monotonic() + PATIENCE_S
        while True:
            state = self.motors.call("motor.state")
            if not set(state["latched"]) <= set(RELEASED):
                raise error
            if state["latched"]:
                self.release(state["latched"], deadline, error)
            elif state["ready"]:
                return
            self.wait(deadline, error)

    def release(self, causes, deadline, error):
        """Releases a robot that a fault holds, once it is seen to stand."""
        print(f"\n  held by a fault: {'; '.join(causes.values())}", flush=True)
        place, since = None, time.monotonic()
        while time.monotonic() - since < STILL_S:
            now = self.simulator.call("sim.state")["pose"]
            if now != place:
                place, since = now, time.monotonic()
            self.wait(deadline, DriveError("the robot does not come to a stand"))
        if not set(self.motors.call("motor.state")["latched"]) <= set(RELEASED):
            raise error  # somebody stopped it meanwhile
        self.motors.call("motor.reset_estop")
        self.releases += 1
        print("  the robot stands: released with motor.reset_estop, it goes on", flush=True)

    @staticmethod
    def wait(deadline, error):
        if time.monotonic() > deadline:
            raise error
        time.sleep(0.05)
