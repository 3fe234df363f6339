#!/usr/bin/env python3
"""The map of the scan matcher as hermes-ros2 tells it: walls as lines, and as cells beside free and unknown ones."""
import math
import unittest

from ros2_robot import SMALL, Ros2Case, compose, inverse, plane, pose_of, skip_without_programs
from support import wait_for

CELL_FREE, CELL_WALL, CELL_UNKNOWN = 0, 100, -1


class Maps(Ros2Case):
    """Of a robot that stands in a map that does not grow."""

    def test_map(self):
        self.robot.matcher.call("matcher.start", mode="localization")
        edges, peer, late = self.edges(), self.peer(), self.peer()
        self.assertGreater(len(edges), 4)
        peer.read("/map", "nav_msgs/OccupancyGrid", transient_local=True, depth=1)
        peer.read("/map_walls", "visualization_msgs/MarkerArray", transient_local=True, depth=1)
        peer.until("the edges as walls", lambda: same_walls(peer.messages("/map_walls"), edges))
        wrong = lambda: [Cells(grid).complaint(edges, self.sensor()) for grid in peer.messages("/map")[-1:]]  # noqa: E731
        try:
            wait_for("the edges as cells", lambda: wrong() == [None], 20)
        except AssertionError as error:
            raise AssertionError(f"{error}: {wrong()}") from None
        late.read("/map", "nav_msgs/OccupancyGrid")  # volatile, as RViz asks by default
        self.assertEqual(late.wait("/map")["data"], peer.messages("/map")[-1]["data"])
        self.assertEqual(peer.messages("/map")[-1]["header"]["frame_id"], "map")
        self.robot.matcher.call("map.clear")
        peer.until("no walls", lambda: same_walls(peer.messages("/map_walls"), []))
        peer.until("no cells", lambda: CELL_WALL not in peer.messages("/map")[-1]["data"])

    def edges(self):
        return [(edge["x1"], edge["y1"], edge["x2"], edge["y2"]) for edge in self.robot.matcher.call("map.get")["edges"]]

    def sensor(self):
        stream = self.robot.processes["scanmatcher"].connect()
        try:
            return pose_of(next(stream.subscribe("pose"))["data"])
        finally:
            stream.close()


def same_walls(arrays, edges):
    """What the markers show together are these edges: those of a name and number replace one another, and all can be deleted."""
    shown = {}
    for marker in [marker for array in arrays for marker in array["markers"]]:
        if marker["action"] == 3:
            shown.clear()
        elif marker["action"] == 2:
            shown.pop((marker["ns"], marker["id"]), None)
        else:
            assert (marker["type"], marker["header"]["frame_id"]) == (5, "map") and marker["scale"]["x"] > 0 and marker["color"]["a"] > 0
            shown[marker["ns"], marker["id"]] = marker["points"]
    points = [point for part in shown.values() for point in part]
    found = sorted((a["x"], a["y"], b["x"], b["y"]) for a, b in zip(points[::2], points[1::2]))
    return len(found) == len(edges) and all(max(abs(a - b) for a, b in zip(*two)) < SMALL for two in zip(found, sorted(edges)))


class Cells:
    """An occupancy grid beside the edges of which it was made."""

    def __init__(self, grid):
        info = grid["info"]
        self.data, self.size, self.width, self.height = grid["data"], info["resolution"], info["width"], info["height"]
        self.origin = plane(info["origin"]["position"], info["origin"]["orientation"])

    def cell(self, x, y):
        x, y, _ = compose(inverse(self.origin), (x, y, 0))
        return math.floor(x / self.size), math.floor(y / self.size)

    def middle(self, column, row):
        return compose(self.origin, ((column + 0.5) * self.size, (row + 0.5) * self.size, 0))[:2]

    def behind(self, sensor, column, row):
        """A place far behind a cell."""
        x, y = self.middle(column, row)
        return sensor[0] + 100 * (x - sensor[0]), sensor[1] + 100 * (y - sensor[1])

    def at(self, column, row):
        is_inside = 0 <= column < self.width and 0 <= row < self.height
        return self.data[row * self.width + column] if is_inside else CELL_UNKNOWN

    def complaint(self, edges, sensor):
        """What is wrong with it, or None."""
        if len(self.data) != self.width * self.height or not set(self.data) <= {CELL_FREE, CELL_WALL, CELL_UNKNOWN}:
            return f"{len(self.data)} cells of {self.width} x {self.height}: {set(self.data)}"
        around = [(i, k) for i in (-1, 0, 1) for k in (-1, 0, 1)]
        drawn, bare = set(), []
        for x1, y1, x2, y2 in edges:
            steps = 1 + int(2 * math.hypot(x2 - x1, y2 - y1) / self.size)
            for share in (k / steps for k in range(steps + 1)):
                column, row = self.cell(x1 + share * (x2 - x1), y1 + share * (y2 - y1))
                drawn.add((column, row))
                if not any(self.at(column + i, row + k) == CELL_WALL for i, k in around):
                    bare.append((x1, y1, x2, y2))
        near = {(column + i, row + k) for column, row in drawn for i, k in around}
        walls = {(i % self.width, i // self.width) for i, value in enumerate(self.data) if value == CELL_WALL}
        if bare or walls - near:
            return f"no cells of a wall at {bare[:3]}; {len(walls - near)} cells far from each edge: {sorted(walls - near)[:3]}"
        return self.wrongly_seen(edges, sensor, near)

    def wrongly_seen(self, edges, sensor, near):
        """What lies between a sensor that stands and a wall is free, what lies behind a wall is unknown."""
        hidden, seen, wrong_hidden, wrong_seen = 0, 0, [], []
        for column in range(0, self.width, 3):
            for row in range(0, self.height, 3):
                if (column, row) in near:
                    continue
                if any(crosses(sensor[:2], self.middle(column, row), edge) for edge in edges):
                    hidden += 1
                    wrong_hidden += [(column, row)] * (self.at(column, row) != CELL_UNKNOWN)
                elif any(crosses(self.middle(column, row), self.behind(sensor, column, row), edge) for edge in edges):
                    seen += 1
                    wrong_seen += [(column, row)] * (self.at(column, row) != CELL_FREE)
        if len(wrong_hidden) > 0.02 * hidden or len(wrong_seen) > 0.1 * seen:  # edges have gaps between them
            return (f"{len(wrong_hidden)} of {hidden} cells behind walls are not unknown, {len(wrong_seen)} of {seen} seen ones are not free: "
                    f"{wrong_hidden[:3]} {wrong_seen[:3]}")
        return None


def crosses(a, b, edge):
    """Whether the way from a to b leads through an edge."""
    side = lambda p, q, r: (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])  # noqa: E731
    c, d = edge[:2], edge[2:]
    return (side(a, b, c) > 0) != (side(a, b, d) > 0) and (side(c, d, a) > 0) != (side(c, d, b) > 0)


if __name__ == "__main__":
    skip_without_programs()
    unittest.main(verbosity=2)
