#!/usr/bin/env python3
"""hermesctl against a small daemon."""
import json
import os
import signal
import socket
import subprocess
import tempfile
import unittest

from ctl_support import DAEMON, PROGRAM, MadeUpDaemon, ThermometerCase, at_terminal, ctl


class Hermesctl(ThermometerCase):
    def ok(self, *arguments):
        shown = ctl(*arguments)
        self.assertEqual(shown.returncode, 0, shown.stderr)
        self.assertEqual(shown.stderr, "")
        return shown.stdout

    def test_call(self):
        self.assertEqual(json.loads(self.ok("call", self.address, "thermometer.echo", 'value={"a":[1,"x"]}')),
                         {"a": [1, "x"]})
        self.assertEqual(json.loads(self.ok("call", "tcp://" + self.address, "thermometer.echo", "value=a=b")), "a=b")
        shown = ctl("call", self.address, "thermometer.read", "unit=F", "foo=1")
        self.assertEqual(shown.returncode, 1)
        self.assertIn('unit is "F", expected one of "C", "K"', shown.stderr)
        self.assertIn("foo", shown.stderr)

    def test_get_and_set(self):
        self.assertEqual(self.ok("set", self.address, "sensor.name=cellar", "period_s=0.1"), "period_s changed\n"
                         f"sensor.name changed, from the next start on once saved (hermesctl call {self.address} settings.save)\n")
        self.assertEqual(json.loads(self.ok("get", self.address, "sensor")), {"name": "cellar"})
        self.assertIn("limits", json.loads(self.ok("get", self.address)))
        self.assertEqual(ctl("set", self.address, "sensor.name=attic", "period_s=0").returncode, 1)
        self.assertEqual(json.loads(self.ok("get", self.address, "sensor.name")), "cellar")

    def test_watch(self):
        lines = self.ok("watch", self.address, "temperature", "--count", "3").splitlines()
        self.assertEqual(len(lines), 3)
        self.assertAlmostEqual(json.loads(lines[0])["data"], 20, delta=3)
        table = self.ok("watch", self.address, "extremes", "--csv", "--count=1").splitlines()
        self.assertEqual(table[0], "stamp [s],seq,dropped,greatest,least")
        self.assertTrue(table[1].endswith(",21,19"))
        shown = ctl("watch", self.address, "nothing")
        self.assertEqual(shown.returncode, 1)
        self.assertIn("temperature", shown.stderr)

    def test_discover_doc_log(self):
        self.assertIn("thermometer.calibrate {offset_k, settle_ms?}", self.ok("discover", self.address))
        self.assertEqual(json.loads(self.ok("discover", self.address, "--json"))["openrpc"], "1.2.6")
        page = self.ok("doc", self.address)
        self.assertIn("### thermometer.read", page)
        self.assertIn("| `health[].message` | a string | ", page)
        self.assertIn("  status {health, restart_for, state}\n", self.ok("discover", self.address))
        self.assertIn("| `period_s` | a number from 0.001 to 60 in s | 0.1 | now |", page)
        self.assertIn("running", self.ok("log", self.address))

    def test_usage_errors(self):
        for arguments in ([], ["fly"], ["call"], ["call", self.address], ["call", "nobody", "x"], ["list", "x"],
                          ["call", self.address, "m", "novalue"], ["watch", self.address, "t", "--rate", "fast"],
                          ["get", self.address, "--foo"], ["log", self.address, "--count"], ["get", "tcp://a b"]):
            shown = ctl(*arguments)
            self.assertEqual(shown.returncode, 2, arguments)
            self.assertTrue(shown.stderr.startswith("hermesctl: "), shown.stderr)
            self.assertEqual(shown.stdout, "")

    def test_nobody_there(self):
        with socket.socket() as taken:  # and nobody listens
            taken.bind(("127.0.0.1", 0))
            shown = ctl("call", f"127.0.0.1:{taken.getsockname()[1]}", "daemon.info")
        self.assertEqual(shown.returncode, 1)
        self.assertIn("refused", shown.stderr)
        shown = ctl("--host", "127.0.0.79", "log", "seriallogger")
        self.assertEqual(shown.returncode, 1)
        for words in ("start hermes-seriallogger", "hermesctl list says why it does not run",
                      "process.output name=seriallogger", "process.start name=seriallogger"):
            self.assertIn(words, shown.stderr)

    def test_output_that_cannot_be_written(self):
        for arguments in (["--help"], ["doc", self.address], ["call", self.address, "daemon.info"],
                          ["watch", self.address, "temperature"]):
            with open("/dev/full", "wb") as full:
                done = subprocess.run([PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE, timeout=30)
            self.assertEqual(done.returncode, 1, arguments)
            self.assertIn(b"stdout cannot be written", done.stderr)

    def test_progress(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            address = f"127.0.0.1:{silent.getsockname()[1]}"
            waiting = ["call", address, "daemon.info", "--timeout", "2.5"]
            self.assertRegex(at_terminal(*waiting), r"\r\x1b\[Kwaiting at most, second 1 of 2 \(\d+ %\), [12] s left.*\r\x1b\[K")
            self.assertNotIn("waiting", ctl(*waiting).stderr)
            shown = ctl(*waiting, "--json")  # a wait is no progress
            self.assertEqual([list(json.loads(line)) for line in shown.stderr.splitlines()], [["code", "hint", "message"]])
        many = ["watch", self.address, "temperature", "--rate", "100", "--count", "250"]
        with tempfile.TemporaryDirectory() as folder:
            out = ["--out", os.path.join(folder, "messages"), "--force"]
            self.assertRegex(at_terminal(*many, *out), r"\r\x1b\[Kmessage \d+ of 250 \(\d+ %\), \d s left")
            self.assertEqual(ctl(*many, *out).stderr, "")
            shown = ctl(*many, *out, "--json")
            self.assertEqual(shown.returncode, 0, shown.stderr)
            told = [json.loads(line)["progress"] for line in shown.stderr.splitlines()]
            self.assertEqual({(p["what"], p["total"]) for p in told}, {("message", 250)})
            self.assertEqual((told[-1]["done"], told[-1]["left_s"]), (250, 0))
            with open(out[1], encoding="utf-8") as messages:
                self.assertEqual(len(messages.readlines()), 250)

    def test_help_and_version(self):
        self.assertIn("watch D TOPIC", self.ok("--help"))
        self.assertRegex(self.ok("--version"), r"^hermesctl \d")

    def test_list(self):
        host = f"127.77.{os.getpid() // 250 % 250}.{1 + os.getpid() % 250}"  # loopback too, of this process alone
        shown = ctl("list", "--host", host)
        self.assertEqual(shown.returncode, 1)
        self.assertIn("systemctl status hermes-supervisor", shown.stderr)
        daemon = subprocess.Popen([DAEMON, "--listen", f"tcp://{host}:7490"], stderr=subprocess.PIPE, text=True)
        try:
            daemon.stderr.readline()
            self.assertRegex(self.ok("list", "--host", host), rf"thermometer +running +\S+ +tcp://{host}:7490")
            daemon.send_signal(signal.SIGSTOP)
            shown = self.ok("list", "--host", host, "--timeout", "1")
            self.assertRegex(shown, rf"\?.*tcp://{host}:7490\S*\n  error: daemon: does not answer: .*within 1 s")
        finally:
            daemon.send_signal(signal.SIGCONT)
            daemon.terminate()
            daemon.stderr.close()
            daemon.wait(20)

    def test_nothing_commands_the_terminal(self):
        """Whatever a daemon answers."""
        odd = "\x1b]0;owned\x07\x1b[2J\x9b2J\u202e\r\u2028evil"
        schema = {"type": "object", "properties": {"x" + odd: {"type": "number", "description": odd, "default": 1}}}
        method = {"name": "a" + odd, "summary": odd, "params": [{"name": "p" + odd, "schema": {"type": "number", "description": odd}}],
                  "result": {"name": "r", "schema": {"type": "null"}}}
        other = MadeUpDaemon({
            "rpc.discover": {"info": {"title": odd, "version": "1", "description": odd}, "methods": [method],
                             "x-topics": [{"name": odd, "summary": odd, "schema": {}}]},
            "settings.schema": schema, "settings.get": {"a" + odd: odd}, "settings.set": {"changed": [odd], "restart": []},
            "log.tail": [{"stamp": 1.0, "level": "info" + odd, "source": odd, "text": odd}],
            "daemon.info": {"name": "n" + odd, "version": odd, "pid": 1, "listen": []},
            "daemon.status": {"state": "ready" + odd, "health": [{"name": odd, "level": "error", "message": odd, "values": {}, "age_s": 0}]},
            "x.y": MadeUpDaemon.Error(code=-32005, message=odd, data={"why" + odd: odd})})
        self.addCleanup(other.stop)
        at = other.address
        for words in (["call", at, "x.y"], ["call", "--json", at, "x.y"], ["call", at, "settings.get"], ["discover", at], ["doc", at],
                      ["log", at], ["set", at, "a=1"], ["get", at], ["list", "--daemons", at], ["record", "list", "--recorder", at],
                      ["replay", odd, "--recorder", at], ["call", at, odd], [odd]):
            shown = ctl(*words)
            wrong = [c for c in shown.stdout + shown.stderr if c in "\x1b\x07\x9b\u202e\r\u2028"]
            self.assertEqual(wrong, [], words)
        self.assertEqual(json.loads(self.ok("call", at, "settings.get")), {"a" + odd: odd})  # the same JSON

    def test_list_of_other_programs(self):
        foreign = "answers, but is no daemon of Hermes: "
        for replies, why in (({"daemon.info": {}}, "its reply to daemon.info has no name"),
                             ({"daemon.info": {"name": "x"}, "daemon.status": {"state": {}}},
                              "its reply to daemon.status has no state"), ({}, "not found")):
            other = MadeUpDaemon(replies)
            try:
                shown = self.ok("list", "--daemons", other.address)
                self.assertIn(other.address, shown)
                self.assertRegex(shown, r"\?.*\n  error: daemon: " + foreign + why)
                one = json.loads(self.ok("list", "--json", "--daemons", other.address))[0]
                self.assertIn(why, one["wrong"][0]["message"])
            finally:
                other.stop()


if __name__ == "__main__":
    unittest.main()
