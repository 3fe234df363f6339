#!/usr/bin/env python3
"""hermesctl conform: real daemons and the examples of the manual conform, and each robot of wrong_robot.py fails in the right line."""
import concurrent.futures
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from support import BINARIES, HERMESCTL, SOURCE, WORLD, Daemon, Process, free_port, simulated_hall, socket, wait_for
from wrong_robot import FAULTS

EXAMPLES = os.path.join(SOURCE, "docs", "examples")


def conform(what, port, *options):
    """Its exit status, the lines that do not hold, and all that it has printed."""
    shown = subprocess.run([HERMESCTL, "conform", what, f"127.0.0.1:{port}", *options, "--json"], capture_output=True, text=True, timeout=120, check=False)
    lines = [json.loads(line) for line in shown.stdout.splitlines()]
    return shown.returncode, [line["what"] for line in lines if line["level"] == "fail"], shown.stdout + shown.stderr


class Conform(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def script(self, path, *arguments):
        """A daemon in Python that answers; its port."""
        port = free_port(0)
        process = subprocess.Popen([sys.executable, path, "--port", str(port), *map(str, arguments)], stdout=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)

        def connects():
            try:
                Daemon(port=port).close()
                return True
            except OSError:
                return False
        wait_for(path, connects)
        return port

    def conforms(self, what, port, *options):
        for _ in range(2):  # on a busy machine this program sees late what happens
            status, failed, text = conform(what, port, *options)
            if status == 0:
                break
        self.assertEqual((status, failed), (0, []), text)

    def test_motorcontrol_and_velodynelogger(self):
        lidar = free_port(0, socket.SOCK_DGRAM)
        simulator, link = simulated_hall(self.folder, pose=(1, 2, 0), **{"lidar.port": lidar})
        self.addCleanup(simulator.stop)
        url = f"serial://{link}?baud=115200"
        wait_for("the line", lambda: os.path.exists(link))
        motors = Process(BINARIES, "motorcontrol", free_port(0), self.folder, {"controllers.1.url": url, "controllers.2.url": url})
        self.addCleanup(motors.stop)
        logger = Process(BINARIES, "velodynelogger", free_port(0), self.folder, {"source.port": lidar, "record.folder": self.folder})
        self.addCleanup(logger.stop)
        for daemon in (motors, logger):
            daemon.connect().close()
        self.conforms("motor", motors.port, "--yes")
        self.conforms("scanner", logger.port, "--base", f"127.0.0.1:{motors.port}", "--yes")

    def test_the_examples(self):
        self.conforms("motor", self.script(os.path.join(EXAMPLES, "base.py")), "--yes")
        simulator = Process(BINARIES, "simulator", free_port(0), self.folder, {"world": WORLD})
        self.addCleanup(simulator.stop)
        simulator.connect().close()
        link = os.path.join(self.folder, "laser")
        sensor = subprocess.Popen([sys.executable, os.path.join(EXAMPLES, "simulated_ld06.py"), WORLD, link, "--port", str(simulator.port)])
        self.addCleanup(sensor.wait)
        self.addCleanup(sensor.kill)
        wait_for("the line", lambda: os.path.exists(link))
        laser = self.script(os.path.join(EXAMPLES, "scan2d.py"), "--set", f"device={link}")
        time.sleep(1)  # whole turns
        self.conforms("scanner", laser)

    def test_wrong_robots(self):
        def found(fault):
            tester, line = FAULTS.get(fault, ("base", None))
            port = self.script(os.path.join(SOURCE, "tests", "system", "wrong_robot.py"), "--set", f"fault={fault}")
            options = ["--yes"] if tester == "motor" else ["--yes", "--base", f"127.0.0.1:{port}"] if tester == "base" else []
            status, failed, text = conform("motor" if tester == "motor" else "scanner", port, *options)
            good = status == 0 and not failed if line is None else status == 1 and line in failed and len(failed) <= 6
            return "" if good else f"{fault}: status {status}, expected \"{line}\", found {failed}\n{text}"
        with concurrent.futures.ThreadPoolExecutor(12) as pool:
            wrong = [text for text in pool.map(found, ["", *FAULTS]) if text]
        self.assertFalse(wrong, "\n".join(wrong))

    def test_wheels_that_may_not_be_free(self):
        port = self.script(os.path.join(EXAMPLES, "base.py"))
        status, _, text = conform("motor", port)
        self.assertEqual(status, 1)
        self.assertIn("lift them off the ground", text)

    def test_a_signal_stops_the_robot(self):
        port = self.script(os.path.join(EXAMPLES, "base.py"))
        with subprocess.Popen([HERMESCTL, "conform", "motor", f"127.0.0.1:{port}", "--yes"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as tester, Daemon(port=port) as base:
            wait_for("the robot drives", lambda: base.call("motor.state")["twist"]["vx"] > 0.05)
            tester.send_signal(signal.SIGINT)
            self.assertIn("ended before all was tried", tester.communicate(timeout=20)[1])
            self.assertEqual(tester.returncode, 1)
            state = base.call("motor.state")
            self.assertTrue(state["standing"]["confirmed"] and not state["control"]["held"], state)


if __name__ == "__main__":
    unittest.main()
