#!/usr/bin/env python3
"""A daemon as a process: command line, exit statuses, signals, service manager, and the Python client."""
import json
import os
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


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=20)


class Running:
    """The daemon at a free port."""

    def __init__(self, *arguments, **environment):
        self.process = subprocess.Popen([PROGRAM, "--listen", "tcp://127.0.0.1:0", *arguments],
                                        stderr=subprocess.PIPE, text=True, env={**os.environ, **environment})
        self.log = ""
        while "listening on" not in self.log:
            line = self.process.stderr.readline()
            if not line:
                raise RuntimeError("the daemon ended: " + self.log)
            self.log += line
        self.port = int(self.log.split("tcp://127.0.0.1:")[1].split(",")[0])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.end()

    def end(self):
        """Waits for the end; the exit status."""
        if not self.process.stderr.closed:
            self.log += self.process.stderr.read()
            self.process.stderr.close()
        return self.process.wait(20)


class CommandLine(unittest.TestCase):
    def test_help_and_version(self):
        shown = run("--help")
        self.assertEqual(shown.returncode, 0)
        for text in ("--config", "--set", "--listen", "--print-settings", "--check", "period_s", "in s"):
            self.assertIn(text, shown.stdout)
        self.assertRegex(run("--version").stdout, r"^hermes-thermometer \d+\.\d+")

    def test_usage_errors_name_the_option(self):
        for arguments, says in ((["--foo"], "--foo"), (["extra"], "extra"), (["--config"], "--config"),
                                (["--set", "period_s"], "--set"), (["--set", "period=1"], "period"),
                                (["--set", "period_s=0"], "from 0.001 to 60"), (["--check=1"], "--check"),
                                (["--config="], "--config needs a value"), (["--listen", ""], "--listen needs a value")):
            shown = run(*arguments)
            self.assertEqual(shown.returncode, 2, arguments)
            self.assertIn(says, shown.stderr.splitlines()[-1], "the supervisor shows the last line")
            self.assertEqual(shown.stdout, "")

    def test_print_settings(self):
        shown = run("--set", "period_s=2", "--set", "sensor.name=kitchen", "--print-settings")
        settings = json.loads(shown.stdout)
        self.assertEqual((settings["period_s"], settings["sensor"]["name"]), (2, "kitchen"))
        self.assertEqual(settings["limits"]["clients"], 16)

    def test_check_and_bad_files(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "settings.json")
            for text, status, says in (('{"period_s": 3}', 0, ""), ('{"perod_s": 3}', 1, "perod_s is 3"),
                                       ('{"period_s":\n 3,,}', 1, "line 2"), ('{"sensor": {"nam": 1}}', 1, "sensor.nam")):
                with open(file, "w", encoding="utf-8") as out:
                    out.write(text)
                shown = run("--config", file, "--check")
                self.assertEqual(shown.returncode, status, text)
                self.assertIn(says, shown.stderr)
                if status:
                    self.assertIn(file, shown.stderr)
                self.assertEqual(os.listdir(folder), ["settings.json"])
            self.assertEqual(run("--config", file + "x").returncode, 1)

    def test_port_in_use(self):
        with Running() as daemon:
            shown = run("--listen", f"tcp://127.0.0.1:{daemon.port}")
            self.assertEqual(shown.returncode, 1)
            self.assertIn(f"port {daemon.port} of 127.0.0.1 is already in use", shown.stderr)

    def test_an_address_that_cannot_be_had_yet_ends_nothing(self):
        with tempfile.TemporaryDirectory() as folder, Running() as other:
            busy = f"tcp://127.0.0.1:{other.port}"
            keys = f"tls://127.0.0.1:0?keys={folder}/keys"  # none yet
            with Running("--listen", busy, "--listen", keys) as daemon, Daemon(port=daemon.port) as client:
                def channel():
                    return next(item for item in client.call("daemon.status")["health"] if item["name"] == "channel")
                self.assertEqual(channel()["level"], "error")
                self.assertIn(f"port {other.port} of 127.0.0.1 is already in use", channel()["message"])
                self.assertIn(f"{folder}/keys", channel()["message"])
                other.process.kill()
                other.end()
                until = time.monotonic() + 30
                while len(client.call("daemon.info")["listen"]) < 2 and time.monotonic() < until:
                    time.sleep(0.05)
                self.assertIn(busy, client.call("daemon.info")["listen"])
                with Daemon(port=other.port) as late:
                    late.call("daemon.info")
                self.assertEqual(channel()["level"], "error")
                self.assertNotIn(str(other.port), channel()["message"])

    def test_a_service_waits_for_its_only_address(self):
        with tempfile.TemporaryDirectory() as folder, Running() as other:
            process = subprocess.Popen([PROGRAM, "--listen", f"tcp://127.0.0.1:{other.port}"], stderr=subprocess.PIPE, text=True,
                                       env={**os.environ, "NOTIFY_SOCKET": os.path.join(folder, "nobody")})
            line = ""
            while "tried again" not in line:
                line = process.stderr.readline()
                self.assertTrue(line, "it ended")
            other.process.kill()
            other.end()
            while "listening on" not in line:
                line = process.stderr.readline()
                self.assertTrue(line, "it ended")
            process.terminate()
            process.stderr.close()
            self.assertEqual(process.wait(20), 0)

    def test_network_is_refused(self):
        shown = run("--listen", "tcp://0.0.0.0:0")
        self.assertEqual(shown.returncode, 1)
        self.assertIn("insecure", shown.stderr)


class Life(unittest.TestCase):
    def test_signals_end_it_in_order(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            with Running() as daemon, Daemon(port=daemon.port) as client:
                client.call("daemon.info")
                daemon.process.send_signal(number)
                self.assertEqual(daemon.end(), 0)
                self.assertIn("stopped", daemon.log)
                with self.assertRaises(ConnectionError):
                    client.call("daemon.info")

    def test_shutdown_command_answers_first(self):
        with Running() as daemon, Daemon(port=daemon.port) as client:
            self.assertIsNone(client.call("daemon.shutdown"))
            self.assertEqual(daemon.end(), 0)

    def test_service_manager_hears(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
            path = os.path.join(folder, "notify")
            manager.bind(path)
            manager.settimeout(10)
            with Running(NOTIFY_SOCKET=path, WATCHDOG_USEC="100000") as daemon:
                self.assertEqual(manager.recv(100), b"READY=1")
                self.assertEqual(manager.recv(100), b"WATCHDOG=1")
                self.assertEqual(manager.recv(100), b"WATCHDOG=1")
                daemon.process.terminate()
                daemon.end()
            heard = manager.recv(100)
            while heard == b"WATCHDOG=1":
                heard = manager.recv(100)
            self.assertEqual(heard, b"STOPPING=1")

    def test_settings_are_saved(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "settings.json")
            with open(file, "w", encoding="utf-8") as out:
                out.write("{}")
            with Running("--config", file) as daemon, Daemon(port=daemon.port) as client:
                client.call("settings.set", values={"period_s": 7})
                self.assertEqual(client.call("settings.save"), {"path": file})
            with open(file, encoding="utf-8") as saved:
                self.assertEqual(json.load(saved)["period_s"], 7)


class PythonClient(unittest.TestCase):
    def test_calls_and_errors(self):
        with Running() as daemon, Daemon(port=daemon.port) as client:
            self.assertAlmostEqual(client.call("thermometer.read", unit="K"), 293, delta=3)
            self.assertEqual(client.call("thermometer.echo", value={"a": [1, None]}), {"a": [1, None]})
            self.assertIsNone(client.call("thermometer.calibrate", offset_k=1))
            with self.assertRaises(DaemonError) as caught:
                client.call("thermometer.read", unit="F")
            self.assertEqual(caught.exception.code, -32602)
            self.assertEqual(caught.exception.data["errors"][0]["path"], "unit")

    def test_topics(self):
        with Running("--set", "period_s=0.005") as daemon, Daemon(port=daemon.port) as client:
            extremes = client.subscribe("extremes")
            readings = client.subscribe("temperature", queue=100)
            self.assertEqual(next(extremes)["data"]["least"], 19)
            messages = [next(readings) for _ in range(20)]
            first = messages[0]["seq"]
            self.assertEqual([m["seq"] for m in messages], list(range(first, first + 20)))
            client.call("daemon.info")


if __name__ == "__main__":
    unittest.main()
