#!/usr/bin/env python3
"""A robot has an identity: its supervisor makes it once, its processes tell it, hermesctl shows it."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
import uuid

from support import BINARIES, HERMESCTL, Process, free_port, put, text_of, wait_for

OTHER = "11111111-2222-4333-8444-555555555555"


class Identity(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        os.environ.update(XDG_STATE_HOME=self.folder)
        os.environ.pop("STATE_DIRECTORY", None)
        os.environ.pop("HERMES_ROBOT", None)
        self.state = os.path.join(self.folder, "hermes")
        self.ports = [free_port(0), free_port(0)]

    def robots(self, name="rover", port=None):
        """What a supervisor and its process tell of their robot, and the health items of the supervisor that are not well."""
        own, child = self.ports
        process = {"name": "softwaretrigger", "port": child, "autostart": True, "arguments": ["--listen", f"tcp://127.0.0.1:{child}"]}
        with Process(BINARIES, "supervisor", port or own, self.folder, {"robot": json.dumps(name), "processes": json.dumps([process])}):
            self.listed = wait_for("both", lambda: len(all := self.list(port or own, child)) == 2 and all)
            shown = subprocess.run([HERMESCTL, "list", "--daemons", f"127.0.0.1:{child}"], capture_output=True, text=True, check=True)
        self.assertRegex(shown.stdout, rf"^softwaretrigger .* tcp://127.0.0.1:{child} +{re.escape(self.listed[0]['robot']['name'])}\n$")
        return [one["robot"] for one in self.listed]

    @staticmethod
    def list(*ports):
        addresses = ",".join(f"127.0.0.1:{port}" for port in ports)
        done = subprocess.run([HERMESCTL, "list", "--json", "--daemons", addresses], capture_output=True, text=True, check=False)
        return json.loads(done.stdout or "[]")

    def test_made_once(self):
        first, child = self.robots()
        self.assertEqual(first, child)
        self.assertEqual((str(uuid.UUID(first["id"])), first["name"]), (first["id"], "rover"))
        self.assertEqual(self.robots("mule"), [{"id": first["id"], "name": "mule"}] * 2)
        self.assertNotEqual(self.robots(port=free_port(0))[0]["id"], first["id"], "two supervisors of an account are two robots")

    def test_names(self):
        for given, told in (("  Ro\tver \u00e4 ", "Ro ver \u00e4"), ("x" * 300, "x" * 100), ("a\u202eb\x07", "ab")):
            self.assertEqual([one["name"] for one in self.robots(given)], [told] * 2)
        os.environ["HERMES_ROBOT"] = f"{OTHER} crane"
        self.assertEqual(self.robots(""), [{"id": OTHER, "name": "crane"}] * 2, "one of several computers of a robot")
        del os.environ["HERMES_ROBOT"]
        self.assertTrue(self.robots("")[0]["name"], "the host's")

    def test_damaged_file(self):
        first = self.robots()[0]["id"]
        path, = [os.path.join(self.state, name) for name in os.listdir(self.state) if name.startswith("robot-id")]
        self.assertEqual(text_of(path), first + "\n")
        put(path, "nonsense")
        second = self.robots()[0]["id"]
        self.assertNotEqual(second, first)
        self.assertEqual(self.robots()[0]["id"], second)

    def test_cannot_be_kept(self):
        put(self.state, "no folder")
        first, second = (self.robots()[0]["id"] for _ in range(2))
        self.assertNotEqual(first, second)
        self.assertIn("robot identity", [item["name"] for item in self.listed[0]["wrong"]])

    def test_started_by_hand(self):
        for told in ("", "nonsense", "1234 rover", OTHER, f"{OTHER} ", f"{OTHER} {'x' * 101}", f"{OTHER} a\x1bb", f"{{{OTHER}}} a"):
            os.environ["HERMES_ROBOT"] = told
            with Process(BINARIES, "softwaretrigger", self.ports[0], self.folder, {}) as daemon:
                self.assertNotIn("robot", daemon.connect().call("daemon.info"))
                self.assertEqual(text_of(daemon.log_name).count("HERMES_ROBOT is ignored"), 1)
                os.remove(daemon.log_name)
        os.environ["HERMES_ROBOT"] = f"{OTHER} rover 7"
        with Process(BINARIES, "softwaretrigger", self.ports[0], self.folder, {}) as daemon:
            self.assertEqual(daemon.connect().call("daemon.info")["robot"], {"id": OTHER, "name": "rover 7"})


if __name__ == "__main__":
    unittest.main()
