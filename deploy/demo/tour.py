"""What lets a robot follow a long path by a map that still bends: only where its lidar sees free floor, and without leaping when
the map is corrected."""
import itertools
import math
import threading
import time

from processes import Daemon
from drive import DriveError, PoseTopic  # of docs/examples

OLDEST_SCAN_S = 0.5  # an older one shows no free floor
SECTORS = 90  # of a turn, each with its nearest point
SIGHT_M = 3.0  # farther points are no obstacle yet
ROOM_M = 0.9  # kept between the robot's centre and what it passes, where there is so much
OUTLINE_M = 0.4  # of the robot, with a margin: where it brakes for what is ahead
ROBOT_M = 0.3  # its outline; nothing may be nearer
NEEDED_M = 1.0  # of free floor in a direction that is taken
# From the wanted direction: first the small ones, for each point ahead, then the large ones, round a corner that is not where
# the map has it.
TURNS = [[sign * math.radians(angle) for angle in angles for sign in (1, -1)] for angles in (range(0, 61, 5), range(65, 96, 5))]
LOOK_AHEAD_M = (1.0, 2.0, 3.0, 4.0)  # the farther ones where the map is wrong by so much that the path leads into a wall
SLOW_MPS, NARROW_PS = 0.3, 4.0  # where things are near: at OUTLINE_M, and how much faster a metre farther
AWAY_RAD_PER_M = 0.8  # how it turns from what is nearer than ROOM_M
REACTION_S = 0.3  # from the firing to the wheels
PATIENCE_S = 20.0  # with people in the way
PAUSE_S = 1.0  # without being asked for a command: the robot was stopped, and the patience is for the time that it drives


class FreeView(threading.Thread):
    """The floor around the robot that the newest scan shows free. The lidar stands at the robot's centre and looks ahead."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.stream = Daemon(port=port).subscribe("scan2d", queue=1)
        self.newest = None
        self.start()

    def run(self):
        try:
            for message in self.stream:
                data = message["data"]
                if not data["partial"]:
                    self.newest = data["stamp"] + data["duration_s"], obstacles(data["x"], data["y"])
        except (OSError, ValueError, KeyError):
            self.newest = None  # nothing is free any more

    def obstacles(self):
        """[(x, y)] in the robot's frame; None when the scan is too old."""
        newest = self.newest
        return newest[1] if newest and abs(time.time() - newest[0]) < OLDEST_SCAN_S else None


def obstacles(xs, ys):
    """The nearest point of each sector that is in sight."""
    nearest = [(SIGHT_M, None)] * SECTORS
    for x, y in zip(xs, ys):
        distance = math.hypot(x, y)
        sector = int((math.atan2(y, x) / (2 * math.pi) + 0.5) * SECTORS) % SECTORS
        if distance < nearest[sector][0]:
            nearest[sector] = distance, (x, y)
    return [point for _, point in nearest if point]


def free_way(points, direction, room):
    """How far the robot can go in a direction before a point is nearer than `room`; metres, at most SIGHT_M. A point that is
    nearer already is no obstacle on the way away from it."""
    c, s = math.cos(direction), math.sin(direction)
    free = SIGHT_M
    for x, y in points:
        along, aside = c * x + s * y, abs(c * y - s * x)
        if along > 0 and aside < room:
            free = min(free, max(0.0, along - math.sqrt(room * room - aside * aside)))
    return free


class CarefulFollower:
    """Follows a path as far as the lidar sees free floor: turns towards the free direction that is next to the wanted one, brakes
    before what stands ahead, and stands where nothing is free or no scan comes."""

    def __init__(self, path, view):
        self.path, self.view = path, view
        self.furthest, self.advanced = 0.0, time.monotonic()  # on the path, and when
        self.asked = self.advanced  # for a command, the last time

    @property
    def progress(self):
        return self.path.progress

    def command(self, x, y, theta):
        """(vx, omega) from this pose, or None at the end."""
        wanted, points, now = self.path.command(x, y, theta), self.view.obstacles(), time.monotonic()
        if wanted is None:
            return None
        if self.path.way > self.furthest:
            self.furthest, self.advanced = self.path.way, now
        if now - self.asked > PAUSE_S:
            self.advanced += now - self.asked
        self.asked = now
        if now - self.advanced > PATIENCE_S:
            raise DriveError(f"no way forward for {PATIENCE_S:.0f} s: the lidar shows no free floor where the path leads")
        bearing = self.free_bearing(x, y, theta, points) if points is not None else None
        return (0.0, 0.0) if bearing is None else self.towards(bearing, wanted[0], points)

    def free_bearing(self, x, y, theta, points):
        """The free direction next to that of a point ahead on the path, the nearest point that has one. Where the robot is too
        near to something, it goes past that and away from it."""
        distance, side = min(((math.hypot(*point), point[1]) for point in points), default=(SIGHT_M, 0.0))
        room = min(ROOM_M, max(ROBOT_M, 0.98 * distance))
        away = math.copysign(AWAY_RAD_PER_M * (ROOM_M - room), -side)
        for turns, ahead in itertools.product(TURNS, LOOK_AHEAD_M):
            px, py = self.path.at(self.path.way + ahead)
            bearing = math.atan2(py - y, px - x) - theta + away
            needed = min(NEEDED_M, math.dist((px, py), (x, y)))
            for turn in turns:
                if free_way(points, bearing + turn, room) >= needed:
                    return math.remainder(bearing + turn, 2 * math.pi)
        return None

    def towards(self, bearing, speed, points):
        """The velocity that turns to a free direction, at most as fast as the robot can stop before what is ahead."""
        if abs(bearing) > 1.0:
            return 0.0, math.copysign(self.path.turn_rate, bearing)
        curvature = 2 * math.sin(bearing) / LOOK_AHEAD_M[0]
        nearest = min((math.hypot(*point) for point in points), default=SIGHT_M)
        outline = min(OUTLINE_M, max(ROBOT_M, 0.98 * nearest))
        ahead = min(free_way(points, 0.0, outline), free_way(points, bearing / 2, outline))
        braking = self.path.braking
        stopping = math.sqrt((braking * REACTION_S) ** 2 + 2 * braking * ahead) - braking * REACTION_S
        speed = min(speed or self.path.speed, max(SLOW_MPS, NARROW_PS * (nearest - OUTLINE_M)),
                    self.path.turn_rate / max(abs(curvature), 1e-9))
        return min(speed, stopping), speed * curvature  # it turns on where it may not go on


class SteadyPoses(PoseTopic):
    """The matcher's pose without its leaps. When the map is corrected the pose jumps; what is steered by goes on from where it
    was and takes the correction over bit by bit, so that the robot swings back to its path."""

    LEAP_M, LEAP_RAD = 0.15, 0.1  # more than one match mends
    FADING_S = 1.5  # in which what is left of a correction sinks to a third

    def __init__(self, port):
        self.left = (0.0, 0.0, 0.0)  # of the corrections, not yet taken over
        self.told = self.told_at = self.stamp = None
        super().__init__("pose", port=port)

    def now(self):
        """(x, y, theta) to steer by; None when there is none or it is too old."""
        told, newest, now = super().now(), self.newest, time.monotonic()
        if told is None:
            self.told = None
            return None
        if self.told is not None and now - self.told_at > self.FADING_S:
            self.left, self.told = (0.0, 0.0, 0.0), None  # nobody asked while the robot was held
        if self.told is not None:
            passed = now - self.told_at
            self.left = tuple(part * math.exp(-passed / self.FADING_S) for part in self.left)
            self.take(told, passed, *newest)
        self.told, self.told_at = told, now
        return tuple(place + part for place, part in zip(told, self.left))

    def take(self, told, passed, stamp, pose, twist):
        """Keeps back what the velocity does not explain, if the pose was corrected or has leapt."""
        x, y, theta = self.told
        heading = theta + twist["omega"] * passed / 2
        leap = (told[0] - x - passed * (math.cos(heading) * twist["vx"] - math.sin(heading) * twist["vy"]),
                told[1] - y - passed * (math.sin(heading) * twist["vx"] + math.cos(heading) * twist["vy"]),
                math.remainder(told[2] - theta - twist["omega"] * passed, 2 * math.pi))
        corrected = pose.get("corrected", False) and stamp != self.stamp
        self.stamp = stamp
        if corrected or math.hypot(*leap[:2]) > self.LEAP_M or abs(leap[2]) > self.LEAP_RAD:
            self.left = tuple(part - step for part, step in zip(self.left, leap))
