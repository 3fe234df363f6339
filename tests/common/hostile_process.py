#!/usr/bin/env python3
"""A daemon in bad company: nobody reads its log, no file descriptors are left, settings that would keep it from starting."""
import os
import resource
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, os.path.join(os.environ["HERMES_SOURCE"], "docs", "examples"))
from hermes import Daemon, DaemonError  # noqa: E402

PROGRAM = os.path.join(os.environ["HERMES_BUILD"], "tests", "common", "hermes-thermometer")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Running:
    """The daemon; its log goes to stderr, a file or a pipe."""

    def __init__(self, stderr=subprocess.DEVNULL, arguments=(), before=None):
        self.port = free_port()
        self.process = subprocess.Popen(
            [PROGRAM, "--listen", f"tcp://127.0.0.1:{self.port}", *arguments], stderr=stderr,
            preexec_fn=before)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def connect(self, limit_s=20):
        """A client that was answered."""
        deadline = time.monotonic() + limit_s
        while True:
            try:
                client = Daemon(port=self.port, timeout=2)
                client.call("daemon.info")
                return client
            except OSError:
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.05)


class Company(unittest.TestCase):
    def test_log_that_nobody_reads(self):
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        filled = 0
        while select.select([], [writer], [], 0)[1]:
            filled += os.write(writer, b"x" * 4096)
        os.set_blocking(writer, True)
        with Running(stderr=writer) as daemon, daemon.connect() as client:
            os.close(writer)
            self.assertIn("listening on", " ".join(r["text"] for r in client.call("log.tail")))
            while filled > 0:
                filled -= len(os.read(reader, filled))
            client.call("daemon.shutdown")
            self.assertEqual(daemon.process.wait(20), 0)
            text = b""
            while piece := os.read(reader, 65536):
                text += piece
            self.assertIn(b"lines of the log are missing here", text)
            self.assertIn(b"stopped", text)
        os.close(reader)

    def test_no_standard_streams(self):
        with Running(stderr=None, before=lambda: [os.close(stream) for stream in (0, 1, 2)]) as daemon, daemon.connect():
            for stream in (0, 1, 2):
                self.assertEqual(os.readlink(f"/proc/{daemon.process.pid}/fd/{stream}"), "/dev/null")

    def test_closed_terminal_ends_it_in_order(self):
        with Running() as daemon, daemon.connect():
            daemon.process.send_signal(signal.SIGHUP)
            self.assertEqual(daemon.process.wait(20), 0)

    def test_no_file_descriptor_is_left(self):
        with Running(arguments=("--set", "limits.clients=1000"),
                     before=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (24, 24))) as daemon:
            daemon.connect().close()
            pause, records = 0.2, []
            while pause < 30 and not any("file descriptors" in text for text in records):
                crowd = [socket.create_connection(("127.0.0.1", daemon.port), 5) for _ in range(60)]
                time.sleep(pause)  # they may be accepted now, or never
                pause *= 2
                for one in crowd:
                    one.close()
                with daemon.connect() as client:
                    records = [r["text"] for r in client.call("log.tail")]
            self.assertTrue(any("file descriptors" in text for text in records), records)

    def test_output_that_cannot_be_written(self):
        for option in ("--print-settings", "--help", "--version", "--check"):
            with open("/dev/full", "wb") as full:
                done = subprocess.run([PROGRAM, option], stdout=full, stderr=subprocess.PIPE, timeout=20)
            self.assertEqual(done.returncode, 1, option)
            self.assertIn(b"stdout", done.stderr)


class Settings(unittest.TestCase):
    def test_addresses_at_which_it_could_not_start(self):
        with Running() as daemon, daemon.connect() as client:
            before = client.call("settings.get")
            for listen in ([], [""], ["bogus://1"], ["tcp://127.0.0.1:99999"], ["tcp://127.0.0.1:1?protocol=x"],
                           ["tcp://127.0.0.1:7000", "tcp://0.0.0.0:7000"]):
                with self.assertRaises(DaemonError, msg=listen) as caught:
                    client.call("settings.set", values={"listen": listen, "period_s": 7})
                self.assertEqual(caught.exception.code, -32003)
                self.assertTrue(caught.exception.data["errors"][0]["path"].startswith("listen"))
            self.assertEqual(client.call("settings.get"), before)
            client.call("settings.set", values={"insecure": True, "listen": ["tcp://0.0.0.0:7000"]})

    def test_restart_is_for_what_differs_from_the_start(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "settings.json")
            with open(file, "w", encoding="utf-8") as out:
                out.write('{"insecure": true}')
            with Running(arguments=("--config", file)) as daemon, daemon.connect() as client:
                self.assertEqual(client.call("daemon.status")["restart_for"], [])
                self.assertEqual(client.call("settings.set", values={"insecure": False})["restart"], ["insecure"])
                self.assertEqual(client.call("daemon.status")["restart_for"], ["insecure"])
                client.call("settings.set", values={"insecure": True})
                self.assertEqual(client.call("daemon.status")["restart_for"], [])

    def test_subscriptions_are_limited(self):
        with Running() as daemon, daemon.connect() as client:
            for _ in range(100):
                client.call("topics.subscribe", topic="temperature", max_rate_hz=0.1)
            with self.assertRaises(DaemonError) as caught:
                client.call("topics.subscribe", topic="temperature")
            self.assertEqual(caught.exception.code, -32007)


if __name__ == "__main__":
    unittest.main()
