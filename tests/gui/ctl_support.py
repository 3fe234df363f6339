"""What tests of hermesctl share: running it, a small daemon, and a made-up one that says whatever a test wants."""
import json
import os
import pty
import socket
import subprocess
import threading
import unittest

BUILD = os.environ["HERMES_BUILD"]
SOURCE = os.environ["HERMES_SOURCE"]
PROGRAM = os.path.join(BUILD, "bin", "hermesctl")
DAEMON = os.path.join(BUILD, "tests", "common", "hermes-thermometer")


def ctl(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=60)


def at_terminal(*arguments):
    """What it writes to a terminal that is its stderr."""
    far, near = pty.openpty()
    with subprocess.Popen([PROGRAM, *arguments], stdout=subprocess.DEVNULL, stderr=near) as process:
        os.close(near)
        text = b""
        try:
            while more := os.read(far, 4096):
                text += more
        except OSError:
            pass  # it has ended
        os.close(far)
        process.wait(60)
    return text.decode()


class Thermometer:
    """A small daemon for tests on a free port; with another framing too where that is named."""

    def __init__(self, protocol="json"):
        self.process = subprocess.Popen([DAEMON, "--listen", f"tcp://127.0.0.1:0?protocol={protocol}", "--set", "period_s=0.01"],
                                        stderr=subprocess.PIPE, text=True)
        line = self.process.stderr.readline()
        self.address = "127.0.0.1:" + line.split("tcp://127.0.0.1:")[1].split(",")[0]

    def stop(self):
        self.process.terminate()
        self.process.stderr.close()
        assert self.process.wait(20) == 0


class ThermometerCase(unittest.TestCase):
    """Tests with one such daemon."""

    @classmethod
    def setUpClass(cls):
        cls.daemon = Thermometer()
        cls.addClassCleanup(cls.daemon.stop)
        cls.address = cls.daemon.address


class MadeUpDaemon:
    """Answers each method with what replies has for it (an Error becomes one; a function gets the parameters), and sends the messages of a topic, once, to the
    first who subscribes: a list of (seq, dropped, data)."""

    class Error(dict):
        pass

    def __init__(self, replies, messages=(), schema=None):
        topics = [{"name": "made.up", "summary": "Made up", "schema": schema or {}, "snapshot": False}]
        self.replies = {"topics.list": topics, "topics.subscribe": {"subscription": 1}, **replies}
        self.messages = list(messages)
        self.server = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self.server.getsockname()[1]}"
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            try:
                client = self.server.accept()[0]
            except OSError:
                return
            threading.Thread(target=self.serve, args=(client,), daemon=True).start()

    def serve(self, client):
        with client, client.makefile("r", encoding="utf-8") as lines, client.makefile("w", encoding="utf-8") as out:
            try:
                for line in lines:
                    self.answer(json.loads(line), out)
            except (OSError, UnicodeDecodeError):  # spoken to in another framing
                pass

    def answer(self, request, out):
        reply = self.replies.get(request["method"], self.Error(code=-32601, message="not found"))
        reply = reply(request["params"]) if callable(reply) else reply
        key = "error" if isinstance(reply, self.Error) else "result"
        out.write(json.dumps({"jsonrpc": "2.0", "id": request["id"], key: reply}) + "\n")
        if request["method"] == "topics.subscribe":
            for seq, dropped, data in self.messages:
                params = {"subscription": 1, "topic": request["params"]["topic"], "seq": seq, "dropped": dropped, "stamp": 1.5, "data": data}
                out.write(json.dumps({"jsonrpc": "2.0", "method": "topic", "params": params}) + "\n")
        out.flush()

    def stop(self):
        self.server.close()
