#!/usr/bin/env python3
"""Drives a robot along way points through hermes-motorcontrol, in plain Python 3.

    drive.py 1,0 2,0.5 2,2                      # metres, in the frame of the odometry
    drive.py --matcher 127.0.0.1:7450 1,0 2,2   # in the frame of the scan matcher's map

Where the robot is comes from the topic `odometry` of the motor control or from the topic `pose` of a scan matcher; velocities
go out 20 times a second, each with the time when it was made. Ctrl-C stops the robot, and so does everything that goes wrong.
"""
import argparse
import bisect
import math
import signal
import sys
import threading
import time

from hermes import Daemon, DaemonError

PERIOD_S = 0.05
OLDEST_POSE_S = 0.5  # an older pose moves nothing
PATIENCE_S = 3.0  # how long the robot waits for poses, or the way is blocked by late commands, before it gives up
CONTROL_S = 3.0  # without a command for so long the control ends; the robot stops long before
NOT_READY = -32005


class DriveError(Exception):
    """The drive ended before its last way point; the robot stands. `code` is that of the refusal, if there was one,
    `halted` why the robot had stopped by then."""

    def __init__(self, reason, halted=""):
        text = f"motor control: {reason}" if isinstance(reason, DaemonError) else reason
        super().__init__(f"{text}; {halted}" if halted else text)
        self.code, self.halted = getattr(reason, "code", None), halted


class PathFollower:
    """Velocities that lead along way points: pure pursuit of a point ahead, slower in bends, braking at the end. Points are (x, y) in
    metres; ValueError where they are fewer than two, or another number is not above 0. speed is the largest one (m/s), turn_rate that
    of turning (rad/s), braking the deceleration at the end (m/s^2). look_ahead is the way to the point ahead, tolerance ends the
    drive (both metres). least_radius (metres) is that of the tightest bend; 0: the robot turns on the spot."""

    WINDOW_M = 1.0  # where the robot may have got to since the last time; a path may cross itself

    def __init__(self, points, speed=0.5, turn_rate=1.0, braking=0.5, look_ahead=0.4, tolerance=0.03, least_radius=0.0):
        points = [tuple(map(float, point[:2])) for point in points]
        if len(points) < 2 or not all(map(math.isfinite, sum(points, ()))):
            raise ValueError("two or more way points of finite numbers expected")
        for name, value in (("speed", speed), ("turn_rate", turn_rate), ("braking", braking), ("look_ahead", look_ahead), ("tolerance", tolerance)):
            if not 0 < value < math.inf:
                raise ValueError(f"{name} is {value}, expected a number above 0")
        self.speed, self.turn_rate, self.braking = speed, turn_rate, braking
        self.look_ahead, self.tolerance, self.least_radius = look_ahead, tolerance, least_radius
        self.legs = []  # where each begins along the path, its length, first point and direction
        self.length = 0.0
        for (ax, ay), (bx, by) in zip(points, points[1:]):
            length = math.hypot(bx - ax, by - ay)
            if length > 0:
                self.legs.append((self.length, length, (ax, ay), ((bx - ax) / length, (by - ay) / length)))
                self.length += length
        self.way = 0.0  # how far along the path the robot is

    @property
    def progress(self):
        """The part of the path behind the robot, 0 to 1."""
        return self.way / self.length if self.length > 0 else 1.0

    def at(self, way):
        """The point (x, y) of the path after this way, metres; beyond its end straight on."""
        begin, _, (x, y), (dx, dy) = self.legs[bisect.bisect([leg[0] for leg in self.legs[1:]], way)]
        return x + (way - begin) * dx, y + (way - begin) * dy

    def nearest(self, x, y):
        """The way (metres) to the point of the path that is nearest, from where the robot was on."""
        ways = []
        for begin, length, (ax, ay), (dx, dy) in self.legs:
            if begin + length >= self.way and begin <= self.way + self.WINDOW_M:
                way = begin + min(max((x - ax) * dx + (y - ay) * dy, 0.0), length)
                ways.append(max(way, self.way))
        return min(ways, key=lambda way: math.dist(self.at(way), (x, y)))

    def command(self, x, y, theta):
        """(vx, omega), m/s and rad/s, from this pose (metres, radians, the frame of the points); None at the end. DriveError where the
        tightest bend led past the last point."""
        if self.length - self.way > self.tolerance:
            self.way = self.nearest(x, y)
        left = self.length - self.way
        if left <= self.tolerance:
            self.way = self.length
            if self.least_radius > 0 and (off := math.dist((x, y), self.at(self.length))) > self.look_ahead / 2:
                raise DriveError(f"the way ends {off:.2f} m beside its last point: no tighter bend than of {self.least_radius:.2f} m")
            return None
        px, py = self.at(self.way + self.look_ahead)
        ahead = math.cos(theta) * (px - x) + math.sin(theta) * (py - y)
        aside = math.cos(theta) * (py - y) - math.sin(theta) * (px - x)
        bearing = math.atan2(aside, ahead)
        curvature = 2 * aside / (aside * aside + ahead * ahead)
        if abs(bearing) > 1.0:  # far aside or behind: turn on the spot, or as tightly as it can
            if self.least_radius <= 0:
                return 0.0, math.copysign(self.turn_rate, bearing)
            curvature = math.copysign(math.inf, bearing)
        if self.least_radius > 0:
            curvature = max(-1 / self.least_radius, min(curvature, 1 / self.least_radius))
        speed = min(self.speed, math.sqrt(2 * self.braking * left), self.turn_rate / max(abs(curvature), 1e-9))
        return speed, speed * curvature


def numbers(message, *names):
    """These members of a message; ValueError where one is no finite number."""
    found = {name: message[name] for name in names}
    if not all(isinstance(value, (int, float)) and math.isfinite(value) for value in found.values()):
        raise ValueError(f"expected numbers, found {found}")
    return found


def connect(program, host, port):
    """A connection to the daemon that this program is; DriveError says what to start where it is not there."""
    try:
        return Daemon(host, port)
    except OSError as error:
        raise DriveError(f"{program}: {error}. Start it, or name its address: drive.py --help") from error


class PoseTopic(threading.Thread):
    """The newest pose that a daemon publishes: `odometry` of the motor control or `pose` of a scan matcher."""

    def __init__(self, topic, host="127.0.0.1", port=7410):
        super().__init__(daemon=True)
        self.name = f"topic {topic} of {host}:{port}"
        self.source = "hermes-scanmatcher" if topic == "pose" else "hermes-motorcontrol", host, port
        self.connection = connect(*self.source)
        self.stream = self.connection.subscribe(topic, queue=1)
        self.connection.socket.settimeout(None)  # a topic may be silent for long
        self.newest = self.failure = None
        self.start()

    def run(self):
        try:
            for message in self.stream:
                data = message["data"]
                if message.get("replayed"):  # it was somewhere else then
                    continue
                if data.get("outcome", "matched") == "matched":  # a lost matcher only guesses
                    pose, twist = numbers(data.get("pose", data), "x", "y", "theta"), numbers(data["twist"], "vx", "vy", "omega")
                    self.newest = numbers(message, "stamp")["stamp"], pose, twist
        except OSError as error:
            self.failure = error
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            self.failure = f"cannot be read: {error!r}"

    def now(self):
        """(x, y, theta) at this moment, the last pose moved on by its twist; None when there is none or it is too old."""
        if self.failure:
            raise DriveError(f"{self.name}: {self.failure}")
        newest = self.newest
        if newest is None or abs(age := time.time() - newest[0]) > OLDEST_POSE_S:
            return None
        _, pose, twist = newest
        heading = pose["theta"] + twist["omega"] * age / 2
        return (pose["x"] + age * (math.cos(heading) * twist["vx"] - math.sin(heading) * twist["vy"]),
                pose["y"] + age * (math.sin(heading) * twist["vx"] + math.cos(heading) * twist["vy"]),
                pose["theta"] + twist["omega"] * age)

    def fault(self):
        """Why there is no pose, as far as its age and the health of the daemon tell it."""
        reasons = [f"the last one is {time.time() - self.newest[0]:.1f} s old"] if self.newest else []
        try:
            with connect(*self.source) as daemon:
                health = daemon.call("daemon.status")["health"]
            reasons += [f"{item['name']}: {item['message']}" for item in health if item["level"] != "ok"]
        except (DriveError, DaemonError, OSError, ValueError) as error:
            reasons.append(str(error))
        return "; ".join(reasons) or "its daemon says that all is well"


def send(motors, vx, omega):
    """False when the command came too late to be obeyed; the next one may be in time."""
    try:
        motors.call("motor.drive", vx=vx, omega=omega, stamp=time.time())
    except DaemonError as error:
        if error.code == NOT_READY and not error.data:  # with data: the emergency stop
            return False
        raise DriveError(error, motors.call("motor.state")["halted"]) from error
    return True


def stop(motors):
    """The robot stops and is free for others."""
    try:
        motors.call("motor.stop")
        motors.call("control.release")
    except (OSError, ValueError, DaemonError):
        motors.close()  # for the daemon that is a reason to stop, too


def drive(motors, poses, follower, name="drive.py", watch=lambda follower: None):
    """Drives along the follower's way points; back when the robot was told to stop at the last one. Whatever happens, the
    robot stops; DriveError tells why it did so early. `watch` is called after each command."""
    try:
        motors.call("control.acquire", client=name, timeout_s=CONTROL_S)
    except DaemonError as error:
        raise DriveError(error) from error
    try:
        fine = due = time.monotonic()
        while True:
            pose = poses.now()
            velocity = follower.command(*pose) if pose else (0.0, 0.0)
            if velocity is None:
                return
            obeyed = send(motors, *velocity)
            watch(follower)
            now = time.monotonic()
            fine = now if pose and obeyed else fine
            if now - fine > PATIENCE_S:
                raise DriveError(f"{poses.name}: no pose of the last {OLDEST_POSE_S} s: {poses.fault()}" if pose is None else
                                 "motor control: all commands come too late, or the clocks disagree")
            due = max(due + PERIOD_S, now)
            time.sleep(due - now)
    finally:
        stop(motors)


def address(text):
    host, _, port = text.rpartition(":")
    return host or "127.0.0.1", int(port)


def way_point(text):
    x, y = map(float, text.split(","))
    return x, y


def main():
    parser = argparse.ArgumentParser(prog="drive.py", description="Drives a robot along way points through hermes-motorcontrol; "
                                     "Ctrl-C stops it.")
    parser.add_argument("points", nargs="+", type=way_point, metavar="X,Y", help="way points; metres, in the frame of the odometry, or of the "
                        "map with --matcher. Put -- before them when the first begins with a minus")
    parser.add_argument("--motors", type=address, default=("127.0.0.1", 7410), metavar="HOST:PORT",
                        help="the motor control (127.0.0.1:7410)")
    parser.add_argument("--matcher", type=address, metavar="HOST:PORT",
                        help="follow the pose of this scan matcher instead of the odometry")
    parser.add_argument("--speed", type=float, default=0.5, help="largest speed, m/s (0.5)")
    parser.add_argument("--turn-rate", type=float, default=1.0, help="largest rate of turn, rad/s (1.0)")
    arguments = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        poses = PoseTopic("pose", *arguments.matcher) if arguments.matcher else PoseTopic("odometry", *arguments.motors)
        with connect("hermes-motorcontrol", *arguments.motors) as motors:
            deadline = time.monotonic() + PATIENCE_S
            while (here := poses.now()) is None:
                if time.monotonic() > deadline:
                    raise DriveError(f"{poses.name}: no pose comes: {poses.fault()}")
                time.sleep(PERIOD_S)
            radius = motors.call("motor.state").get("least_radius_m", 0.0)  # a base of one's own may not tell it
            drive(motors, poses, PathFollower([here, *arguments.points], arguments.speed, arguments.turn_rate, least_radius=radius))
            print("arrived")
    except KeyboardInterrupt:
        print("\ndrive.py: interrupted: the robot was told to stop.", file=sys.stderr)
        return 130
    except (DriveError, DaemonError, OSError, ValueError) as error:
        print(f"drive.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
