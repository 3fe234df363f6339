#!/usr/bin/env python3
"""hermes-recorder beside a whole robot: every topic is in the files as another subscriber saw it, and a session goes on whoever
is killed."""
import glob
import json
import os
import shutil
import signal
import socket
import sys
import tempfile
import threading
import time
import unittest

from support import BINARIES, SOURCE, WORLD, Daemon, DaemonError, Process, free_port, wait_for

sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
import mcap_reader  # noqa: E402  pylint: disable=wrong-import-position

KILLS = int(os.environ.get("HERMES_KILLS", "3"))
COMPARED = {"motorcontrol/odometry", "motorcontrol/wheels", "velodynelogger/scan2d", "velodynelogger/lidar", "scanmatcher/pose",
            "seriallogger/serial"}


class Seen(threading.Thread):
    """All messages of a topic from now on, by their numbers."""

    def __init__(self, port, topic):
        super().__init__(daemon=True)
        self.messages = {}
        self.connection = Daemon(port=port, timeout=None)
        self.stream = self.connection.subscribe(topic, queue=1000)
        self.start()

    def run(self):
        try:
            for message in self.stream:
                self.messages[message["seq"]] = message
        except (OSError, ValueError):
            pass  # closed


class Robot:
    """The daemons of the demo, a serial logger and a recorder."""

    def __init__(self, folder):
        self.folder, self.records = folder, os.path.join(folder, "records")
        lidar, line, gps = free_port(0, socket.SOCK_DGRAM), os.path.join(folder, "motors"), os.path.join(folder, "gps")
        self.ports = {name: free_port(0) for name in
                      ("simulator", "motorcontrol", "velodynelogger", "seriallogger", "scanmatcher", "recorder")}
        self.processes, self.daemons = {}, {}
        serial = f"serial://{line}?baud=115200"
        keep = {"record.folder": self.records, "record.free_floor_bytes": 0, "record.free_warn_bytes": 0}
        self.settings = {
            "simulator": {"world": WORLD, "lidar.port": lidar, "motors.link": line, "gps.link": gps},
            "velodynelogger": {"source.port": lidar, **keep},
            "seriallogger": {"ports": json.dumps([{"name": "gps", "url": f"serial://{gps}?baud=9600", "view": "nmea"}]), **keep},
            "motorcontrol": {"controllers.1.url": serial, "controllers.2.url": serial},
            "scanmatcher": {"source.address": f"127.0.0.1:{self.ports['velodynelogger']}", "matcher.start": "mapping",
                            "odometry.address": f"127.0.0.1:{self.ports['motorcontrol']}", "map.folder": folder},
            "recorder": {"daemons": json.dumps([f"127.0.0.1:{port}" for name, port in self.ports.items() if name != "recorder"]),
                         **keep}}
        for name in self.settings:
            self.start(name)
        self.recorder = self.daemons["recorder"]
        wait_for("the daemons", lambda: "5 daemons" in self.health("daemons"))
        wait_for("poses", lambda: self.daemons["scanmatcher"].call("matcher.state")["scans"] > 0)
        wait_for("the wheels", lambda: self.daemons["motorcontrol"].call("motor.state")["ready"])

    def start(self, name):
        self.processes[name] = Process(BINARIES, name, self.ports[name], self.folder, self.settings[name])
        self.daemons[name] = self.processes[name].connect()
        self.recorder = self.daemons.get("recorder")

    def kill(self, name):
        self.processes[name].process.send_signal(signal.SIGKILL)
        self.processes[name].process.wait()

    def health(self, item):
        return next(one["message"] for one in self.recorder.call("daemon.status")["health"] if one["name"] == item)

    def stop(self):
        for process in reversed(list(self.processes.values())):
            process.stop()

    def files(self, name):
        """Of a session: whole files, or the reader of the tests raises."""
        return [mcap_reader.Mcap(path) for path in sorted(glob.glob(os.path.join(self.records, name, "recorder-*.mcap")))]


class Recorder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        self.robot = Robot(folder)
        self.addCleanup(self.robot.stop)
        self.call = lambda method, **params: self.robot.recorder.call(method, **params)

    def test_every_message_is_in_the_file(self):
        seen = {}
        for topic in COMPARED:
            daemon, name = topic.split("/")
            seen[topic] = Seen(self.robot.ports[daemon], name)
        state = self.call("session.start", name="drive")
        self.assertEqual(state["state"], "recording")
        self.assertEqual({part["daemon"] for part in state["parts"]}, {"recorder", "velodynelogger", "seriallogger"})
        with Daemon(port=self.robot.ports["motorcontrol"]) as motors:
            motors.call("control.acquire", timeout_s=5)
            motors.call("motor.drive", vx=0.2)
            wait_for("messages", lambda: all(len(one.messages) > 5 for one in seen.values()))
            motors.call("motor.stop")
        self.assertAlmostEqual(self.call("session.mark", text="a door")["t_s"], self.call("session.state")["duration_s"], delta=1)
        stopped = self.call("session.stop")
        self.assertEqual(stopped["problems"], [])
        self.assertEqual({part["state"] for part in stopped["parts"]}, {"stopped"})
        (file,) = self.robot.files("drive")
        by_topic = {}
        for message in file.messages:
            by_topic.setdefault(file.channels[message.channel].topic, {})[message.sequence] = message
        for topic, listener in seen.items():
            common = set(by_topic[topic]) & set(listener.messages)
            self.assertGreater(len(common), 2, topic)
            self.assertEqual(common, set(range(min(common), max(common) + 1)), topic)
            for number in common - {min(common)}:  # that of the snapshot with which a subscription begins
                self.assertEqual(json.loads(by_topic[topic][number].data), listener.messages[number]["data"], topic)
                self.assertAlmostEqual(by_topic[topic][number].publish_time * 1e-9, listener.messages[number]["stamp"], delta=1e-5)
        self.assertEqual(json.loads(next(iter(by_topic["recorder/marks"].values())).data)["text"], "a door")
        methods = [json.loads(message.data)["method"] for message in by_topic["motorcontrol/commands"].values()]
        self.assertIn("motor.drive", methods)
        self.assertIn("motor.stop", methods)
        self.assertIn("simulator/settings", by_topic)
        (listed,) = self.call("session.list")
        self.assertEqual((listed["name"], listed["problems"]), ("drive", []))

    def test_killed_recorder_goes_on(self):
        self.call("session.start", name="drive")
        killed = []
        for _ in range(KILLS):
            self.wait_for_messages(400)  # more than come in a second
            killed.append(time.time())
            self.robot.kill("recorder")
            self.robot.start("recorder")
            wait_for("the session", lambda: self.call("session.state")["state"] == "recording")
        self.wait_for_messages(50)
        state = self.call("session.stop")
        self.assertEqual({part["daemon"]: part["state"] for part in state["parts"]},
                         {"recorder": "stopped", "velodynelogger": "stopped", "seriallogger": "stopped"})
        files = self.robot.files("drive")
        self.assertEqual(len(files), KILLS + 1)
        for end, file in zip(killed, files):  # a second, and what a kill and a busy machine take
            self.assertLess(end - max(message.log_time for message in file.messages) * 1e-9, 1.5)
        stamps = [message.log_time for file in files for message in file.messages]
        self.assertEqual(stamps, sorted(stamps))

    def wait_for_messages(self, more):
        count = lambda: next((part["counts"].get("messages", 0) for part in self.call("session.state")["parts"]
                              if part["daemon"] == "recorder"), 0)
        before = count()
        wait_for("messages", lambda: count() > before + more)

    def test_replay_is_the_drive_again(self):
        self.call("session.start", name="drive")
        with Daemon(port=self.robot.ports["motorcontrol"]) as motors:
            motors.call("control.acquire", timeout_s=5)
            end = time.monotonic() + 2
            while time.monotonic() < end:
                motors.call("motor.drive", vx=0.3)
                time.sleep(0.1)
            motors.call("motor.stop")
            motors.call("control.release")
        self.call("session.stop")
        seen = {topic: Seen(self.robot.ports[topic.split("/")[0]], topic.split("/")[1])
                for topic in ("motorcontrol/odometry", "scanmatcher/pose", "velodynelogger/scan2d")}
        stands = lambda: max(map(abs, self.robot.daemons["simulator"].call("sim.state")["motors"]["wheels_rps"])) < 1e-6
        wait_for("the standstill", stands)
        wheels = self.robot.daemons["simulator"].call("sim.state")["pose"]
        self.call("session.replay", name="drive")
        wait_for("the end", lambda: self.call("session.state")["state"] == "idle")
        for topic, listener in seen.items():
            replayed = [message for message in listener.messages.values() if message.get("replayed") or message["data"].get("replayed")]
            self.assertGreater(len(replayed), 5, topic)
        self.assertEqual(self.robot.daemons["simulator"].call("sim.state")["pose"], wheels)

    def drive(self, connection, until, limit_s=20):
        """Drives with that connection until it is refused, or that holds."""
        deadline = time.monotonic() + limit_s
        while not until() and time.monotonic() < deadline:
            try:
                connection.call("motor.drive", vx=0.1)
            except DaemonError:
                return
            time.sleep(0.05)

    def test_a_ring_becomes_a_session(self):
        self.call("settings.set", values={"record": {"ring_s": 30}})
        self.call("session.start", name="before")  # whose topics have other numbers
        self.call("session.stop")
        with Daemon(port=self.robot.ports["motorcontrol"]) as motors:
            motors.call("control.acquire", timeout_s=5)
            end = time.monotonic() + 2
            self.drive(motors, lambda: time.monotonic() > end)
            self.robot.daemons["motorcontrol"].call("motor.stop")
        wait_for("the alarm", lambda: self.call("session.state")["name"].startswith("ring-"))
        wait_for("its end", lambda: self.call("session.state")["state"] == "idle")
        kept = self.call("session.list")[0]["name"]
        self.assertIn("Cause: STOP", self.call("session.explain", name=kept)["text"])
        self.assertGreater(self.call("session.info", name=kept)["duration_s"], 6)
        (file,) = self.robot.files(kept)
        self.assertGreater(file.counts()["motorcontrol/odometry"], 100 + 4 * 50)
        for message in file.messages:  # each in its own channel
            if file.channels[message.channel].topic == "motorcontrol/odometry":
                self.assertIn("twist", json.loads(message.data))

    def test_one_thing_at_a_time(self):
        for name in ("one", "two"):
            self.call("session.start", name=name)
            with self.assertRaisesRegex(DaemonError, "is being recorded"):
                self.call("session.replay", name=name)
            self.call("session.stop")
        self.call("session.replay", name="one", paused=True)
        self.assertEqual(self.call("session.replay", name="two", paused=True)["name"], "two")
        with self.assertRaisesRegex(DaemonError, "is replayed"):
            self.call("session.start", name="three")
        self.assertEqual(self.call("session.live")["state"], "idle")

    def test_who_dies_or_hangs_holds_nothing_up(self):
        lidar, motors = self.robot.daemons["velodynelogger"], self.robot.daemons["motorcontrol"]
        self.call("session.start", name="one")
        hung = self.robot.processes["velodynelogger"].process
        hung.send_signal(signal.SIGSTOP)
        self.assertIn("silent", [part["state"] for part in self.call("session.stop")["parts"]])
        hung.send_signal(signal.SIGCONT)
        wait_for("the end of its part", lambda: not lidar.call("record.status")["recording"])
        self.call("session.start", name="two")
        motors.call("control.acquire", client="driver", timeout_s=5)
        end = time.monotonic() + 1
        self.drive(motors, lambda: time.monotonic() > end)
        for name in ("motorcontrol", "velodynelogger"):
            self.robot.kill(name)
            self.robot.start(name)
        lidar = self.robot.daemons["velodynelogger"]
        wait_for("the lidar's part", lambda: lidar.call("record.status")["recording"])
        wait_for("it", lambda: "5 daemons" in self.robot.health("daemons"))
        wait_for("packets", lambda: lidar.call("record.status")["counts"]["packets"] > 0)
        part = next(part for part in self.call("session.stop")["parts"] if part["daemon"] == "velodynelogger")
        self.assertEqual((part["state"], part["losses"]["interruptions"]), ("stopped", 1))
        self.assertEqual(len(glob.glob(os.path.join(self.robot.records, "two", "*.pcap"))), 2)
        self.assertIn("Cause: motor control was ended or killed", self.call("session.explain", name="two")["text"])
        self.call("session.replay", name="two", loop=True)
        wait_for("the replay", lambda: lidar.call("source.status")["source"]["state"] == "replay")
        self.robot.kill("recorder")
        wait_for("the lidar", lambda: lidar.call("source.status")["source"]["state"] == "live")

    def test_sessions_are_renamed_and_removed(self):
        self.call("session.start", name="one")
        with self.assertRaisesRegex(DaemonError, "being recorded"):
            self.call("session.remove", name="one", confirm=True)
        self.call("session.stop")
        self.assertEqual(self.call("session.rename", name="one", to="two")["name"], "two")
        with self.assertRaisesRegex(DaemonError, "confirm=true"):
            self.call("session.remove", name="two")
        self.assertEqual([one["name"] for one in self.call("session.list")], ["two"])
        self.call("session.remove", name="two", confirm=True)
        self.assertEqual(self.call("session.list"), [])
        self.assertNotIn("two", os.listdir(self.robot.records))
        for name in ("/", "../x", "a/b", ".hidden"):
            with self.assertRaises(DaemonError):
                self.call("session.start", name=name)


if __name__ == "__main__":
    unittest.main()
