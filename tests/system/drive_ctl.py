#!/usr/bin/env python3
"""hermesctl drive on a simulated robot: it moves while hermesctl runs, and stands whichever way that ends."""
import functools
import json
import math
import os
import pty
import signal
import socket
import subprocess
import sys
import tempfile
import termios
import threading
import time
import unittest
from unittest import mock

from support import BINARIES, HERMESCTL, Process, free_port, release, simulated_hall, wait_for

TOO_LATE = -32004  # on a busy machine the simulated controllers may answer too late; the robot has halted


os.environ.pop("SSH_CONNECTION", None)  # of who runs this


class Keys:
    """hermesctl drive at a terminal of its own."""

    def __init__(self, address, before=b""):
        self.terminal, far = pty.openpty()
        os.write(self.terminal, before)
        self.before = termios.tcgetattr(far)
        self.far = far
        self.process = subprocess.Popen([HERMESCTL, "drive", address], stdin=far, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)

    def press(self, keys):
        os.write(self.terminal, keys)

    def end(self):
        shown, said = self.process.communicate(timeout=60)
        assert termios.tcgetattr(self.far) == self.before, "the terminal is not as it was"
        os.close(self.terminal)
        os.close(self.far)
        return self.process.returncode, shown, said


def again_after_a_fault(test):
    """The same test, made once more where the log has a fault: on a busy machine the simulated controllers answer too late."""
    @functools.wraps(test)
    def patient(self):
        before = self.faults()
        try:
            return test(self)
        except AssertionError:
            new = [line for line in self.faults() if line not in before]
            if not new:
                raise
        print(f"{test.__name__} is made once more:", *new, sep="\n    ", file=sys.stderr)
        self.doCleanups()
        self.setUp()
        return test(self)
    return patient


class Drive(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        try:
            os.nice(-15)  # the daemons too
        except PermissionError:
            pass
        cls.folder = tempfile.TemporaryDirectory()
        cls.simulator, link = simulated_hall(cls.folder.name)
        cls.sim = cls.simulator.connect()
        url = f"serial://{link}?baud=115200"
        cls.motorcontrol = Process(BINARIES, "motorcontrol", free_port(0), cls.folder.name,
                                   {"controllers.1.url": url, "controllers.2.url": url})
        cls.motors = cls.motorcontrol.connect()
        cls.address = f"127.0.0.1:{cls.motorcontrol.port}"

    @classmethod
    def tearDownClass(cls):
        for process in (cls.motorcontrol, cls.simulator):
            process.stop()
        cls.folder.cleanup()

    def setUp(self):
        wait_for("ready", lambda: self.motors.call("motor.state")["ready"])
        release(self.motors)
        wait_for("free control", lambda: not self.motors.call("control.state")["held"])

    def faults(self):
        return [line for line in self.motors.call("log.tail", count=1000) if line["level"] in ("warning", "error")]

    def speeds(self):
        twist = self.sim.call("sim.state")["twist"]
        return math.hypot(twist["vx"], twist["vy"]), twist["omega"]

    def way_since(self, before):
        pose = self.motors.call("motor.state")["pose"]
        return math.hypot(pose["x"] - before["x"], pose["y"] - before["y"])

    def stands(self):
        return self.speeds() == (0, 0)

    def stands_for(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.assertTrue(self.stands())

    def run_ctl(self, *arguments, status=0):
        for _ in range(5):
            done = subprocess.run([HERMESCTL, "drive", self.address, *arguments], stdin=subprocess.DEVNULL,
                                  capture_output=True, text=True, timeout=60)
            if done.returncode != 1 or f"({TOO_LATE})" not in done.stderr:
                break
            self.setUp()
        self.assertEqual(done.returncode, status, done.stderr + done.stdout)
        self.said = done.stderr
        return done.stdout if status == 0 else done.stderr

    def begun(self, *arguments):
        """A hermesctl that drives."""
        process = subprocess.Popen([HERMESCTL, "drive", self.address, *arguments], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        wait_for("motion", lambda: self.speeds()[0] > 0.1 or process.poll() is not None)
        self.assertIsNone(process.poll())
        return process

    def test_for_a_time(self):
        before = self.sim.call("sim.state")["pose"]
        told = json.loads(self.run_ctl("vx=0.2", "--for", "2", "--json"))
        progress = [json.loads(line)["progress"] for line in self.said.splitlines()]
        self.assertEqual([p["done"] for p in progress], sorted(p["done"] for p in progress))
        self.assertEqual({p["total"] for p in progress}, {2})
        self.assertEqual((progress[-1]["done"], progress[-1]["left_s"]), (2, 0))
        self.assertTrue(self.stands())
        self.assertGreaterEqual(told["seconds"], 2)
        after = self.sim.call("sim.state")["pose"]
        way = math.hypot(after["x"] - before["x"], after["y"] - before["y"])
        self.assertAlmostEqual(told["moved"]["x"], way, delta=0.01)
        self.assertGreater(way, 0.1)
        self.assertFalse(self.motors.call("control.state")["held"])
        self.assertRegex(self.run_ctl("omega=0.5", "--for=0.5"), r"drove for 0\.\d s and stands; .* degrees, and is at x ")

    @again_after_a_fault
    def test_signals(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            process = self.begun("vx=0.3", "vy=-0.1")
            process.send_signal(number)
            shown, said = process.communicate(timeout=60)
            self.assertEqual((process.returncode, said), (0, ""))
            self.assertIn("and stands", shown)
            self.assertTrue(self.stands())

    @again_after_a_fault
    def test_killed(self):
        process = self.begun("vx=0.3")
        process.kill()
        process.communicate()
        wait_for("standing", self.stands, 10)

    def test_connection_lost(self):
        process = self.begun("vx=0.3")
        os.kill(self.motorcontrol.process.pid, signal.SIGKILL)
        _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1)
        self.assertIn("stops a robot whose driver has gone", said)
        self.assertIn("the controllers stop by their own time-out", said)  # where it is the motor control that has ended
        wait_for("standing", self.stands, 10)
        self.tearDownClass()
        self.setUpClass()

    def test_who_stopped_the_robot(self):
        for takes in (("motor.stop", {}), ("control.acquire", {"client": "ben", "timeout_s": 1, "take_over": True})):
            process = self.begun("vx=0.3")
            self.motors.call(takes[0], **takes[1])
            _, said = process.communicate(timeout=60)
            halted = self.motors.call("motor.state")["halted"]
            self.assertEqual(process.returncode, 1)
            self.assertRegex(said, "the robot had stopped: .*" + ("stop" if takes[0] == "motor.stop" else "ben took the control over from hermesctl"))
            self.assertNotIn("control.acquire first", said)
            self.assertTrue(halted)
            wait_for("standing", self.stands, 10)

    @again_after_a_fault
    def test_whose_company_has_gone(self):
        for streams in ("stdin", "stdout", "stderr"):
            ends = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, streams: subprocess.PIPE}
            process = subprocess.Popen([HERMESCTL, "drive", self.address, "vx=0.3"], **ends)
            self.addCleanup(process.kill)
            wait_for("motion", lambda: self.speeds()[0] > 0.1)
            getattr(process, streams).close()
            wait_for("standing", self.stands, 10)
            self.assertIsNotNone(process.wait(20), streams)

    @again_after_a_fault
    def test_a_reader_who_does_not_read(self):
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        try:
            while os.write(writer, b"x" * 4096):
                pass
        except BlockingIOError:
            os.set_blocking(writer, True)
        process = subprocess.Popen([HERMESCTL, "drive", self.address, "vx=0.3", "--json"], stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=writer)
        self.addCleanup(process.kill)
        os.close(writer)
        wait_for("motion", lambda: self.speeds()[0] > 0.1)
        begun = self.motors.call("motor.state")["pose"]
        # Progress is told after a second.
        wait_for("a way", lambda: self.way_since(begun) > 0.4 or self.motors.call("motor.state")["halted"])
        self.assertGreater(self.way_since(begun), 0.4)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(20), 0)
        process.stdout.close()
        os.close(reader)
        self.assertTrue(self.stands())

    @again_after_a_fault
    def test_keys_of_before(self):
        keys = Keys(self.address, before=b"wwww")
        wait_for("the control", lambda: self.motors.call("control.state")["held"])
        self.stands_for(0.7)
        wait_for("motion", lambda: keys.press(b"w") or self.speeds()[0] > 0.1)
        keys.process.send_signal(signal.SIGSTOP)
        keys.press(b"wwww")
        wait_for("standing", self.stands)
        time.sleep(0.5)  # a key is held for 0.3 s
        keys.process.send_signal(signal.SIGCONT)
        self.stands_for(0.7)
        keys.press(b"q")
        keys.end()

    def test_commands_that_all_come_too_late(self):
        with socket.create_server(("127.0.0.1", 0)) as slow:
            threading.Thread(target=self.delay, args=(slow, 0.3), daemon=True).start()
            done = subprocess.run([HERMESCTL, "drive", f"127.0.0.1:{slow.getsockname()[1]}", "vx=0.2", "--for", "1"],
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("the robot obeyed none of", done.stderr)

    def delay(self, slow, seconds):
        """Passes on to the motor control and back what one client sends, so much later."""
        near, _ = slow.accept()
        far = socket.create_connection(("127.0.0.1", self.motorcontrol.port))

        timers = []

        def carry(source, target):
            while data := source.recv(65536):
                timers.append(threading.Timer(seconds, target.sendall, (data,)))
                timers[-1].start()
        back = threading.Thread(target=carry, args=(far, near))
        back.start()
        carry(near, far)
        for timer in timers:
            timer.join()
        far.shutdown(socket.SHUT_RDWR)
        back.join()
        near.close()
        far.close()

    def test_keys(self):
        keys = Keys(self.address)
        for key, moves in ((b"w", lambda: self.speeds()[0] > 0.1), (b"\x1b[D", lambda: self.speeds()[1] > 0.2),
                           (b"d", lambda: self.speeds()[1] < -0.2)):
            def pressed(key=key, moves=moves):
                keys.press(key)
                return moves() or keys.process.poll() is not None
            wait_for(f"motion by {key}", pressed, 20)
            wait_for("standing without a key", self.stands, 10)
        keys.press(b"q")
        status, shown, said = keys.end()
        self.assertEqual(status, 0, said)
        self.assertIn("and stands", shown)
        self.assertIn("arrows or W A S D", said)

    def test_terminal_that_goes(self):
        keys = Keys(self.address)
        wait_for("the control", lambda: self.motors.call("control.state")["held"])
        os.close(keys.terminal)
        shown, said = keys.process.communicate(timeout=60)
        os.close(keys.far)
        self.assertEqual(keys.process.returncode, 0, said)
        self.assertIn("and stands", shown)

    def test_stop_of_all(self):
        def stopped(*words, status=0):
            done = subprocess.run([HERMESCTL, *words], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, status, done)
            return done.stdout + done.stderr
        nobody = f"127.0.0.1:{free_port(0)}"
        with tempfile.TemporaryDirectory() as folder:
            entry = {"name": "wheels", "program": "/bin/sleep", "arguments": ["600"], "port": self.motorcontrol.port, "autostart": False}
            supervisor = Process(BINARIES, "supervisor", free_port(0), folder, {"processes": json.dumps([entry])})
            try:
                supervisor.connect().close()
                for words, status in ((("stop", nobody, self.address), 1), (("stop", f"127.0.0.1:{supervisor.port}"), 0)):
                    process = self.begun("vx=0.3")
                    said = stopped(*words, status=status)
                    self.assertIn(f"127.0.0.1:{self.motorcontrol.port}: stands", said)
                    self.assertEqual(nobody in said, nobody in words)  # who was named and is not there is told
                    self.assertEqual(process.wait(20), 1)  # it has lost the control
                    process.communicate()
                    self.assertFalse(self.motors.call("motor.state")["estop"])
                told = json.loads(stopped("estop", f"127.0.0.1:{supervisor.port}", self.address, "--json"))
            finally:
                supervisor.stop()
        self.assertEqual([robot["confirmed"] for robot in told], [True])
        self.assertTrue(self.motors.call("motor.state")["estop"])
        self.assertIn("no robot is there", stopped("stop", nobody, status=1))

    def test_without_an_end_it_ends(self):
        self.assertRegex(self.run_ctl("vx=0.05"), r"drove for 10\.\d s and stands")

    def test_refusals(self):
        self.assertIn("vx is 99, expected a number from -1 to 1 m/s", self.run_ctl("vx=99", status=1))
        self.assertIn("did you mean", self.run_ctl("omga=1", status=2))
        self.assertIn('vx is "fast", expected a number of m/s', self.run_ctl("vx=fast", status=2))
        self.assertIn("vx is there twice", self.run_ctl("vx=1", "vx=0", status=2))
        self.assertIn("terminal for keys", self.run_ctl(status=2))
        with mock.patch.dict(os.environ, SSH_CONNECTION="192.168.7.2 50000 192.168.7.1 22"):
            self.assertIn("over ssh a drive with a velocity needs --for S", self.run_ctl("vx=0.1", status=2))
            self.run_ctl("vx=0.1", "--for", "0.5")
        self.motors.call("control.acquire", client="another", timeout_s=10)
        self.assertIn("another holds the control", self.run_ctl("vx=0.1", status=1))
        self.motors.call("control.release")
        self.motors.call("motor.estop")
        self.assertIn("motor.reset_estop releases it", self.run_ctl("vx=0.1", status=1))


if __name__ == "__main__":
    unittest.main()
