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

from support import SOURCE, Daemon, free_port

EXAMPLES = os.path.join(SOURCE, "docs", "examples")


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
        path = os.path.join(self.folder, "fan.json")
        for text, word in (("{", "expected an object of JSON"), ("[1]", "expected an object of JSON"), ('{"speed": 2}', "speed: expected"),
                           ('{"sped": 1}', "sped: expected")):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            self.expect(begin("daemon.py", "--config", path, "--port", free_port(0)), 1, word)
        self.expect(begin("daemon.py", "--config", self.folder), 1, "Is a directory")
        self.expect(begin("daemon.py", "--set", "speed=2"), 1, "speed: expected number 0 to 1")

    def test_settings_of_the_command_line_win(self):
        path, port = os.path.join(self.folder, "fan.json"), free_port(0)
        with open(path, "w", encoding="utf-8") as file:
            file.write('{"speed": 0.1, "alarm_c": 20}')
        process = begin("daemon.py", "--config", path, "--set", "speed=0.7", "--port", port)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        process.stdout.readline()
        with Daemon(port=port) as fan:
            settings = fan.call("settings.get")
        self.assertEqual((settings["speed"], settings["alarm_c"]), (0.7, 20))

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


if __name__ == "__main__":
    unittest.main()
