#!/usr/bin/env python3
"""docs/examples/hermes_serial.py against a daemon at the other end of a serial line, with damage on it."""
import os
import random
import subprocess
import sys
import tempfile
import time
import unittest

from support import BINARIES, SOURCE, wait_for
sys.path.insert(0, os.path.join(SOURCE, "docs", "examples"))
import hermes_serial  # noqa: E402
from hermes_serial import DaemonError, SerialDaemon, crc32c, from_cbor, stuff, to_cbor, unstuff  # noqa: E402


class Noisy(SerialDaemon):
    """Hears and says one byte in so many wrongly."""

    def __init__(self, device, one_in, seed):
        super().__init__(device)
        self.one_in, self.source = one_in, random.Random(seed)

    def spoil(self, data):
        return bytes(byte ^ self.source.randrange(1, 256) if self.source.randrange(self.one_in) == 0 else byte for byte in data)


class SerialClientTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.link = os.path.join(self.folder.name, "line")
        self.daemon = subprocess.Popen([os.path.join(BINARIES, "hermes-softwaretrigger"), "--set", "access.plain=engineer", "--listen", f"pty://{self.link}?protocol=serial"],
                                       stderr=subprocess.DEVNULL)
        wait_for("the line", lambda: os.path.exists(self.link))

    def tearDown(self):
        self.daemon.terminate()
        self.daemon.wait()
        self.folder.cleanup()

    def test_parts(self):
        self.assertEqual(crc32c(b"123456789"), 0xE3069283)
        source = random.Random(1)
        for size in (0, 1, 253, 254, 255, 508, 509, 1000):
            for zeros in (1, 10, 1000):
                data = bytes(source.randrange(256) if source.randrange(zeros) else 0 for _ in range(size))
                self.assertEqual(unstuff(stuff(data)), data)
                self.assertNotIn(0, stuff(data))
        value = {"a": [1, -1, 23, 24, 255, 256, 65536, 1 << 40, -500, 1.5, None, True, False], "\u00e4": "x" * 300, "": {}}
        self.assertEqual(from_cbor(to_cbor(value))[0], value)

    def test_calls_topics_errors(self):
        with SerialDaemon(self.link) as trigger:
            self.assertEqual(trigger.call("daemon.info")["name"], "softwaretrigger")
            self.assertGreater(len(trigger.call("rpc.discover")["methods"]), 10)  # in pieces
            with self.assertRaises(DaemonError) as refused:
                trigger.call("no.such")
            self.assertEqual(refused.exception.code, -32601)
            messages = trigger.subscribe("settings")
            self.assertIsInstance(next(messages)["data"], dict)
            trigger.notify("daemon.info")
            self.assertEqual(trigger.damaged, 0)

    def test_damaged_line(self):
        seed = int(os.environ.get("HERMES_SEED", random.randrange(1 << 30)))
        print(f"HERMES_SEED={seed}")
        real_write, real_read = os.write, os.read
        with Noisy(self.link, 300, seed) as trigger:
            trigger.timeout = 30
            hermes_serial.os.write = lambda port, data: real_write(port, trigger.spoil(data)) if port == trigger.port else real_write(port, data)
            hermes_serial.os.read = lambda port, size: trigger.spoil(real_read(port, size)) if port == trigger.port else real_read(port, size)
            try:
                before = time.monotonic()
                for i in range(30):
                    trigger.call("settings.set", values={"limits": {"clients": 5 + i}})
                    self.assertEqual(trigger.call("settings.get", path="limits.clients"), 5 + i)
                self.assertGreater(len(trigger.call("topics.list")), 3)
                with self.assertRaises(DaemonError):
                    trigger.estop()  # a trigger has no motors
                self.assertEqual(trigger.call("settings.get", path="limits.clients"), 34)  # late replies to repeats are passed over
                took = time.monotonic() - before
            finally:
                hermes_serial.os.write, hermes_serial.os.read = real_write, real_read
            channel = next(one for one in trigger.call("daemon.status")["health"] if one["name"] == "channel")["values"]
            print(f"63 calls in {took:.1f} s; {trigger.repeated} repeated, {trigger.damaged} frames damaged here, "
                  f"{channel['line_damaged_frames']} there")
            self.assertGreater(trigger.repeated, 0)
            self.assertGreater(channel["line_repeated_requests"], 0)
            self.assertLessEqual(channel["requests"], 64)  # and none was carried out twice


if __name__ == "__main__":
    unittest.main()
