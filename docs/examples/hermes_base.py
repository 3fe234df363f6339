"""What every robot base has, in plain Python 3: the contract of docs/own-base.md around wheels of any kind. base.py is a base made of it."""
import asyncio
import math
import time

from hermes_daemon import Daemon, Refusal

HOLD_OFF_S = 2  # so long after the last press nobody releases the emergency stop


def number(unit, default, description, low=-1e11, high=1e11):
    return {"type": "number", "unit": unit, "default": default, "minimum": low, "maximum": high, "description": description}


SETTINGS = {
    "period_s": number("s", 0.02, "Of the odometry", 0.005, 0.05),
    "motion.vx": number("m/s", 0.5, "Largest speed forward and back", 0.01, 10),
    "motion.omega": number("rad/s", 1, "Largest rate of turn", 0.01, 20),
    "safety.command_timeout_s": number("s", 0.25, "Without a command for so long it stops", 0.05, 2),
    "safety.deceleration": number("m/s^2", 1, "With which it stops", 0.1, 20)}
TEXT, NO, WAIT = {"type": "string", "default": ""}, {"type": "boolean", "default": False}, number("s", 0, "Answers when the wheels stand, after this time at the latest", 0, 10)


class Base(Daemon):
    """A base whose wheels cannot go sideways. `wheels` has turn(vx, omega), which commands a velocity of the robot in m/s and rad/s and
    does not wait, and measured(), which gives the velocity that the encoders show now."""

    def __init__(self, name, title, wheels, settings=()):
        super().__init__(name, title, {**SETTINGS, **dict(settings)}, {"odometry": "Where the wheels have moved the robot"})
        self.wheels, self.x, self.y, self.theta, self.way, self.mono = wheels, 0.0, 0.0, 0.0, 0.0, time.monotonic()
        self.driver, self.driver_name, self.lease_s, self.heard = None, None, 0, 0  # who has the control
        self.commanded = 0  # when the wheels were told to turn
        self.latched, self.presser, self.stopped, self.pressed = False, None, None, 0  # the emergency stop
        for name, summary, function, parameters in (
                ("control.acquire", "Gives this client the control", self.acquire,
                 {"client": TEXT, "timeout_s": number("s", 1, "It ends without a command for so long", 0.1, 60), "take_over": NO}),
                ("control.release", "Gives it back; the robot stops", self.release, {}),
                ("motor.drive", "Drives so until the next command", self.drive,
                 {"vx": number("m/s", 0, "Ahead"), "vy": number("m/s", 0, "To the left"), "omega": number("rad/s", 0, "Counter-clockwise"),
                  "stamp": number("s", 0, "When the command was made; 0: now")}),
                ("motor.stop", "Stops; anyone may", self.stop, {"wait_s": WAIT, "client": TEXT}),
                ("motor.estop", "Stops until motor.reset_estop; anyone may", self.emergency_stop, {"wait_s": WAIT, "client": TEXT}),
                ("motor.reset_estop", "Releases the emergency stop", self.reset, {"confirm": NO, "client": TEXT}),
                ("motor.state", "Everything", self.state, {})):
            self.method(name, summary, **parameters)(function)

    def end_control(self):
        self.wheels.turn(0, 0)
        self.driver = self.driver_name = None

    def acquire(self, client, timeout_s, take_over):
        if self.driver not in (None, self.client) and not take_over:
            raise Refusal(-32002, f"{self.driver_name} has the control", {"holder": self.driver_name})
        if self.driver is not self.client:
            self.end_control()
        self.driver, self.driver_name, self.lease_s, self.heard = self.client, client or "a client", timeout_s, time.monotonic()
        return self.state()["control"]

    def release(self):
        if self.driver is self.client:
            self.end_control()

    def gone(self, client):
        if client is self.driver:
            self.end_control()

    def drive(self, vx, vy, omega, stamp):
        if self.latched:
            raise Refusal(-32005, "the emergency stop is latched; motor.reset_estop releases it")
        if self.driver is not self.client:
            raise Refusal(-32002, "this client does not have the control", {"holder": self.driver_name})
        if stamp and abs(time.time() - stamp) >= self.settings["safety.command_timeout_s"]:
            raise Refusal(-32005, "the command is late, or the clocks disagree")
        if abs(vx) > self.settings["motion.vx"] or vy or abs(omega) > self.settings["motion.omega"]:
            raise Refusal(-32007, f"{vx} m/s, {vy} m/s to the left, {omega} rad/s are beyond motion.*")
        self.heard = self.commanded = time.monotonic()
        self.wheels.turn(vx, omega)

    async def stop(self, wait_s, client):  # pylint: disable=unused-argument
        if self.driver is not self.client:
            self.end_control()
        self.wheels.turn(0, 0)
        return await self.standing(wait_s)

    async def emergency_stop(self, wait_s, client):  # pylint: disable=unused-argument
        self.presser = self.client if self.presser is self.client or not self.latched else None  # who alone pressed it
        self.stopped = self.stopped if self.latched else self.driver
        self.latched, self.pressed = True, time.monotonic()
        self.end_control()
        return await self.standing(wait_s)

    def reset(self, confirm, client):  # pylint: disable=unused-argument
        left = self.pressed + HOLD_OFF_S - time.monotonic()
        if self.latched and left > 0:
            raise Refusal(-32005, f"it was pressed just now, and is released in {left:.1f} s at the earliest", {"retry_after_s": left})
        if self.latched and not self.stands():
            raise Refusal(-32005, "the wheels turn")
        if self.latched and (self.client is self.stopped or self.client is not self.presser and not confirm):
            raise Refusal(-32005, "not by this client, or by a person who confirms", {"confirm": self.client is not self.stopped})
        self.latched = self.presser = self.stopped = None

    async def standing(self, wait_s):
        until = time.monotonic() + wait_s
        while not self.stands() and time.monotonic() < until:
            await asyncio.sleep(0.01)
        return self.state()["standing"]

    def stands(self):
        vx, omega = self.wheels.measured()
        return abs(vx) < 0.001 and abs(omega) < 0.005

    def state(self):
        vx, omega = self.wheels.measured()
        return {"ready": True, "estop": bool(self.latched), "latched": {"estop": "it was pressed"} if self.latched else {}, "halted": "",
                "control": {"held": self.driver is not None, "holder": self.driver_name, "wanted": None},
                "standing": {"confirmed": self.stands(), "text": "" if self.stands() else "the wheels turn"},
                "pose": {"x": self.x, "y": self.y, "theta": self.theta}, "twist": {"vx": vx, "vy": 0, "omega": omega}}

    def cycle(self):
        """One period: the odometry, and the wheels stop when nobody commands them any more."""
        now, (vx, omega) = time.monotonic(), self.wheels.measured()
        passed, self.mono = now - self.mono, now
        middle = self.theta + omega * passed / 2
        self.x, self.y = self.x + vx * passed * math.cos(middle), self.y + vx * passed * math.sin(middle)
        self.theta, self.way = math.remainder(self.theta + omega * passed, 2 * math.pi), self.way + (abs(vx) + abs(omega)) * passed
        if now - self.commanded > self.settings["safety.command_timeout_s"]:  # taking the control again is no command
            self.wheels.turn(0, 0)
        if now - self.heard > self.lease_s:
            self.end_control()
        variance = 1e-6 + 1e-3 * self.way
        self.publish("odometry", {"pose": self.state()["pose"], "twist": self.state()["twist"], "mono": now,
                                  "covariance": [variance, 0, 0, 0, variance, 0, 0, 0, variance]})
