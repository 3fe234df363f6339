#!/usr/bin/env python3
"""docs/examples/daemon.py and hermes_daemon.py: every command that a daemon has, bad requests, a client that does not read, the end."""
import json
import os
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from support import SOURCE, Daemon, DaemonError, free_port, wait_for

PROGRAM = os.path.join(SOURCE, "docs", "examples", "daemon.py")
COMMANDS = {"rpc.discover", "daemon.info", "daemon.status", "daemon.shutdown", "settings.schema", "settings.get", "settings.set",
            "settings.reset", "settings.save", "topics.list", "topics.subscribe", "topics.unsubscribe", "log.tail"}


class DaemonExampleTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.config = os.path.join(self.folder.name, "fan.json")
        self.start()

    def start(self):
        self.port = free_port(0)
        self.program = subprocess.Popen([sys.executable, PROGRAM, "--port", str(self.port), "--config", self.config],
                                        stderr=subprocess.PIPE, text=True)
        self.fan = wait_for("the daemon", self.connect)

    def connect(self):
        try:
            return Daemon(port=self.port)
        except OSError:
            return None

    def tearDown(self):
        self.fan.close()
        self.program.kill()
        self.program.communicate()
        self.folder.cleanup()

    def refusal(self, method, **params):
        with self.assertRaises(DaemonError) as refused:
            self.fan.call(method, **params)
        return refused.exception.code

    def test_every_command(self):
        methods = {method["name"] for method in self.fan.call("rpc.discover")["methods"]}
        self.assertEqual(COMMANDS - methods, set())
        self.assertIn("air", [topic["name"] for topic in self.fan.call("topics.list")])
        message = next(self.fan.subscribe("air"))
        self.assertTrue(0 <= message["data"]["speed"] <= 1)
        self.fan.call("fan.boost", duration_s=3)
        self.assertIn("full speed for 3 s", self.fan.call("log.tail")[-1]["text"])

    def test_settings_are_kept(self):
        self.assertEqual(self.fan.call("settings.set", values={"alarm_c": 20})["changed"], ["alarm_c"])
        self.assertEqual(self.fan.call("settings.save")["path"], self.config)
        self.assertEqual(self.fan.call("settings.reset")["changed"], ["alarm_c"])
        self.fan.call("daemon.shutdown")
        self.assertEqual(self.program.wait(5), 0)
        self.assertEqual(self.program.communicate()[1], "")
        self.fan.close()
        self.start()
        self.assertEqual(self.fan.call("settings.get")["alarm_c"], 20)

    def test_all_or_nothing(self):
        for values in ({"speed": 0.9, "alarm_c": "x"}, {"speed": 0.9, "no": 1}, {"speed": 2}, {"speed": True}):
            self.assertEqual(self.refusal("settings.set", values=values), -32003)
        self.assertEqual(self.fan.call("settings.get", path="speed"), 0.3)

    def test_bad_requests_cost_an_error(self):
        self.assertEqual(self.refusal("no.method"), -32601)
        self.assertEqual(self.refusal("fan.boost", duration_s=-1), -32602)
        self.assertEqual(self.refusal("topics.subscribe", topic="no"), -32006)
        for line, code in ((b"x", -32700), (b"[" * 100000, -32700), (b"\xff", -32700), (b"5", -32600), (b"{}", None), (b"", None)):
            self.fan.socket.sendall(line + b"\n")
            if code:
                self.assertEqual(json.loads(self.fan.lines.readline())["error"]["code"], code, line[:20])
        self.assertEqual(self.fan.call("daemon.info")["name"], "fan")

    def test_who_does_not_read_holds_up_nobody(self):
        slow = socket.create_connection(("127.0.0.1", self.port))
        slow.setblocking(False)
        request = b'{"jsonrpc":"2.0","id":1,"method":"rpc.discover"}\n'
        sent = 0
        longest = 0
        while sent < 20000:
            try:
                slow.sendall(request * 100)
            except BlockingIOError:
                pass
            except OSError:
                break  # closed: it leaves its replies unread
            sent += 100
            before = time.monotonic()
            self.fan.call("daemon.info")
            longest = max(longest, time.monotonic() - before)
        slow.close()
        self.assertLess(sent, 20000)
        self.assertLess(longest, 0.9)


if __name__ == "__main__":
    unittest.main()
