"""Starts daemons as processes of their own and stops them in order, whatever happens to this one."""
import ctypes
import os
import random
import signal
import socket
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "docs", "examples"))
from hermes import Daemon, DaemonError  # noqa: E402

PR_SET_PDEATHSIG = 1


held = []  # sockets of reserved ports


def free_port(preferred, kind=socket.SOCK_STREAM):
    """The preferred port of the loopback address when it is free, else one that nobody gets by chance: it is none of those that
    the system hands out, and this process holds the TCP port as long as it lives, without listening."""
    if preferred:
        with socket.socket(socket.AF_INET, kind) as probe:
            if kind == socket.SOCK_STREAM:
                probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind(("127.0.0.1", preferred))
                return preferred
            except OSError:
                pass
    for _ in range(1000):
        port = random.randrange(20000, 32000)
        holder = socket.socket()
        try:
            holder.bind(("127.0.0.1", port))
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
                probe.bind(("127.0.0.1", port))
        except OSError:
            holder.close()
            continue
        holder.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # the daemon has it too, and may listen
        held.append(holder)
        return port
    raise OSError("no free port on 127.0.0.1")


def die_with(parent):
    # The children have a session of their own, so that Ctrl-C reaches only this process and it can stop them in order;
    # should it be killed, the kernel ends them. It may have been killed a moment ago.
    ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:
        os._exit(1)


class Process:
    """A running daemon, its port and its log file."""

    def __init__(self, binaries, name, port, log_folder, settings, arguments=()):
        self.name, self.port = name, port
        self.log_name = os.path.join(log_folder, name + ".log")
        command = [os.path.join(binaries, "hermes-" + name), "--listen", f"tcp://127.0.0.1:{port}?protocol=json"]
        command += arguments
        for path, value in settings.items():
            command += ["--set", f"{path}={value}"]
        parent = os.getpid()
        with open(self.log_name, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                            start_new_session=True, preexec_fn=lambda: die_with(parent))

    def connect(self, limit_s=10.0):
        """A connection to the daemon, as soon as it answers."""
        deadline = time.monotonic() + limit_s
        while True:
            if self.process.poll() is not None:
                raise RuntimeError(f"hermes-{self.name} ended with status {self.process.returncode}:\n{self.last_words()}")
            try:
                daemon = Daemon(port=self.port, timeout=30)
                if daemon.call("daemon.info")["pid"] == self.process.pid:
                    return daemon
                daemon.close()  # somebody else has taken the port meanwhile; ours says so and ends
            except OSError as error:
                reason = error
            else:
                reason = "another program answers there"
            if time.monotonic() > deadline:
                raise RuntimeError(f"hermes-{self.name} does not answer on port {self.port}: {reason}")
            time.sleep(0.02)

    def last_words(self):
        with open(self.log_name, encoding="utf-8", errors="replace") as log:
            return "".join(log.readlines()[-5:]).rstrip()

    def stop(self):
        """Asks the daemon to end in order, then makes it; gives its exit status."""
        for ask in (self.process.terminate, self.process.kill):
            ask()
            try:
                return self.process.wait(5)
            except subprocess.TimeoutExpired:
                continue
        return self.process.wait()
