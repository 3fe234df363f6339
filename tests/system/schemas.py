#!/usr/bin/env python3
"""Every message of every topic and every result of every command of all daemons is what the daemon's own schemas say, while a
robot drives and all is recorded; judged by python3-jsonschema. No schema says just "object" or "array"."""
import json
import os
import socket
import sys
import tempfile
import threading

from support import BINARIES, SOURCE, WORLD, Daemon, DaemonError, Process, free_port, put, wait_for

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema is not installed")
    sys.exit(77)

SCANS = 80  # of the drive


class Judge:
    """Checks values against schemas and counts what it saw."""

    def __init__(self):
        self.validators = {}
        self.seen = {}
        self.faults = []

    def declare(self, name, schema):
        self.look(name, schema)
        jsonschema.Draft202012Validator.check_schema(schema)
        self.validators[name] = jsonschema.Draft202012Validator(schema)

    def look(self, path, schema):
        """Complains of parts that say nothing, but for those declared open."""
        if schema.get("x-open") or "enum" in schema or "const" in schema:
            return
        for kind in ("anyOf", "oneOf"):
            if kind in schema:
                for i, part in enumerate(schema[kind]):
                    self.look(f"{path}.{kind}[{i}]", part)
                return
        types = schema.get("type")
        if not types:
            self.faults.append(f"{path}: a schema without a type")
            return
        if "array" in types:
            if isinstance(schema.get("items"), dict):
                self.look(path + "[]", schema["items"])
            else:
                self.faults.append(f"{path}: a bare array")
        if "object" in types:
            additional = schema.get("additionalProperties", True)
            if isinstance(additional, dict):
                self.look(path + ".*", additional)
            elif additional:
                self.faults.append(f"{path}: an open object that is not declared so")
            for name, part in schema.get("properties", {}).items():
                self.look(f"{path}.{name}", part)

    def check(self, name, value):
        self.seen[name] = self.seen.get(name, 0) + 1
        error = jsonschema.exceptions.best_match(self.validators[name].iter_errors(value))
        if error and len(self.faults) < 200:
            self.faults.append(f"{name}: {error.json_path}: {error.message[:300]}")


class Watcher(threading.Thread):
    """Follows all topics of a daemon over one connection."""

    def __init__(self, judge, name, port, topics):
        super().__init__(daemon=True)
        self.judge, self.name = judge, name
        self.daemon_connection = Daemon(port=port, timeout=None)  # a log may be silent for minutes
        self.ids = {self.daemon_connection.call("topics.subscribe", topic=topic, queue=100)["subscription"]: topic
                    for topic in topics}

    def run(self):
        while True:
            try:
                self.daemon_connection._receive()
            except OSError:
                return  # the daemon has ended
            for subscription, topic in self.ids.items():
                queue = self.daemon_connection.topics[subscription]
                while queue:
                    self.judge.check(f"{self.name} topic {topic}", queue.popleft()["data"])


def start_all(folder, processes):
    """Port by name: as in the demo, the GPS of the simulated robot recorded."""
    lidar, motors, gps = free_port(0, socket.SOCK_DGRAM), os.path.join(folder, "motors"), os.path.join(folder, "gps")
    ports = {}

    def start(name, settings):
        config = os.path.join(folder, name + "-settings.json")
        put(config, "{}")
        processes.append(Process(BINARIES, name, free_port(0), folder, settings, ["--config", config]))
        ports[name] = processes[-1].port

    start("velodynelogger", {"source.port": lidar, "record.folder": folder})
    start("simulator", {"world": WORLD, "lidar.port": lidar, "motors.link": motors, "gps.link": gps})
    line = f"serial://{motors}?baud=115200"
    start("motorcontrol", {"controllers.1.url": line, "controllers.2.url": line})
    start("scanmatcher", {"source.address": f"127.0.0.1:{ports['velodynelogger']}", "map.folder": folder,
                          "odometry.address": f"127.0.0.1:{ports['motorcontrol']}"})
    start("seriallogger", {"record.folder": folder,
                           "ports": json.dumps([{"name": "gps", "url": f"serial://{gps}?baud=9600", "view": "nmea"}])})
    start("softwaretrigger", {})
    os.mkdir(os.path.join(folder, "etc"))
    start("supervisor", {"processes": "[]", "setup.folder": os.path.join(folder, "etc"), "setup.lidar_port": free_port(0, socket.SOCK_DGRAM),
                         "setup.position_port": free_port(0, socket.SOCK_DGRAM),
                         "setup.samples": os.path.join(SOURCE, "deploy", "settings"), "setup.ports": json.dumps([motors])})
    return ports


SIDE = [i / 20 for i in range(-40, 41)]
CORNER = {"x": SIDE + [2.0] * 81, "y": [-2.0] * 81 + SIDE}


def script(ports):
    """(daemon, method, parameters) of all commands; some more than once, in other states."""
    logger = f"127.0.0.1:{ports['velodynelogger']}"
    trigger = {"id": "tick", "when": {"kind": "period", "period_s": 0.5},
               "actions": [{"do": "call", "daemon": logger, "method": "daemon.info"}]}

    def each(name, *calls):
        return [(name, method, params) for method, params in calls]

    for name in ports:
        yield from each(name, *((method, {}) for method in ("rpc.discover", "daemon.info", "daemon.status", "settings.schema",
                                                            "settings.get", "topics.list", "log.tail")))
        yield from each(name, ("settings.set", {"values": {"limits": {"clients": 17}}}),
                        ("settings.reset", {"paths": ["limits.clients"]}), ("settings.save", {}), ("log.tail", {}),
                        ("topics.subscribe", {"topic": "log"}), ("topics.unsubscribe", {"subscription": None}),
                        ("topics.replay", {"topic": "log", "live": True}))
    yield from each("softwaretrigger", ("trigger.define", trigger), ("trigger.list", {}), ("trigger.fire", {"id": "tick"}))
    for name in ("velodynelogger", "seriallogger"):
        yield from each(name, ("record.start", {"name": "drive", "session": "one"}), ("record.status", {}))
    yield from each("seriallogger", ("ports.list", {}), ("mark", {"text": "here"}), ("send", {"port": "gps", "text": "x"}))
    yield from each("motorcontrol", ("control.acquire", {"timeout_s": 10}), ("control.ask", {}), ("control.state", {}), ("motor.state", {}),
                    ("motor.drive", {"vx": 0.2}), ("motor.wheels", {"front_left": 0.1}), ("motor.stop", {"wait_s": 1}))
    yield "velodynelogger", "capture.turn", {"name": "turn"}
    yield from each("simulator", ("sim.drive", {"restart": True}), ("sim.state", {}), ("sim.noise", {"sigma_m": 0.01}))
    yield None, "pause", {}
    yield from each("scanmatcher", ("matcher.state", {}), ("map.get", {}), ("map.save", {"path": "m.csv"}),
                    ("map.export", {"path": "m.svg", "format": "svg"}), ("pose.relocalize", {}),
                    ("matcher.match", {"reference": CORNER, "current": CORNER}), ("matcher.stop", {}),
                    ("map.load", {"path": "m.csv"}), ("map.list", {}), ("map.clear", {}), ("map.undo", {}), ("matcher.start", {}),
                    ("pose.set", {"x": 0, "y": 0, "theta": 0}))
    yield from each("simulator", ("sim.halt", {}), ("sim.fault", {"device": "lidar", "kind": "none"}), ("sim.load", {"world": WORLD}),
                    ("sim.place", {"x": 0, "y": 0, "theta": 0}), ("sim.state", {}))
    yield from each("motorcontrol", ("motor.reset_estop", {}), ("motor.estop", {}), ("odometry.reset", {}), ("control.release", {}))
    for name in ("velodynelogger", "seriallogger"):
        yield from each(name, ("record.stop", {}), ("record.list", {}), ("source.open", {"recording": "drive", "paused": True}),
                        ("source.status", {}), ("source.seek", {"t_s": 1}), ("source.speed", {"speed": 0.5}),
                        ("source.pause", {"paused": False}))
    yield from each("seriallogger", ("record.marks", {"name": "drive"}))
    yield from each("velodynelogger", ("source.close", {}))
    yield "seriallogger", "record.export", {"name": "drive", "port": "gps"}
    yield from each("softwaretrigger", *((method, {"id": "tick"}) for method in ("trigger.disarm", "trigger.arm", "trigger.remove")))
    sleeper = {"name": "sleeper"}
    yield from each("supervisor", ("process.add", {**sleeper, "program": "sleep", "arguments": ["100"], "port": free_port(0)}),
                    ("process.start", sleeper), ("process.list", {}), ("process.output", sleeper), ("process.restart", sleeper),
                    ("process.stop", sleeper), ("process.remove", sleeper), ("setup.samples", {}), ("setup.find", {}),
                    ("setup.propose", {"sample": "simulator"}), ("setup.apply", {"settings": {"softwaretrigger": {}}}), ("setup.undo", {}))
    yield from ((name, "daemon.shutdown", {}) for name in ports)


def declare_all(judge, name, daemon):
    """The names of what is to be seen."""
    judge.declare(f"{name} settings", daemon.call("settings.schema"))
    wanted = {f"{name} settings"}
    for method in daemon.call("rpc.discover")["methods"]:
        for param in method["params"]:
            judge.look(f"{name} {method['name']} parameter {param['name']}", param["schema"])
        judge.declare(f"{name} {method['name']}", method["result"]["schema"])
        wanted.add(f"{name} {method['name']}")
    for topic in daemon.call("topics.list"):
        judge.declare(f"{name} topic {topic['name']}", topic["schema"])
        wanted.add(f"{name} topic {topic['name']}")
    return wanted


def call(daemon, method, params):
    """The world has places that look alike: there the robot goes on until it knows where it is."""
    if method != "pose.relocalize":
        return daemon.call(method, **params)

    def found():
        try:
            return daemon.call(method, **params)
        except DaemonError as error:
            return None if error.code == -32005 else sys.exit(f"{method}: {error}")

    return wait_for("a place that is like no other", found)


def call_all(judge, ports, daemons):
    subscription = None
    for name, method, params in script(ports):
        if method == "pause":
            wait_for("a drive", lambda: judge.seen.get("scanmatcher topic scan", 0) >= SCANS)
            continue
        if "subscription" in params:
            params = {"subscription": subscription}
        try:
            result = call(daemons[name], method, params)
        except DaemonError as error:
            judge.faults.append(f"{name} {method} {str(params)[:100]}: {error}")
            continue
        judge.check(f"{name} {method}", result)
        if method == "settings.get":
            judge.check(f"{name} settings", result)
        if method == "topics.subscribe":
            subscription = result["subscription"]


def main():
    judge, processes, wanted, watchers = Judge(), [], set(), []
    with tempfile.TemporaryDirectory() as folder:
        try:
            ports = start_all(folder, processes)
            daemons = dict(zip(ports, [process.connect() for process in processes]))
            for name, daemon in daemons.items():
                wanted |= declare_all(judge, name, daemon)
                names = {topic["name"] for topic in daemon.call("topics.list")}
                # Clouds leave no room for others; the last words are of the log.
                for some in filter(None, (names & {"cloud"}, names & {"log"}, names - {"cloud", "log"})):
                    watchers.append(Watcher(judge, name, ports[name], some))
                    watchers[-1].start()
            wait_for("the controllers", lambda: daemons["motorcontrol"].call("motor.state")["ready"])
            call_all(judge, ports, daemons)
            for watcher in watchers:  # until the last words
                watcher.join()
        finally:
            for process in processes:
                process.stop()
    judge.faults += [f"{name}: was not seen" for name in wanted - set(judge.seen)]
    if judge.faults:
        sys.exit("\n".join(sorted(set(judge.faults))))
    topics = [count for name, count in judge.seen.items() if " topic " in name]
    print(f"{sum(topics)} messages of {len(topics)} topics and {sum(judge.seen.values()) - sum(topics)} results of "
          f"{len(judge.seen) - len(topics)} commands are as their schemas say")


if __name__ == "__main__":
    main()
