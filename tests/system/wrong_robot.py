#!/usr/bin/env python3
"""A robot base with a laser scanner in a room, made of docs/examples, that does one thing wrong, or is a car: the setting `fault`, one
of FAULTS."""
import json
import math
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "examples"))
import hermes_daemon  # noqa: E402
from base import Wheels  # noqa: E402
from hermes_base import Base  # noqa: E402

# What is wrong: the tester that has to find it (motor, scanner, or scanner with --base), and the line in which it does.
FAULTS = {
    "counts backward": ("motor", "odometry ahead"),
    "turns clockwise": ("motor", "odometry to the left"),
    "pose in the robot's frame": ("motor", "odometry ahead after the turn"),
    "no time-out": ("motor", "the wheels stand after the last command of a silent client"),
    "second client not refused": ("motor", "control.acquire of a second client"),
    "lease without end": ("motor", "motor.drive after these 0.5 s"),
    "take-over not carried out": ("motor", "motor.drive after a take-over"),
    "stop of others only for the moment": ("motor", "motor.drive after that stop"),
    "emergency stop not kept": ("motor", "motor.drive of another client after it"),
    "released by anybody": ("motor", "motor.reset_estop without confirm"),
    "stop not confirmed": ("motor", "motor.stop ahead"),
    "no limits": ("motor", "motor.drive above motion.vx"),
    "unknown parameters": ("motor", "motor.drive with an unknown parameter"),
    "NaN accepted": ("motor", "motor.drive with NaN and 1e999 is refused"),
    "odometry not finite": ("motor", "odometry"),
    "odometry from the future": ("motor", "stamps"),
    "odometry too rarely": ("motor", "rate of odometry"),
    "old commands": ("motor", "motor.drive with an old stamp"),
    "mirrored scans": ("base", "sense of rotation"),
    "clockwise scans": ("scanner", "counter-clockwise"),
    "scans from the future": ("scanner", "stamps"),
    "scans not finite": ("scanner", "scan2d"),
    "lists of other lengths": ("scanner", "equal lengths"),
    "millimetres": ("scanner", "metres"),
    "one turn": ("scanner", "turn"),
    "late beams": ("scanner", "t"),
    "a car, which is right": ("base", None),
}
FUTURE_S = 5
WALLS = ((4, 0), (-2, 0), (0, 3), (0, -1.5))  # at these places, square to the way there


class WrongRobot(Base):
    def __init__(self):
        super().__init__("wrong", "Robot", Wheels(), {"fault": {"type": "string", "default": ""}})
        self.topics["scan2d"] = "The points of each scan"
        self.number, self.scanned, self.told = 0, 0, 0

    def has(self, fault):
        assert fault in FAULTS, fault
        return self.settings["fault"] == fault

    def drive(self, vx, vy, omega, stamp):
        if self.has("emergency stop not kept"):
            self.latched = None
        if self.has("a car, which is right") and omega and not vx:
            raise hermes_daemon.Refusal(-32007, "it does not turn on the spot")
        if self.has("no limits") and max(abs(vx), abs(omega)) > 0.3:
            return
        super().drive(vx if math.isfinite(vx) else 0, vy, omega, 0 if self.has("old commands") else stamp)

    def acquire(self, client, timeout_s, take_over):
        if take_over and self.has("take-over not carried out"):
            return self.state()["control"]
        return super().acquire(client, 100 if self.has("lease without end") else timeout_s, take_over or self.has("second client not refused"))

    async def stop(self, wait_s, client):
        if self.has("stop of others only for the moment"):
            self.wheels.turn(0, 0)
            return await self.standing(wait_s)
        standing = await super().stop(wait_s, client)
        return {"confirmed": False, "text": "who knows"} if self.has("stop not confirmed") else standing

    def reset(self, confirm, client):
        super().reset(confirm or self.has("released by anybody"), client)

    def publish(self, topic, data, stamp=None):
        if topic == "odometry":
            if self.has("odometry too rarely"):
                if time.monotonic() < self.told + 0.2:
                    return
                self.told = time.monotonic()
            if self.has("counts backward"):
                data["pose"]["x"], data["pose"]["y"], data["twist"]["vx"] = -data["pose"]["x"], -data["pose"]["y"], -data["twist"]["vx"]
            if self.has("turns clockwise"):
                data["pose"]["y"], data["pose"]["theta"], data["twist"]["omega"] = -data["pose"]["y"], -data["pose"]["theta"], -data["twist"]["omega"]
            if self.has("pose in the robot's frame"):
                data["pose"].update(x=self.ahead, y=0)
            if self.has("odometry not finite"):
                data["pose"]["x"] = math.nan
            if self.has("odometry from the future"):
                stamp = time.time() + FUTURE_S
        super().publish(topic, data, stamp)

    ahead = 0

    def work(self):
        if self.has("no time-out"):
            self.commanded = time.monotonic()
        self.ahead += self.wheels.measured()[0] * (time.monotonic() - self.mono)
        self.cycle()
        if time.monotonic() > self.scanned + 0.1:
            self.scanned = time.monotonic()
            self.scan()

    def scan(self):
        stamp = time.time() + FUTURE_S * self.has("scans from the future")
        points = []
        for degree in range(360):
            angle = math.radians(degree)
            world = self.theta + angle  # where this beam goes in the room
            ranges = [math.hypot(*wall) / along for wall in WALLS
                      if (along := math.cos(world - math.atan2(wall[1], wall[0]))) > 0.01]
            points.append((angle, min(ranges)))
        if self.has("mirrored scans"):
            points = sorted((-angle, distance) for angle, distance in points)
        if self.has("clockwise scans"):
            points.reverse()
        scale = 1000 if self.has("millimetres") else 1
        x, y = [[scale * distance * turn(angle) for angle, distance in points] for turn in (math.cos, math.sin)]
        if self.has("scans not finite"):
            x[7] = math.inf
        self.number += not self.has("one turn")
        self.publish("scan2d", {
            "stamp": stamp, "turn": self.number, "rays": 360, "x": x, "y": y[self.has("lists of other lengths"):],
            "t": [1e-4 * i + 10 * self.has("late beams") for i in range(360)]}, stamp)


def main():
    robot = WrongRobot()
    check, from_json = hermes_daemon.check, hermes_daemon.from_json

    def tolerant(schemas, values, code):
        if robot.has("unknown parameters"):
            for name in [name for name in values if name not in schemas]:
                del values[name]
        if not robot.has("NaN accepted"):
            check(schemas, values, code)

    def send(client, message):
        client.write(json.dumps({"jsonrpc": "2.0", **message}).encode() + b"\n")
        return True

    hermes_daemon.check, hermes_daemon.send = tolerant, send
    hermes_daemon.from_json = lambda text: (json.loads if robot.has("NaN accepted") else from_json)(text)
    robot.run(robot.work, port=7487)


if __name__ == "__main__":
    main()
