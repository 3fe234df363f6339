#!/usr/bin/env python3
"""Recordings lose nothing: under load, beside subscribers that stop reading and foreign packets, when killed, on a full disk."""
import json
import os
import random
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import recording_load as load
from lateness import Lateness
from support import Daemon, DaemonError, wait_for, text_of

KILLS = int(os.environ.get("HERMES_KILLS", 5))
PAUSE_S = float(os.environ.get("HERMES_PAUSE_S", 4))
LOAD_S, BURSTS, BURST_S = (int(x) for x in os.environ.get("HERMES_LOAD", "5 1 2").split())
INPUT_OUTPUT = -32008


def sidecar_of(folder):
    return json.loads(text_of(os.path.join(folder, "velodynelogger.json")))


def capinfos(path):
    """Packets as capinfos counts them, or None where it is not installed."""
    if not shutil.which("capinfos"):
        return None
    told = subprocess.run(["capinfos", "-T", "-M", "-r", "-c", path], capture_output=True, text=True, check=True,
                          stdin=subprocess.DEVNULL)
    assert told.stderr == "", told.stderr
    return int(told.stdout.split("\t")[1])


def tshark_is_content(path):
    if not shutil.which("tshark"):
        return
    told = subprocess.run(["tshark", "-r", path, "-Y", "_ws.malformed || !udp || ip.checksum.status == 0", "-o",
                           "ip.check_checksum:TRUE"], capture_output=True, text=True, check=True, stdin=subprocess.DEVNULL)
    assert told.stdout == "", told.stdout[:300]


class Recording(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def test_load(self):
        privileged = os.geteuid() == 0  # else the system grants a small buffer, which a loaded machine overruns
        figures = load.run(LOAD_S, BURSTS if privileged else 0, BURST_S, self.folder)
        self.assertEqual(figures["lost"], 0)
        print(figures)

    def test_tools_read_every_file(self):
        with load.Logger(self.folder, **{"record.file_bytes": 1000000}) as logger:
            recorded = logger.daemon.call("record.start", name="tools")["folder"]
            data, position, _ = load.sent(logger.send(load.NOMINAL_HZ, 2, 0))
            wait_for("packets", lambda: logger.daemon.call("record.status")["counts"]["packets"] == data + position)
            logger.daemon.call("record.stop")
        sidecar = load.check_files(recorded, 0, data, position)
        self.assertEqual(len(sidecar["files"]), len(load.captures(recorded)))
        self.assertGreater(len(sidecar["files"]), 3)
        for entry, path in zip(sidecar["files"], load.captures(recorded)):
            self.assertEqual((entry["name"], entry["bytes"]), (os.path.basename(path), os.path.getsize(path)))
            self.assertLessEqual(entry["bytes"], 1000000)
            self.assertIn(capinfos(path), (None, entry["packets"]))
            tshark_is_content(path)

    def test_readers_that_stop_cost_no_packet(self):
        with load.Logger(self.folder) as logger:
            stopped = [Daemon(port=logger.process.port, timeout=30) for _ in range(2)]
            for daemon, topic in zip(stopped, ("scan2d", "cloud")):
                daemon.call("topics.subscribe", topic=topic, queue=1000)  # and read no more
            recorded = logger.daemon.call("record.start", name="slow")["folder"]
            data, position, _ = load.sent(logger.send(load.NOMINAL_HZ, PAUSE_S, 0))
            wait_for("packets", lambda: logger.daemon.call("record.status")["counts"]["packets"] == data + position)
            told = logger.daemon.call("record.stop")
            self.assertFalse(any(told["losses"].values()), told)
            load.check_files(recorded, 0, data, position)
            print(f"two readers stopped for {PAUSE_S:.0f} s: none of {data + position} packets lost, at most "
                  f"{logger.peak_mb():.1f} MB resident")
            for daemon in stopped:
                daemon.close()

    def test_foreign_packets_are_recorded_or_counted(self):
        seed = random.randrange(1 << 30)
        dice = random.Random(seed)
        with load.Logger(self.folder) as logger, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            recorded = logger.daemon.call("record.start", name="foreign")["folder"]
            sender = logger.send(load.NOMINAL_HZ, 2, 0)
            sizes = []
            while sender.poll() is None:
                size = dice.choice((0, 1, 511, 512, 513, 1205, 1206, 1207, 2048, 2049, 9000, 65507))
                port = dice.choice((logger.lidar_port, logger.position_port))
                stranger.sendto(dice.randbytes(size), ("127.0.0.1", port))
                sizes.append(size)
                time.sleep(0.002)
            data, position, _ = load.sent(sender)
            fitting, longer = sum(size <= 2048 for size in sizes), sum(size > 2048 for size in sizes)
            wait_for(f"the packets, seed {seed}",
                     lambda: logger.daemon.call("record.status")["counts"]["packets"] == data + position + fitting)
            told = logger.daemon.call("record.stop")
        self.assertEqual(told["losses"], {"missing": 0, "kernel": 0, "queue": 0, "too_long": longer, "unwritten": 0}, seed)
        self.assertEqual(told["counts"]["data"], data, seed)
        own = [load.number_of(payload) for path in load.captures(recorded) for _, payload in load.records(path)
               if len(payload) == load.DATA and payload[:2] == b"\xff\xee"]
        self.assertEqual(own, list(range(data)), seed)
        written = sum(1 for path in load.captures(recorded) for _ in load.records(path))
        self.assertEqual(written, data + position + fitting, seed)

    def test_kill_costs_a_moment(self):
        self.hurry()
        with Lateness() as lateness:
            self.kill_often(lateness)

    def hurry(self):
        """The programs of this test go before others: what a busy machine does to them is another test."""
        before = os.getpriority(os.PRIO_PROCESS, 0)
        try:
            os.setpriority(os.PRIO_PROCESS, 0, -15)
            self.addCleanup(os.setpriority, os.PRIO_PROCESS, 0, before)
        except PermissionError:
            pass

    def kill_often(self, lateness):
        cost = []
        logger = load.Logger(self.folder)
        try:
            for number in range(KILLS):
                recorded = logger.daemon.call("record.start", name=f"kill{number}")["folder"]
                sender = logger.send(load.NOMINAL_HZ, 30, 0)
                wait_for("packets", lambda: logger.daemon.call("record.status")["counts"]["data"] > 100)
                lateness.take_longest()
                time.sleep(random.uniform(0, 1.2))  # at any time
                killed = time.time()
                os.kill(logger.pid, signal.SIGKILL)
                logger.process.process.wait()
                late = lateness.take_longest()
                sender.terminate()
                times = [float(line) for line in sender.communicate()[0].split()]
                logger.daemon.close()
                self.assertIsNone(sidecar_of(recorded)["ended"])
                logger = load.Logger(self.folder)
                wait_for("the sidecar", lambda: sidecar_of(recorded)["ended"] == "cut off")
                self.check_told(logger, f"kill{number}")
                written = self.check_cut_off(recorded)
                # Of the packets that are missing; what holds up a nap here holds up the logger too.
                cost.append(max([0] + [killed - time - 2 * late for time in times[written:]]))
        finally:
            logger.__exit__()
        print(f"kill -9 {KILLS} times: at most {1e3 * max(cost):.0f} ms were lost")
        self.assertLess(max(cost), 0.1)

    def check_told(self, logger, name):
        """That one was cut off; until the next begins."""
        def told():
            return next(one for one in logger.daemon.call("daemon.status")["health"] if one["name"] == "recording")
        wait_for("the health item", lambda: told()["level"] == "warn", 5)
        self.assertIn(f'"{name}" was cut off at 20', told()["message"])
        logger.daemon.call("record.start", name=f"after {name}")
        self.assertEqual(told()["level"], "ok")
        logger.daemon.call("record.stop")

    def check_cut_off(self, folder):
        """The files are whole and agree with the sidecar; gives how many data packets they hold."""
        stamps, numbers = [], []
        for path in load.captures(folder):
            for stamp, payload in load.records(path):
                stamps.append(stamp)
                if len(payload) == load.DATA:
                    numbers.append(load.number_of(payload))
            self.assertIn(capinfos(path), (None, len(stamps)))
        self.assertEqual(numbers, list(range(len(numbers))))
        sidecar = sidecar_of(folder)
        self.assertFalse(sidecar["complete"])
        self.assertEqual(sidecar["counts"]["packets"], len(stamps))
        self.assertEqual(sidecar["counts"]["data"], len(numbers))
        self.assertAlmostEqual(sidecar["end"], stamps[-1] * 1e-9, places=5)
        self.assertEqual(sorted(os.listdir(folder)), ["velodynelogger-0001.pcap", "velodynelogger.json"])
        return len(numbers)

    def small_disk(self, megabytes):
        disk = os.path.join(self.folder, "disk")
        os.mkdir(disk)
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tmpfs", disk], capture_output=True,
                              text=True, check=False)
        if done.returncode != 0:
            self.skipTest("a small disk cannot be mounted here: " + done.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        return disk

    def fill(self, disk, floor):
        with load.Logger(disk, self.folder, **{"record.free_floor_bytes": floor, "record.free_warn_bytes": floor}) as logger:
            recorded = logger.daemon.call("record.start", name="full")["folder"]
            sender = logger.send(load.NOMINAL_HZ, 60, 0)
            try:
                wait_for("the end", lambda: not logger.daemon.call("record.status")["recording"], 40)
            finally:
                sender.kill()
                sender.communicate()
            with self.assertRaises(DaemonError) as caught:
                logger.daemon.call("record.stop")
            self.assertEqual(caught.exception.code, INPUT_OUTPUT)
            status = logger.daemon.call("record.status")
            self.assertEqual(status["error"]["code"], INPUT_OUTPUT, status)
            self.assertTrue(status["error"]["data"]["path"].startswith(recorded), status)
            self.assertEqual(logger.daemon.call("daemon.status")["state"], "degraded")
            numbers = [load.number_of(payload) for path in load.captures(recorded) for _, payload in load.records(path)
                       if len(payload) == load.DATA]
            self.assertEqual(numbers, list(range(len(numbers))))
            sidecar = sidecar_of(recorded)
            self.assertEqual(sidecar["counts"]["packets"], sum(entry["packets"] for entry in sidecar["files"]))
            self.assertEqual(sidecar["counts"], status["counts"])
            self.assertEqual(sidecar["losses"], status["losses"])  # told in one place, and nowhere else otherwise
            self.assertNotIn("lost", sidecar["error"])
            self.assertFalse([name for name in os.listdir(recorded) if name.startswith(".")], "the reserve is left")
            self.assertGreater(len(numbers), 1000)
            shutil.rmtree(recorded)  # room again: the daemon lives
            logger.daemon.call("record.start", name="next")
            logger.daemon.call("record.stop")
            return sidecar

    def test_full_disk(self):
        sidecar = self.fill(self.small_disk(8), 0)
        self.assertEqual((sidecar["ended"], sidecar["complete"]), ("failed", False))

    def test_floor_of_free_space(self):
        sidecar = self.fill(self.small_disk(16), 8000000)
        self.assertEqual((sidecar["ended"], sidecar["complete"]), ("free space", True))
        self.assertFalse(any(sidecar["losses"].values()), sidecar)


if __name__ == "__main__":
    unittest.main(verbosity=2)
