#!/usr/bin/env python3
"""Files that clients name, given to the running daemons: pipes, devices, /proc, links, names with NUL. Each is refused within a
second with the reason, nothing outside of the daemon's folder changes, the daemon goes on answering and ends when it is told to."""
import os
import socket
import stat
import sys
import tempfile
import time

from support import BINARIES, WORLD, Daemon, DaemonError, Process, free_port, put

INPUT_OUTPUT = -32008
MOST_S = 1.0  # to refuse
MOST_BYTES = 100e6  # of memory


def resident(process):
    with open(f"/proc/{process.pid}/status", encoding="utf-8") as status:
        return next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmRSS"))


def make_traps(folder):
    """What can stand in the way; gives the names."""
    os.mkfifo(os.path.join(folder, "pipe"))
    os.mkdir(os.path.join(folder, "folder"))
    os.symlink("/dev/zero", os.path.join(folder, "zero"))
    os.symlink("pipe", os.path.join(folder, "link to the pipe"))
    os.symlink("nothing", os.path.join(folder, "dangling"))
    with open(os.path.join(folder, "empty"), "wb"):
        pass
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(os.path.join(folder, "socket"))
    return [os.path.join(folder, name) for name in os.listdir(folder)] + [
        "/dev/zero", "/dev/stdin", "/dev/tty", "/proc/kmsg", "/proc/self/fd/0", "/proc/self/mem", "/proc/kcore", "",
        os.path.join(folder, "pipe") + "\0.csv", os.path.join(folder, "missing"), folder, "x" * 100000]


def refuse(daemon, process, method, expected, **params):
    begun = time.monotonic()
    try:
        result = daemon.call(method, **params)
    except DaemonError as error:
        took = time.monotonic() - begun
        assert error.code in expected, (method, params, error)
        assert took < MOST_S, f"{method} {params}: refused after {took:.1f} s"
        assert resident(process) < MOST_BYTES, f"{method} {params}: {resident(process)} bytes"
        return
    raise AssertionError(f"{method} {str(params)[:200]} gave {result}")


def started(name, folder, **settings):
    os.makedirs(os.path.join(folder, "log"), exist_ok=True)
    return Process(BINARIES, name, free_port(0), os.path.join(folder, "log"), settings)


def check_reading(folder, traps):
    lidar = free_port(0, socket.SOCK_DGRAM)
    for name, method, parameter, settings in (
            ("simulator", "sim.load", "world", {"world": WORLD, "lidar.port": lidar}),
            ("velodynelogger", "source.open", "pcap", {"source.port": free_port(0, socket.SOCK_DGRAM), "source.position_port": 0,
                                                       "record.folder": folder + "/records"}),
            ("scanmatcher", "map.load", "path", {"map.folder": folder})):
        process = started(name, folder, **settings)
        with process.connect() as daemon, Daemon(port=process.port) as other:
            for trap in traps:
                refuse(daemon, process.process, method, (INPUT_OUTPUT,), **{parameter: trap})
                assert other.call("daemon.info")["name"] == name
        begun = time.monotonic()
        assert process.stop() == 0 and time.monotonic() - begun < 3, f"{name} did not end"
        print(f"{name}: {len(traps)} files refused")


def everything(folder):
    """All that is there: kind, size, target."""
    found = {}
    for path, names, files in os.walk(folder):
        for name in names + files:
            full = os.path.join(path, name)
            status = os.lstat(full)
            found[full] = (stat.S_IFMT(status.st_mode), status.st_size, os.path.islink(full) and os.readlink(full))
    return found


def check_writing(folder, traps):
    maps, beside = os.path.join(folder, "maps"), os.path.join(folder, "beside")
    os.makedirs(maps)
    os.makedirs(beside)
    put(os.path.join(beside, "precious"), "all that there is")
    os.symlink("../beside/precious", os.path.join(maps, "link"))
    os.symlink("../beside", os.path.join(maps, "way out"))
    os.mkfifo(os.path.join(maps, "pipe"))
    process = started("scanmatcher", folder, **{"map.folder": maps})
    names = traps + ["link", "way out/new", "way out/precious", "pipe", "../new", "../beside/precious", "/dev/null",
                     beside + "/precious", "/proc/self/fd/2", "/proc/self/cwd/new", ".", "", "new\n", "a/b"]
    with process.connect() as matcher:
        log = process.log_name
        before = {path: what for path, what in everything(folder).items() if path != log}
        for name in names:
            for force in (False, True):
                refuse(matcher, process.process, "map.save", (INPUT_OUTPUT,), path=name, force=force)
                refuse(matcher, process.process, "map.export", (INPUT_OUTPUT,), path=name, force=force, format="svg")
        assert {path: what for path, what in everything(folder).items() if path != log} == before
        assert stat.S_ISCHR(os.stat("/dev/null").st_mode)
        for name in ("map.csv", maps + "/other.csv"):
            saved = matcher.call("map.save", path=name)
            assert os.path.dirname(saved["path"]) == maps and os.path.getsize(saved["path"]) == saved["bytes"]
        refuse(matcher, process.process, "map.save", (INPUT_OUTPUT,), path="map.csv")
        matcher.call("map.save", path="map.csv", force=True)
    assert process.stop() == 0
    print(f"scanmatcher: {len(names)} names not written")


def check_recordings(folder):
    """Folders of recordings in which pipes and links stand for what the loggers write."""
    records = os.path.join(folder, "records")
    sidecar = {"format": "hermes recording 1", "start": 1000, "end": 1001, "start_mono": 1, "end_mono": 2, "ended": "stopped",
               "complete": True}
    for name, content in (("velodynelogger", {"files": [{"name": "velodynelogger-0001.pcap", "bytes": 0}]}),
                          ("seriallogger", {"files": [{"name": "seriallogger-gps.raw", "port": "gps", "bytes": 0}]})):
        for kind in ("sidecar", "link", "data", "index"):
            os.makedirs(os.path.join(records, kind), exist_ok=True)
        os.mkfifo(os.path.join(records, "sidecar", name + ".json"))
        os.symlink("/dev/zero", os.path.join(records, "link", name + ".json"))
        for kind in ("data", "index"):
            put(os.path.join(records, kind, name + ".json"), {**sidecar, "logger": name, "name": kind, "session": kind, **content})
    os.mkfifo(os.path.join(records, "data", "velodynelogger-0001.pcap"))
    os.symlink("/dev/zero", os.path.join(records, "index", "velodynelogger-0001.pcap"))
    for kind, pipe, file in (("data", "raw", "index"), ("index", "index", "raw")):
        os.mkfifo(os.path.join(records, kind, "seriallogger-gps." + pipe))
        with open(os.path.join(records, kind, "seriallogger-gps." + file), "wb"):
            pass
    for name, settings in (("velodynelogger", {"source.port": free_port(0, socket.SOCK_DGRAM), "source.position_port": 0}),
                           ("seriallogger", {"ports": '[{"name": "gps", "url": "tcp://127.0.0.1:1"}]'})):
        process = started(name, folder, **settings, **{"record.folder": records, "record.free_floor_bytes": 0})
        with process.connect() as logger:
            assert {entry["name"] for entry in logger.call("record.list")} == {"sidecar", "link", "data", "index"}
            for kind in ("sidecar", "link", "data", "index"):
                refuse(logger, process.process, "source.open", (INPUT_OUTPUT,), recording=kind)
                if name == "seriallogger":
                    refuse(logger, process.process, "record.export", (INPUT_OUTPUT,), name=kind, port="gps")
            logger.call("record.start", name="good " + name)
            logger.call("record.stop")
        begun = time.monotonic()
        assert process.stop() == 0 and time.monotonic() - begun < 3, f"{name} did not end"
        print(f"{name}: recordings refused")


def check_allowed_folders(folder):
    """A robot that lets clients name files below one folder only."""
    allowed = os.path.join(folder, "allowed")
    os.mkdir(allowed)
    inside = os.path.join(allowed, "world.json")
    with open(WORLD, "rb") as world, open(inside, "wb") as copy:
        copy.write(world.read())
    process = started("simulator", folder, **{"files.folders": f'["{allowed}"]', "lidar.port": free_port(0, socket.SOCK_DGRAM)})
    with process.connect() as simulator:
        refuse(simulator, process.process, "sim.load", (INPUT_OUTPUT,), world=WORLD)
        simulator.call("settings.set", values={"files": {"folders": ["/"]}})  # has effect with the next start
        refuse(simulator, process.process, "sim.load", (INPUT_OUTPUT,), world=WORLD)
        simulator.call("sim.load", world=inside)
    assert process.stop() == 0


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as temporary:
        here = os.path.realpath(temporary)
        os.mkdir(os.path.join(here, "traps"))
        all_traps = make_traps(os.path.join(here, "traps"))
        check_reading(here, all_traps)
        check_writing(here, all_traps)
        check_recordings(here)
        check_allowed_folders(here)
    sys.exit(0)
