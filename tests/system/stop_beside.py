#!/usr/bin/env python3
"""A stop beside all that may befall a daemon at once: behind a reply of 1 MB on its own connection, beside clients that repeat the
dearest command and clients that flood, on a full disk, over TCP, the Unix socket and TLS. HERMES_TRIALS stops (8) of each kind, by
motor.stop: it goes the way of motor.estop, and the robot may drive again at once. Two times are taken, both from before the stop is
sent: until its reply has come, and until both controllers were told to stand, as seen on their line."""
import contextlib
import ctypes
import json
import math
import os
import socket
import subprocess
import sys
import tempfile
import threading
import time

from stop_ends import Caller, Tap
from stop_traffic import LIMIT_S, batch, figures, hold, line, measure, others, pump, request, set_niceness
from support import BINARIES, BUILD, Daemon, DaemonError, Process, free_port, simulated_hall, small_disk, wait_for, put, text_of
from tls import context_of, issued, keys

TRIALS = int(os.environ.get("HERMES_TRIALS", "8"))
SHARE = 0.99 if TRIALS >= 100 else 0.75  # a few trials say little about the last percent
DISCOVERS = 33  # descriptions of 32 kB: 1 MB
LARGE_BYTES = 800000
SPEED, SLOW_BYTES_S = 0.05, 4e6
INPUT_OUTPUT = -32008
CANDIDATES = {"rpc.discover": {}, "settings.schema": {}, "settings.get": {}, "topics.list": {}, "daemon.status": {}, "motor.state": {},
              "log.tail": {"count": 1000}}


class Stand:
    """The simulator, the motor control, and a client that drives."""

    def __init__(self, folder, stack, disk=None):
        self.folder, self.keys = folder, os.path.join(folder, "keys")
        keys(self.keys, "init")
        for name, role in (("robot", "daemon"), ("eva", "engineer")):
            keys(self.keys, "issue", name, "--role", role)
        simulated, link = simulated_hall(folder)
        stack.callback(simulated.stop)
        simulated.connect().close()
        self.tap = Tap(link)
        self.config = os.path.join(disk or folder, "motorcontrol.json")
        put(self.config, "{}")
        self.port, self.tls_port = free_port(0), free_port(0)
        robot = issued(self.keys, "robot").replace(" ", "%20")
        self.process = Process(BINARIES, "motorcontrol", self.port, disk or folder,
                               {"controllers.1.url": self.tap.url, "controllers.2.url": self.tap.url, "log.records": 10000,
                                "safety.command_timeout_s": 1, "limits.clients": 40},
                               ["--config", self.config, "--listen", f"tls://127.0.0.1:{self.tls_port}?keys={robot}"])
        stack.callback(self.process.stop)
        self.driver = stack.enter_context(self.process.connect())
        wait_for("readiness", lambda: self.driver.call("motor.state")["ready"])
        self.direction = 1

    def caller(self, carrier, receive_bytes=None):
        if carrier == "Unix socket":
            connection = socket.socket(socket.AF_UNIX)
            connection.connect(f"\0hermes:127.0.0.1:{self.port}")
        else:
            connection = socket.socket()
            if receive_bytes:
                connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
            connection.connect(("127.0.0.1", self.tls_port if carrier == "TLS" else self.port))
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            if carrier == "TLS":
                connection = context_of(issued(self.keys, "eva")).wrap_socket(connection)
        connection.settimeout(10)
        return Caller(connection)

    def drive(self):
        """Until both controllers were told to turn; the commands are as old as one round of calls at most."""
        def moves():
            try:
                self.driver.call("motor.drive", vx=self.direction * SPEED)
            except DaemonError:  # it brakes still, or another's stop has taken the control
                self.driver.call("control.acquire", client="driver", timeout_s=30)
            return all(self.tap.moves.values())
        self.direction = -self.direction
        wait_for("motion", moves, 10)

    def told_zero(self, since):
        wait_for("set-points of zero", lambda: not any(self.tap.moves.values()), 5)
        assert self.tap.zero_since >= since, "it stood before"
        return self.tap.zero_since - since


# What is under way on the connection of the stop: what is asked for before, how many lines answer it, how fast the client reads.
DISCOVER = [request("rpc.discover", i) for i in range(DISCOVERS)]
AHEAD = {
    "nothing": ([], 0, math.inf),
    "a batch of 1 MB": ([DISCOVER], 1, math.inf),
    "two batches of 1 MB, one after the other": ([DISCOVER, DISCOVER], 2, math.inf),
    "33 replies of 32 kB": (DISCOVER, DISCOVERS, math.inf),
    "the log, 1 MB": ([request("log.tail", count=6500)], 1, math.inf),
    "a batch of 1 MB, read at 4 MB/s": ([DISCOVER], 1, SLOW_BYTES_S),
    "a batch of 1 MB, unread": ([DISCOVER], 1, 0),
}


def stop_behind(stand, caller, asked, lines, pace):
    """(until the reply, until the controllers, bytes that were read before the reply)"""
    stand.drive()
    caller.send(*asked)
    if asked:
        caller.wait()
    caller.number += 1
    mark = b'"id":%d' % (10**9 + caller.number)
    begun = time.monotonic()
    caller.send(request("motor.stop", 10**9 + caller.number))
    if pace == 0:
        zero = stand.told_zero(begun)
        before = caller.read_until(mark)
        replied = time.monotonic() - begun
    else:
        before = caller.read_until(mark, pace)
        replied = time.monotonic() - begun
        zero = stand.told_zero(begun)
    size = caller.read_rest(lines)
    assert size > LARGE_BYTES or not asked, f"only {size} bytes were asked for"
    return replied, zero, before


def check(stand, kind, carrier="TCP", beside=""):
    """Whether it holds. A reply can come no sooner than what was sent before it has been read: of a slow reader only the controllers
    are judged, and that the reply costs no more than that reading."""
    asked, lines, pace = AHEAD[kind]
    caller = stand.caller(carrier, 1 << 16 if pace < math.inf else None)
    try:
        set_niceness(-15)
        taken, again = measure(lambda: stop_behind(stand, caller, asked, lines, pace), TRIALS, lambda one: max(one[:2]))
    finally:
        set_niceness(0)
        caller.close()
    reply, reply_share = figures([one[0] for one in taken])
    zero, zero_share = figures([one[1] for one in taken])
    before = sorted(one[2] for one in taken)[len(taken) // 2]
    late = [one[0] - one[2] / pace for one in taken] if 0 < pace < math.inf else []
    print(f"{beside}behind {kind}, {carrier}:\n    controllers {zero}\n    reply {reply}; {before} bytes came before it"
          + (f"; beyond their reading {1000 * max(late):.1f} ms at most" if late else "")
          + (f"; {again} made again: the machine stood still" if again else ""), flush=True)
    # A Unix socket takes some 200 kB at a time, and what is left waits for a round of the daemon's loop.
    in_pieces = carrier == "Unix socket" and asked and beside
    judged = [zero_share, figures(late)[1] if late else reply_share if pace == math.inf and not in_pieces else 1]
    return [] if min(judged) >= SHARE else [f"{beside}behind {kind}, {carrier}"]


def fill_log(stand):
    """Until log.tail gives all that it gives at once."""
    stand.driver.call("settings.set", values={"log": {"level": "debug"}})
    while len(json.dumps(stand.driver.call("log.tail", count=10000))) < LARGE_BYTES + 50000:
        for _ in range(500):
            stand.caller("TCP").close()
        with contextlib.closing(stand.caller("TCP")) as last:  # those before it have been taken by then
            last.send(request("daemon.info"))
            last.wait()
    stand.driver.call("settings.set", values={"log": {"level": "info"}})


def dearest(stand):
    """Of those that anybody may call: which takes longest."""
    took = {}
    for method, params in CANDIDATES.items():
        begun = time.monotonic()
        for _ in range(10):
            stand.driver.call(method, **params)
        took[method] = time.monotonic() - begun
    method = max(took, key=took.get)
    print(f"the dearest command: {method}, {100 * took[method]:.2f} ms a call", flush=True)
    return method


def play(kind, port):
    """One of the others, in a process of its own."""
    if kind == "silent":
        return hold(port, 16)
    print("here", flush=True)
    if kind == "flood":
        return pump(port, line({"jsonrpc": "2.0", "method": "motor.drive", "params": {"vx": 0.3}}) * 200, reads=False)
    return pump(port, batch(kind, 1000, **CANDIDATES[kind]))


class FullDisk:
    """Settings, log and a recording are on a disk without room; settings.save and the recording are tried without end."""

    def __init__(self, stand, disk, folder):
        self.stand, self.disk, self.ends = stand, disk, threading.Event()
        self.refused = {"settings.save": 0, "record.start": 0}
        self.lidar = free_port(0, socket.SOCK_DGRAM)
        self.logger = Process(BINARIES, "velodynelogger", free_port(0), folder,
                              {"source.port": self.lidar, "source.position_port": 0, "source.address": "127.0.0.1",
                               "record.folder": disk, "record.free_floor_bytes": 0, "record.free_warn_bytes": 0})
        self.threads = []

    def __enter__(self):
        self.logger.connect().close()
        self.sender = subprocess.Popen([os.path.join(BUILD, "tests", "system", "packet_sender"), str(self.lidar), "1810", "600", "0", "0"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        with self.logger.connect() as logger:
            logger.call("record.start", name="first")
            wait_for("a recording that failed", lambda: not logger.call("record.status")["recording"], 20)
            assert logger.call("record.status")["error"]["code"] == INPUT_OUTPUT
        self.stand.driver.call("settings.set", values={"motion": {"vx": 1.0}, "log": {"level": "debug"}})
        self.before = text_of(self.stand.config)
        wait_for("a full disk", self.fill)
        for method, port, params in (("settings.save", self.stand.port, {}), ("record.start", self.logger.port, {"name": "next"})):
            self.threads.append(threading.Thread(target=self.try_again, args=(method, port, params)))
            self.threads[-1].start()
        return self

    def fill(self):
        """True when no room was left: a recording that fails gives back, a moment later, what it had reserved."""
        room = os.statvfs(self.disk).f_bavail
        try:
            with open(os.path.join(self.disk, "filler"), "ab", buffering=0) as filler:
                while filler.write(b"x" * 4096):
                    pass
        except OSError:
            pass
        return room == 0

    def try_again(self, method, port, params):
        with Daemon(port=port, timeout=30) as daemon:
            while not self.ends.is_set():
                try:
                    daemon.call(method, **params)
                    self.refused[method] = -math.inf
                except DaemonError as error:
                    self.refused[method] += 1 if error.code == INPUT_OUTPUT else -math.inf
                time.sleep(0.002)

    def __exit__(self, *failed):
        self.ends.set()
        for thread in self.threads:
            thread.join()
        room = os.statvfs(self.disk).f_bavail  # a logger that ends cuts off what is damaged
        self.sender.kill()
        self.sender.wait()
        self.logger.stop()
        if failed[0]:
            return
        assert room == 0, f"{room} blocks became free"
        assert all(number > 0 for number in self.refused.values()), self.refused
        assert text_of(self.stand.config) == self.before, "the settings file was damaged"
        print(f"full disk: refused with {INPUT_OUTPUT}: {self.refused}", flush=True)


def keep_pages():
    """Of this program, which reads 1 MB at a time: else the system gives and takes them for each reply, for longer than is measured."""
    libc, most_trimmed, most_mapped = ctypes.CDLL(None), -1, -3  # as malloc.h has them
    libc.mallopt(most_mapped, 4 << 20)
    libc.mallopt(most_trimmed, 8 << 20)


def main():
    if len(sys.argv) == 3:
        return play(sys.argv[1], int(sys.argv[2]))
    keep_pages()
    late = []
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        disk = small_disk(folder)
        if disk:
            stack.callback(subprocess.run, ["umount", "-l", disk], check=False)
        stand = Stand(folder, stack, disk)
        fill_log(stand)
        for kind in AHEAD:
            late += check(stand, kind)
        for carrier in ("Unix socket", "TLS"):
            for kind in ("nothing", "a batch of 1 MB", "a batch of 1 MB, unread"):
                late += check(stand, kind, carrier)
        crowd = [(dearest(stand), 8), ("flood", 8), ("silent", 1)]
        with others(__file__, stand.port, *crowd):
            for carrier in ("TCP", "Unix socket", "TLS"):
                late += check(stand, "a batch of 1 MB", carrier, "crowd, ")
        if disk:
            with FullDisk(stand, disk, folder):
                late += check(stand, "nothing", beside="full disk, ")
                with others(__file__, stand.port, *crowd):
                    late += check(stand, "a batch of 1 MB", beside="full disk and crowd, ")
        else:
            print("no full disk is tried: it takes root and mounts of one's own")
    assert not late, f"emergency stops are late: {'; '.join(late)}"
    return 0


if __name__ == "__main__":
    sys.exit(main())
