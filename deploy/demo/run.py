#!/usr/bin/env python3
"""Drives a simulated robot once through a world and lets the daemons build its vector map, or does the same from a log."""
import argparse
import bisect
import json
import math
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

from attendant import Attendant
from processes import Daemon, DaemonError, Process, free_port
from window import Window, has_display
from tour import CarefulFollower, FreeView, SteadyPoses
from drive import DriveError, PathFollower, PoseTopic, drive  # of docs/examples

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
WORLDS = os.path.join(ROOT, "deploy", "worlds")
MOST_STUCK_S = 90.0  # without getting on: the attendant may need a minute
BINARIES = os.environ.get("HERMES_BIN", os.path.join(ROOT, "build", "release", "bin"))


class Listener(threading.Thread):
    """Collects all messages of a topic."""

    def __init__(self, port, topic, queue):
        super().__init__(daemon=True)
        self.messages = []
        self.dropped = 0
        self.daemon_connection = Daemon(port=port, timeout=None)
        self.stream = self.daemon_connection.subscribe(topic, queue=queue)
        self.start()

    def run(self):
        try:
            for message in self.stream:
                self.dropped = message["dropped"]
                self.messages.append(message)
        except (OSError, ValueError):
            pass  # the daemon has ended


class Course:
    """How the demo drives through a room: way points followed as the map has them."""

    simulator = {"frame.slip": 0.03}  # that the odometry does not know of
    motors = {}
    records = True
    shows_all = False  # of the map, in the window

    def follower(self, way_points, ports):
        """What gives velocities, and the poses by which it does."""
        return PathFollower(way_points, 0.8), PoseTopic("pose", port=ports["scanmatcher"])


class Tour(Course):
    """How it drives through a building, where the map bends until loops are closed."""

    simulator = {"frame.slip": 0.04, "frame.slip_spread": 0.02, "lidar.max_range_m": 18}
    motors = {"motion.vx": 1.5}
    records = False  # half a gigabyte
    shows_all = True  # so that corrections are seen

    def follower(self, way_points, ports):
        path = PathFollower(way_points, 1.5, turn_rate=1.4, look_ahead=1.0)
        return CarefulFollower(path, FreeView(ports["velodynelogger"])), SteadyPoses(ports["scanmatcher"])


class Demo:
    """The five daemons and one drive."""

    def __init__(self, world, course, folder, logs):
        self.world, self.course = world, course
        lidar_port, motor_line = free_port(2368, socket.SOCK_DGRAM), os.path.join(logs, "motors")
        self.ports = {name: free_port(port) for name, port in
                      (("simulator", 7490), ("motorcontrol", 7410), ("velodynelogger", 7420), ("scanmatcher", 7450),
                       ("recorder", 7460))}
        self.processes = []
        try:
            # Who listens first, then what it listens to.
            self.start("scanmatcher", logs, {"source.address": f"127.0.0.1:{self.ports['velodynelogger']}",
                                             "odometry.address": f"127.0.0.1:{self.ports['motorcontrol']}",
                                             "map.folder": folder, "matcher.start": "nothing"})
            self.start("velodynelogger", logs, {"source.port": lidar_port, "record.folder": folder})
            self.start("simulator", logs, {"world": world, "lidar.port": lidar_port, "motors.link": motor_line,
                                           **course.simulator})
            line = f"serial://{motor_line}?baud=115200"
            self.start("motorcontrol", logs, {"controllers.1.url": line, "controllers.2.url": line, **course.motors})
            others = [f"127.0.0.1:{port}" for name, port in self.ports.items() if name != "recorder"]
            self.start("recorder", logs, {"daemons": json.dumps(others), "record.folder": folder})
            self.matcher, _, self.simulator, self.motors, self.recorder = [process.connect() for process in self.processes]
            self.attendant = Attendant(self.motors, self.simulator)
        except BaseException:
            self.stop()
            raise

    def start(self, name, logs, settings):
        print(f"  starting hermes-{name:<15} port {self.ports[name]}", flush=True)
        self.processes.append(Process(BINARIES, name, self.ports[name], logs, settings))

    def way_points(self):
        with open(self.world, encoding="utf-8") as file:  # the simulator has found it good
            points = json.load(file)["poses"]
        if len(points) < 2:
            raise RuntimeError(f"{self.world}: has no path: two poses or more expected")
        return points

    def drive(self):
        """One drive through the world; gives the messages of matcher, odometry and truth."""
        follower, steered_by = self.course.follower(self.way_points(), self.ports)
        start = self.simulator.call("sim.state")["pose"]
        self.wait(lambda: self.motors.call("motor.state")["ready"], "the motor controllers")
        self.motors.call("odometry.reset", **start)
        self.matcher.call("pose.set", **start)
        self.matcher.call("matcher.start", mode="mapping")  # not before: the first scan gives the map its frame
        poses = Listener(self.ports["scanmatcher"], "pose", 1000)
        odometry = Listener(self.ports["motorcontrol"], "odometry", 1000)
        truth = Listener(self.ports["simulator"], "truth", 1000)
        if self.course.records:
            self.wait(lambda: any("4 daemons" in one["message"] for one in self.recorder.call("daemon.status")["health"]),
                      "the recorder")
            self.recorder.call("session.start", name="recording")
        self.wait(lambda: poses.messages, "the first scan")
        self.follow(follower, steered_by, lambda follower: self.show(follower.progress, poses.messages))
        # A few scans more, taken standing still, then the end of the stream.
        self.wait(lambda: self.motors.call("motor.state")["twist"] == {"vx": 0, "vy": 0, "omega": 0}, "the standstill")
        seen = len(poses.messages)
        self.wait(lambda: len(poses.messages) >= seen + 5, "the last scans")
        self.recording = self.recorded() if self.course.records else None
        self.matcher.call("matcher.stop")
        self.wait(lambda: self.matcher.call("matcher.state")["waiting"] == 0, "the matcher")
        if sys.stderr.isatty():
            print(file=sys.stderr)
        return poses, odometry, truth

    def recorded(self):
        """Ends the recording."""
        told = self.recorder.call("session.stop")
        (lidar,) = (part for part in told["parts"] if part["daemon"] == "velodynelogger")
        return {"path": "recording", "bytes": told["bytes"], **lidar["counts"], "losses": lidar["losses"],
                "problems": told["problems"]}

    def follow(self, follower, steered_by, watch):
        """To the end of the path, with somebody beside the robot who helps it on."""
        onwards = watched(watch)
        while True:
            try:
                return drive(self.motors, steered_by, follower, "the demo", onwards)
            except DriveError as error:
                self.attendant.help(error)

    @staticmethod
    def show(progress, messages):
        if sys.stderr.isatty():
            bar = "#" * round(30 * progress)
            pose = messages[-1]["data"]
            print(f"\r  driving [{bar:<30}] {100 * progress:3.0f} %  {len(messages)} scans  "
                  f"x {pose['x']:6.2f} m  y {pose['y']:6.2f} m  {math.degrees(pose['theta']):6.1f} deg ",
                  end="", file=sys.stderr, flush=True)

    @staticmethod
    def wait(condition, what, limit_s=20.0):
        deadline = time.monotonic() + limit_s
        while not condition():
            if time.monotonic() > deadline:
                raise RuntimeError(f"waited {limit_s:.0f} s for {what}, which did not come")
            time.sleep(0.05)

    def save(self):
        self.matcher.call("map.save", path="map.csv")
        self.matcher.call("map.export", format="svg", path="map.svg")
        return self.matcher.call("matcher.state")

    def stop(self):
        """In order: first what drives, then the sources, then who listens to them."""
        return {process.name: process.stop() for process in reversed(self.processes)}


def watched(watch, limit_s=MOST_STUCK_S):
    """The watch of a drive, which ends one that does not come on: wheels may turn for ever on the spot."""
    best, since = -1.0, time.monotonic()

    def look(follower):
        nonlocal best, since
        if follower.progress > best:
            best, since = follower.progress, time.monotonic()
        elif time.monotonic() - since > limit_s:
            raise RuntimeError(f"the robot has not come on for {limit_s:.0f} s, with {100 * best:.0f} % of its path behind it: "
                               "something is in its way, or another sender disturbs its scans")
        watch(follower)
    return look


def pose_of(message):
    """Of the matcher's topic, of the odometry's, of the truth's."""
    return message["data"].get("pose", message["data"])


def true_pose(truth, stamps, stamp):
    """The true pose at a time, interpolated between two messages."""
    after = bisect.bisect(stamps, stamp)
    if after == 0 or after == len(truth):
        return None
    before, after = truth[after - 1], truth[after]
    k = (stamp - before["stamp"]) / max(1e-9, after["stamp"] - before["stamp"])
    a, b = pose_of(before), pose_of(after)
    turn = math.remainder(b["theta"] - a["theta"], 2 * math.pi)
    return a["x"] + k * (b["x"] - a["x"]), a["y"] + k * (b["y"] - a["y"]), a["theta"] + k * turn


def errors(poses, truth):
    """Position and heading error of every pose whose time the truth covers: [(metres, degrees)]."""
    result, stamps = [], [message["stamp"] for message in truth]
    for message in poses:
        real, pose = true_pose(truth, stamps, message["stamp"]), pose_of(message)
        if real:
            turn = math.remainder(pose["theta"] - real[2], 2 * math.pi)
            result.append((math.hypot(pose["x"] - real[0], pose["y"] - real[1]), abs(math.degrees(turn))))
    return result


def final_and_largest(name, deviations):
    """The members of the summary that tell how wrong the poses were."""
    return {f"final_{name}_m": deviations[-1][0], f"final_{name}_deg": deviations[-1][1],
            f"largest_{name}_m": max(d[0] for d in deviations), f"largest_{name}_deg": max(d[1] for d in deviations)}


def write_tum(path, poses):
    with open(path, "w", encoding="utf-8") as file:
        for message in poses:
            pose = pose_of(message)
            half = pose["theta"] / 2
            file.write(f"{message['stamp']:.6f} {pose['x']:.6f} {pose['y']:.6f} 0 0 0 "
                       f"{math.sin(half):.9f} {math.cos(half):.9f}\n")


def drive_world(world, course, folder, logs, with_window):
    """The demo without a log; gives the summary."""
    begin = time.monotonic()
    demo = Demo(world, course, folder, logs)
    window = None
    try:
        if with_window:
            window = Window(BINARIES, demo.ports.values(), logs, course.shows_all)
        poses, odometry, truth = demo.drive()
        state = demo.save()
        seconds = time.monotonic() - begin
        recorded = {"trajectory": poses.messages[:], "odometry": odometry.messages[:], "truth": truth.messages[:]}
        if window:
            demo.matcher.call("matcher.start", mode="mapping")
            window.stay("  The drive is over and its map is saved. Drive on by hand; close the window to end.")
    finally:
        if window:
            window.stop()
        statuses = demo.stop()
    for name, messages in recorded.items():
        write_tum(os.path.join(folder, name + ".tum"), messages)
    deviations = errors(recorded["trajectory"], recorded["truth"])
    drift = errors(recorded["odometry"], recorded["truth"])
    if not deviations or not drift:
        raise RuntimeError("no pose of matcher and odometry lies within the time of the simulator's truth")
    return {
        "world": os.path.basename(world), "scans": state["scans"], "matched": state["matched"], "lost": state["lost"],
        "skipped": state["skipped"], "dropped": state["dropped"] + state["dropped_by_source"] + poses.dropped,
        "by_odometry": state["by_odometry"], "ms_per_scan": state["ms_per_scan"], "map_segments": state["map_segments"],
        **final_and_largest("error", deviations), **final_and_largest("drift", drift),
        **{name: state[name] for name in ("closures", "corrections") if name in state},
        "touched": sum(message["data"]["touching"] for message in recorded["truth"]),
        "pauses": demo.attendant.pauses, "releases": demo.attendant.releases, "recording": demo.recording,
        "exit_status": statuses, "seconds": seconds}


def map_log(log, corrected, folder):
    """The demo from a log: hermes-vector does the same work without daemons; gives the summary."""
    command = [os.path.join(BINARIES, "hermes-vector"), "map", log, "--out-map", os.path.join(folder, "map.csv"),
               "--svg", os.path.join(folder, "map.svg"), "--out-trajectory", os.path.join(folder, "trajectory.tum"),
               "--summary", os.path.join(folder, "summary.json")] + (["--corrected"] if corrected else [])
    status = subprocess.run(command, stdin=subprocess.DEVNULL, check=False).returncode
    if status != 0:
        sys.exit(status)
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    reference = summary.get("reference", {})
    return {**summary, "ms_per_scan": sum(summary["ms_per_scan"].values()), "map_segments": summary["segments"],
            "dropped": 0, "final_error_m": reference.get("final_drift_m"),
            "final_error_deg": reference.get("final_drift_deg")}


def table(summary):
    rows = [(name, f"{summary[member]}") for name, member in
            (("scans", "scans"), ("matched", "matched"), ("by odometry", "by_odometry"), ("lost", "lost"),
             ("dropped", "dropped")) if member in summary]
    rows += [("time a scan", f"{summary['ms_per_scan']:.2f} ms"), ("map segments", f"{summary['map_segments']}")]
    rows += [(name, f"{100 * summary[member + '_m']:.1f} cm, {summary[member + '_deg']:.2f} deg") for name, member in
             (("final error", "final_error"), ("largest error", "largest_error"), ("final drift", "final_drift"),
              ("largest drift", "largest_drift")) if summary.get(member + "_m") is not None]
    rows += [(name, f"{summary[member]}") for name, member in
             (("loops closed", "closures"), ("wall touched", "touched"), ("pauses", "pauses"),
              ("releases", "releases")) if summary.get(member)]
    rows.append(("seconds", f"{summary['seconds']:.1f}"))
    return "\n".join(f"  {name:<14}{value:>22}" for name, value in rows)


def replace(folder, target):
    """Puts the finished results where those of the last run were, without the locks of the daemons."""
    for name in os.listdir(folder):
        if name.startswith("."):
            os.remove(os.path.join(folder, name))
    if os.path.exists(target):
        shutil.rmtree(target)
    shutil.move(folder, target)


def keep_logs(work):
    """Leaves nothing else in the folder, and gives its name."""
    for entry in os.scandir(work):
        if entry.is_dir():
            shutil.rmtree(entry.path)
        elif not entry.name.endswith(".log"):
            os.remove(entry.path)
    return work


def main():
    parser = argparse.ArgumentParser(
        prog="./demo", description="Starts simulator, motor control, Velodyne logger, scan matcher and recorder as processes of their own, "
        "drives once through a world as any client would, and leaves map, trajectories, recording and summary in demo-out/.")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--log", metavar="FILE", help="map a CARMEN log (also .gz) or an HDL-32E capture instead")
    what.add_argument("--tour", action="store_true", help="drive for five minutes through an office floor with two loops and "
                      "people, on wheels that slip each by itself")
    parser.add_argument("--corrected", action="store_true", help="the log's scan poses are a corrected reference")
    parser.add_argument("--world", metavar="FILE", help="world to drive through (pillars; with --tour: tour)")
    parser.add_argument("--out", default=os.path.join(ROOT, "demo-out"), metavar="FOLDER",
                        help="where the results go (demo-out); replaced when it holds earlier results")
    parser.add_argument("--no-window", action="store_true",
                        help="stay without the operator's window, which opens where there is a display")
    arguments = parser.parse_args()
    course = Tour() if arguments.tour else Course()
    world = arguments.world or os.path.join(WORLDS, "tour.json" if arguments.tour else "pillars.json")
    if os.path.exists(arguments.out) and not os.path.exists(os.path.join(arguments.out, "summary.json")) \
            and os.listdir(arguments.out):
        parser.error(f"--out {arguments.out}: holds other things than results of the demo")
    for name, value in (("--log", arguments.log), ("--world", arguments.world)):
        if value is not None and not os.path.isfile(value):
            parser.error(f"{name} {value}: no such file")

    # From here on a signal to end becomes an exception, so that everything is stopped in order.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    work = tempfile.mkdtemp(prefix="hermes-demo-")
    os.environ["XDG_STATE_HOME"] = work  # of a robot that is new each time: an earlier emergency stop is none of it
    has_failed = False
    try:
        results = os.path.join(work, "results")
        os.mkdir(results)
        if arguments.log:
            summary = map_log(os.path.abspath(arguments.log), arguments.corrected, results)
        else:
            with_window = has_display() and not arguments.no_window
            summary = drive_world(os.path.abspath(world), course, results, work, with_window)
        with open(os.path.join(results, "summary.json"), "w", encoding="utf-8") as file:
            json.dump(summary, file, indent=2)
            file.write("\n")
        replace(results, arguments.out)
    except KeyboardInterrupt:
        print("\nInterrupted: all daemons are stopped, nothing was written.", file=sys.stderr)
        return 130
    except (RuntimeError, DriveError, DaemonError, OSError) as error:
        print(f"\ndemo: {error}", file=sys.stderr)
        has_failed = True
    finally:
        if not has_failed:
            shutil.rmtree(work, ignore_errors=True)
    if has_failed:
        print(f"  logs of the daemons in {keep_logs(work)}", file=sys.stderr)
        return 1
    print(table(summary))
    print(f"  results in {os.path.relpath(arguments.out)}: {', '.join(sorted(os.listdir(arguments.out)))}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
