"""What tests of whole systems share: where the programs are, the modules that start and ask them, waiting, a serial port."""
import ctypes
import json
import os
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
import tty

# As ctest tells them, else those of the preset release; DATA are recordings of real sensors, which may be absent.
SOURCE = os.environ.get("HERMES_SOURCE", os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..")))
BUILD = os.environ.get("HERMES_BUILD", os.path.join(SOURCE, "build", "release"))
BINARIES = os.environ.get("HERMES_BIN", os.path.join(BUILD, "bin"))
WORLD = os.path.join(SOURCE, "deploy", "worlds", "pillars.json")
HERMESCTL = os.path.join(BINARIES, "hermesctl")
DATA = os.environ.get("HERMES_DATA", os.path.join(SOURCE, "..", "shared", "data", "public"))
EXPERIMENTS = os.path.exists(os.path.join(BINARIES, "hermes-experiments"))  # ./check builds it with --all
CLONE_NEWNS = 0x20000
# What one test leaves there no other one finds.
STATE = tempfile.TemporaryDirectory()
os.environ["XDG_STATE_HOME"] = STATE.name
# How many times slower and larger programs are than those for which limits are written: as tests/support/Patience.h.
IS_SANITIZED = bool({"TSAN_OPTIONS", "LSAN_OPTIONS"} & os.environ.keys())
SLOWNESS = 5 if IS_SANITIZED else int(os.environ.get("HERMES_SLOWNESS", 1))
PATIENCE = max(SLOWNESS, int(os.environ.get("HERMES_PATIENCE", 1)))  # of waits, where other tests run beside this one
sys.path.insert(0, os.path.join(SOURCE, "deploy", "demo"))
from processes import Daemon, DaemonError, free_port  # noqa: E402, F401
import processes  # noqa: E402


class Process(processes.Process):
    """One that a with statement stops."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()


class Listener(threading.Thread):
    """All messages of a topic from now on, and when each came."""

    def __init__(self, port, topic):
        super().__init__(daemon=True)
        self.messages, self.times = [], []
        self.stream = Daemon(port=port, timeout=None).subscribe(topic, queue=1000)
        self.start()

    def run(self):
        try:
            for message in self.stream:
                self.times.append(time.monotonic())
                self.messages.append(message)
        except (OSError, ValueError):
            pass  # the daemon has ended

    def wait(self, count, limit_s=60):
        wait_for(f"{count} messages", lambda: len(self.messages) >= count, limit_s)


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def put(path, content):
    """Writes a text, or a value as JSON; gives the path."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(content if isinstance(content, str) else json.dumps(content))
    return path


def small_disk(folder):
    """Of 4 MB, in a name space of mounts that ends with this process; None where that is not allowed."""
    disk = os.path.join(folder, "disk")
    os.mkdir(disk)
    if os.geteuid() != 0 or ctypes.CDLL(None).unshare(CLONE_NEWNS) != 0:
        return None
    for words in (["--make-rprivate", "/"], ["-t", "tmpfs", "-o", "size=4m", "tmpfs", disk]):
        if subprocess.run(["mount", *words], capture_output=True, check=False).returncode != 0:
            return None
    return disk


def wait_for(what, condition, limit_s=60):
    """The first value of condition() that counts as true."""
    deadline = time.monotonic() + limit_s * PATIENCE
    while True:
        value = condition()
        if value:
            return value
        assert time.monotonic() < deadline, f"{what} did not happen within {limit_s} s"
        time.sleep(0.01)


def refusal(daemon, method, expected="", **params):
    """The error with which a call is refused: of the code that is expected, or with these words in its message."""
    try:
        result = daemon.call(method, **params)
    except DaemonError as error:
        assert error.code == expected if isinstance(expected, int) else expected in str(error), (method, params, error, expected)
        return error
    raise AssertionError(f"{method} {params} was not refused: {result}")


def release(motors, limit_s=10):
    """Ends an emergency stop as a person does who confirms: once the motor control allows it."""
    def is_done():
        try:
            motors.call("motor.reset_estop", confirm=True)
        except DaemonError as error:
            assert error.code == -32005, error  # too early, the wheels turn, or what came meanwhile is void
            return False
        return True
    wait_for("release", is_done, limit_s)


def vector_commands(help_text):
    """The commands that hermes-vector --help lists and that can be run: two of them are hermes-experiments'."""
    listed = re.findall(r"^ {2}([a-z][a-z-]*) ", help_text.split("Subcommands:")[1], re.MULTILINE)
    return [name for name in listed if EXPERIMENTS or name not in ("experiment", "report")]


def simulated_hall(folder, size=9, pose=(0, 0, 0), **settings):
    """A simulator with a robot in an empty hall, so many metres from its middle to its ends, and the serial line of its motors."""
    world = put(os.path.join(folder, "hall.json"), {"name": "hall", "poses": [pose], "edges": [
        [-size, -9, size, -9], [size, -9, size, 9], [size, 9, -size, 9], [-size, 9, -size, -9]]})
    settings = {"motors.link": os.path.join(folder, "motors"), "world": world, "lidar.port": free_port(0, socket.SOCK_DGRAM), **settings}
    return Process(BINARIES, "simulator", free_port(0), folder, settings), settings["motors.link"]


def fastest_wheel(simulator):
    return max(abs(speed) for speed in simulator.call("sim.state")["motors"]["wheels_rps"])


class SerialPort:
    """The near end of a serial line, as a program opens it that knows nothing of pseudo-terminals."""

    def __init__(self, path):
        self.port = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.port)

    def close(self):
        os.close(self.port)
