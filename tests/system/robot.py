"""A robot whose supervisor runs as a service, and a device at the far end of a serial line."""
import json
import os
import pty
import socket
import subprocess
import threading
import tty

from support import BINARIES, HERMESCTL, Daemon, DaemonError, free_port

NAMES = ["motorcontrol", "velodynelogger", "seriallogger", "scanmatcher"]


class Talker:
    """A device on a serial line that says the same over and over, whatever it is asked."""

    def __init__(self, path, says):
        self.far, self.near = pty.openpty()
        tty.setraw(self.near)
        self.path, self.says, self.is_over = path, says, threading.Event()
        os.set_blocking(self.far, False)
        if os.path.lexists(path):
            os.remove(path)
        os.symlink(os.ttyname(self.near), path)
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        while not self.is_over.wait(0.02):
            for do in (lambda: os.write(self.far, self.says), lambda: os.read(self.far, 4096)):
                try:
                    do()
                except BlockingIOError:
                    pass

    def close(self):
        self.is_over.set()
        self.thread.join()
        os.close(self.far)
        os.close(self.near)


class Robot:
    """Settings files in a folder, the supervisor that reads them, and its journal. It runs as a service manager does it: what ends
    is started again."""

    def __init__(self, folder, simulated):
        self.folder, self.etc = folder, os.path.join(folder, "etc")
        self.ports = {name: free_port(0) for name in ["supervisor", *NAMES]}
        self.journal = os.path.join(folder, "journal")
        self.is_over, self.process = threading.Event(), None
        os.mkdir(self.etc)
        entries = [{"name": name, "port": self.ports[name], "autostart": True, "arguments": [
            "--config", self.path(name), "--listen", f"tcp://127.0.0.1:{self.ports[name]}?protocol=json"]} for name in NAMES]
        line = f"serial://{simulated['motors']}?baud=115200"
        self.settings = {
            "supervisor": {"processes": entries, "setup": {"folder": self.etc, "lidar_port": free_port(0, socket.SOCK_DGRAM),
                                                           "position_port": free_port(0, socket.SOCK_DGRAM)}},
            "motorcontrol": {"controllers": {"1": {"url": line}, "2": {"url": line}}},
            "velodynelogger": {"source": {"address": "127.0.0.1", "port": simulated["lidar"]}},
            "seriallogger": {"ports": [{"name": "gps", "url": f"serial://{simulated['gps']}?baud=9600", "view": "nmea"}]},
            "scanmatcher": {"source": {"address": f"127.0.0.1:{self.ports['velodynelogger']}"}}}
        for name in self.settings:
            self.write(name)

    def path(self, name):
        return os.path.join(self.etc, name + ".json")

    def write(self, name, **changes):
        self.settings[name].update(changes)
        self.write_text(name, json.dumps(self.settings[name]).encode())

    def write_text(self, name, text):
        with open(self.path(name) + ".new", "wb") as file:
            file.write(text)
        os.replace(self.path(name) + ".new", self.path(name))

    def start(self, **environment):
        self.environment = environment
        self.thread = threading.Thread(target=self.keep_up)
        self.thread.start()

    def keep_up(self):
        command = [os.path.join(BINARIES, "hermes-supervisor"), "--config", self.path("supervisor"), "--listen",
                   f"tcp://127.0.0.1:{self.ports['supervisor']}?protocol=json"]
        usual = {**os.environ, "NOTIFY_SOCKET": os.path.join(self.folder, "notify"), "STATE_DIRECTORY": self.folder,
                 "XDG_STATE_HOME": self.folder}
        with open(self.journal, "ab") as journal:
            while not self.is_over.is_set():
                environment = {**usual, **self.environment}
                self.process = subprocess.Popen(command, stdout=journal, stderr=journal, stdin=subprocess.DEVNULL, env=environment)
                self.process.wait()

    def stop(self):
        self.is_over.set()
        self.process.terminate()
        self.thread.join(30)

    def call(self, daemon, method, **params):
        with Daemon(port=self.ports[daemon], timeout=20) as connection:
            return connection.call(method, **params)

    def items(self, name):
        """The health items of a daemon that are not ok, as NAME: LEVEL: TEXT; None where it does not answer."""
        try:
            return [f"{one['name']}: {one['level']}: {one['message']}" for one in self.call(name, "daemon.status")["health"]
                    if one["level"] != "ok"]
        except (OSError, DaemonError):
            return None

    def shown(self):
        addresses = ",".join(f"127.0.0.1:{port}" for port in self.ports.values())
        done = subprocess.run([HERMESCTL, "list", "--daemons", addresses], capture_output=True, text=True, timeout=30, check=False)
        return done.stdout + done.stderr

    def journal_size(self):
        return os.path.getsize(self.journal)

    def written(self, since):
        with open(self.journal, "rb") as journal:
            journal.seek(since)
            return journal.read().decode(errors="replace")
