#!/usr/bin/env python3
"""The programs of docs/examples when something is wrong, and at Ctrl-C: one line that says what it is, and no traceback."""
import os
import pty
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import unittest

from support import SOURCE, Daemon, free_port, put

EXAMPLES = os.path.join(SOURCE, "docs", "examples")
sys.path.insert(0, EXAMPLES)
from drive import PathFollower  # noqa: E402


def begin(name, *arguments):
    return subprocess.Popen([sys.executable, os.path.join(EXAMPLES, name), *map(str, arguments)], stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


class ExampleFaultsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def expect(self, process, status, *words):
        """It ends by itself, with these words in its only line of complaint."""
        _, complaint = process.communicate(timeout=30)
        self.assertEqual(process.returncode, status, complaint)
        self.assertEqual(len(complaint.splitlines()), 1 if words else 0, complaint)
        for word in words:
            self.assertIn(word, complaint)

    def file(self, name, text):
        path = os.path.join(self.folder, name)
        put(path, text)
        return path

    def begun(self, name, *arguments):
        """The port of a daemon that runs until the test ends."""
        port = free_port(0)
        process = begin(name, *arguments, "--port", port)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        process.stdout.readline()
        return port

    def test_a_daemon_ends_in_order_at_ctrl_c(self):
        for name in ("daemon.py", "scan2d.py"):
            for number in (signal.SIGINT, signal.SIGTERM):
                port = free_port(0)
                process = begin(name, "--port", port)
                self.assertIn(f"running at 127.0.0.1:{port}", process.stdout.readline())
                with Daemon(port=port) as client:
                    client.call("topics.subscribe", topic="log")
                    process.send_signal(number)
                    self.expect(process, 0)

    def test_a_daemon_says_who_has_its_port(self):
        with socket.socket() as other:
            other.bind(("127.0.0.1", 0))
            other.listen()
            port = other.getsockname()[1]
            self.expect(begin("daemon.py", "--port", port), 1, f"fan: cannot listen on 127.0.0.1:{port}: Address already in use", "--port")

    def test_a_daemon_says_what_is_wrong_with_its_settings(self):
        for text, word in (("{", "expected an object of JSON"), ("[1]", "expected an object of JSON"), ('{"speed": 2}', "speed is 2, expected number"),
                           ('{"sped": 1}', "sped is unknown, there is ")):
            self.expect(begin("daemon.py", "--config", self.file("fan.json", text), "--port", free_port(0)), 1, word)
        self.expect(begin("daemon.py", "--config", self.folder), 1, "Is a directory")
        self.expect(begin("daemon.py", "--set", "speed=2"), 1, "speed is 2, expected number from 0 to 1")

    def test_settings_of_the_command_line_win(self):
        path = self.file("fan.json", '{"speed": 0.1, "alarm_c": 20}')
        with Daemon(port=self.begun("daemon.py", "--config", path, "--set", "speed=0.7")) as fan:
            settings = fan.call("settings.get")
        self.assertEqual((settings["speed"], settings["alarm_c"]), (0.7, 20))

    def test_numbers_that_are_not_finite(self):
        with socket.create_connection(("127.0.0.1", self.begun("daemon.py")), 10) as client, client.makefile("rb") as replies:
            for number in (b"NaN", b"-Infinity", b"1e999"):
                for request in (b'{"id": 1, "method": "settings.set", "params": {"values": {"alarm_c": %s}}}', b'{"id": %s}'):
                    client.sendall(request % number + b"\n")
                    self.assertIn("not a finite number", replies.readline().decode())
            client.sendall(b'{"id": 2, "method": "daemon.info"}\n')
            self.assertIn(b'"result"', replies.readline())

    def test_a_drive_that_would_never_arrive(self):
        for option in (("--speed", "-0.5"), ("--speed", "nan"), ("--turn-rate", "0")):
            with self.assertRaisesRegex(ValueError, "above 0"):
                PathFollower([(0, 0), (1, 0)], **{option[0][2:].replace("-", "_"): float(option[1])})

    def test_a_client_says_where_nobody_answers(self):
        port = free_port(0)
        with self.assertRaisesRegex(ConnectionError, f"no daemon answers at 127.0.0.1:{port}: Connection refused"):
            Daemon(port=port)

    def test_the_serial_client(self):
        self.expect(begin("hermes_serial.py", "/dev/null", "daemon.info"), 1, "/dev/null: is no serial line")
        self.expect(begin("hermes_serial.py", "/dev/absent", "daemon.info"), 1, "/dev/absent")
        near, far = pty.openpty()
        device = os.ttyname(far)
        try:
            self.expect(begin("hermes_serial.py", device, "daemon.info", "--baud", 5), 1, f"{device}: no serial line has 5 baud")
            process = begin("hermes_serial.py", device, "daemon.info")
            self.assertTrue(os.read(near, 1))  # its request
            self.expect(begin("hermes_serial.py", device, "daemon.info"), 1, f"{device}: in use by another program")
            process.send_signal(signal.SIGINT)
            self.expect(process, 130)
            self.expect(begin("hermes_serial.py", device, "daemon.info"), 1, "daemon.info: no reply within 5.0 s")
        finally:
            os.close(near)
            os.close(far)

    def test_the_reader_of_recordings(self):
        base = os.path.join(self.folder, "seriallogger-gps")
        self.expect(begin("seriallog.py"), 1, "usage")
        self.expect(begin("seriallog.py", base), 1, base + ".raw")
        for name, data in ((".raw", b"abc"), (".index", b"no index")):
            with open(base + name, "wb") as file:
                file.write(data)
        self.expect(begin("seriallog.py", base), 1, base + ".index: no index of version 1")
        with open(base + ".index", "wb") as file:
            file.write(b"HERMESIX" + struct.pack("<II", 1, 24) + struct.pack("<Qqq", 0, 1500000000, 1))
        process = begin("seriallog.py", base)
        self.assertEqual(process.communicate(timeout=30), ("1.500000 b'abc'\n", ""))

    def test_the_simulated_scanner(self):
        world = os.path.join(SOURCE, "deploy", "worlds", "pillars.json")
        link, port = os.path.join(self.folder, "laser"), free_port(0)
        self.expect(begin("simulated_ld06.py", world, link, "--port", port), 1, f"the simulator: no daemon answers at 127.0.0.1:{port}")
        self.expect(begin("simulated_ld06.py", world + "x", link), 1, world + "x")
        for text in ("{", "[1]", '{"edges": [1]}', '{"edges": [[1, 2]]}'):
            self.expect(begin("simulated_ld06.py", self.file("world.json", text), link), 1, "world.json: expected a world")
        fan = self.begun("daemon.py")
        self.expect(begin("simulated_ld06.py", world, link, "--port", fan), 1, "the simulator: no topic truth")


if __name__ == "__main__":
    unittest.main()
