#!/usr/bin/env python3
"""A robot base for Hermes in plain Python 3: docs/own-base.md. Its wheels are simulated; for others write a class like Wheels."""
import time

from hermes_base import Base

ACCELERATION = 1.0  # m/s^2, and in the same time the rate of turn
TURN = 3.0  # rad/s^2


class Wheels:
    """Stands for motors with encoders: they follow a command, and stop, with a limited acceleration."""

    def __init__(self):
        self.command, self.velocity, self.time = (0.0, 0.0), (0.0, 0.0), time.monotonic()

    def turn(self, vx, omega):
        self.measured()  # until now they followed the last command
        self.command = (vx, omega)

    def measured(self):
        now = time.monotonic()
        steps = (ACCELERATION * (now - self.time), TURN * (now - self.time))
        self.velocity = tuple(is_ + max(-step, min(step, wanted - is_)) for is_, wanted, step in zip(self.velocity, self.command, steps))
        self.time = now
        return self.velocity


if __name__ == "__main__":
    base = Base("base", "Robot base", Wheels())
    base.run(base.cycle, port=7487)
