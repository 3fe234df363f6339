"""The sides of a pairing: hermesctl keys pair, a line between both that stops, and a side with the authority that is none."""
import contextlib
import hashlib
import json
import os
import socket
import struct
import subprocess
import threading

from support import HERMESCTL, free_port

IDENTITY = "hermes pairing 1"
SUITE = "ECDHE-PSK-CHACHA20-POLY1305"


def ctl(folder, *words, status=0):
    done = subprocess.run([HERMESCTL, *words], env={**os.environ, "HERMES_KEYS": folder}, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == status, (words, done)
    return done.stdout if status == 0 else done.stderr


def secret_of(code):
    return hashlib.scrypt(code.replace("-", "").encode(), salt=b"hermes pairing 1", n=1 << 15, r=8, p=1, maxmem=64 << 20, dklen=32).hex()


class Pair:
    """A hermesctl keys pair that waits."""

    def __init__(self, folder, name, role, *options):
        self.folder, self.name, self.port = folder, name, free_port(0)
        self.process = subprocess.Popen([HERMESCTL, "keys", "pair", name, "--role", role, "--json", "--port", str(self.port), *options],
                                        env={**os.environ, "HERMES_KEYS": folder}, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.told = json.loads(self.process.stdout.readline())
        self.code = self.told["code"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.communicate()

    def end(self, status):
        """What it said at last."""
        out, notes = self.process.communicate(timeout=30)
        assert self.process.returncode == status, (self.process.returncode, out, notes)
        self.notes = [json.loads(line) for line in notes.splitlines()]
        return json.loads(out) if status == 0 else self.notes[-1]

    def join(self, folder, code=None, port=None, status=0):
        return ctl(folder, "keys", "join", f"127.0.0.1:{port or self.port}", *(code or self.code).split(), status=status)

    def connect(self):
        return socket.create_connection(("127.0.0.1", self.port), 10)


class Half:
    """Between both sides: passes so many bytes on to the joining one, then no more."""

    def __init__(self, port, most):
        self.most, self.isFull = most, threading.Event()
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        self.there = socket.create_connection(("127.0.0.1", port), 10)
        threading.Thread(target=self.run, daemon=True).start()

    def run(self):
        here = self.listener.accept()[0]
        threading.Thread(target=self.back, args=(here,), daemon=True).start()
        passed = 0
        while passed < self.most:
            part = self.there.recv(min(1000, self.most - passed))
            here.sendall(part)
            passed += len(part)
        self.isFull.set()

    def back(self, here):
        with contextlib.suppress(OSError):
            while part := here.recv(1000):
                self.there.sendall(part)
        self.there.shutdown(socket.SHUT_RDWR)


def framed(value):
    text = value if isinstance(value, bytes) else json.dumps(value).encode()
    return struct.pack(">I", len(text)) + text


@contextlib.contextmanager
def pretended(port, code):
    """The openssl program as the side with the authority: knows the code."""
    server = subprocess.Popen(["openssl", "s_server", "-accept", str(port), "-nocert", "-psk_identity", IDENTITY, "-psk", secret_of(code), "-tls1_2",
                               "-cipher", SUITE, "-quiet", "-naccept", "1"], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
    try:
        yield server
    finally:
        server.kill()
        server.communicate()
