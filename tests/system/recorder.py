#!/usr/bin/env python3
"""hermes-recorder beside a whole robot: every topic is in the files as another subscriber saw it, a session goes on whoever is
killed, and is played back as it was."""
import glob
import json
import os
import signal
import statistics
import time
import unittest

from lateness import Lateness
from recorded_robot import RecordedRobot
from support import Listener, fastest_wheel, refusal, wait_for

KILLS = int(os.environ.get("HERMES_KILLS", "3"))
SECONDS = float(os.environ.get("HERMES_SECONDS", "0"))  # of the drive that is compared, message by message
COMPARED = {"motorcontrol/odometry", "motorcontrol/wheels", "velodynelogger/scan2d", "velodynelogger/lidar", "scanmatcher/pose",
            "seriallogger/serial"}


class Recorder(RecordedRobot):
    def listen(self, *topics):
        return {topic: Listener(self.robot.ports[topic.split("/")[0]], topic.split("/")[1]) for topic in topics}

    def test_every_message_is_in_the_file(self):
        seen = self.listen(*COMPARED)
        state = self.call("session.start", name="drive")
        self.assertEqual(state["state"], "recording")
        self.assertEqual({part["daemon"] for part in state["parts"]}, {"recorder", "velodynelogger", "seriallogger"})
        begin, busy = time.monotonic(), self.robot.processor_seconds("recorder")
        driver = self.drive(vx=0.15, omega=0.3)
        wait_for("messages", lambda: all(len(one.messages) > 5 for one in seen.values()) and time.monotonic() > begin + SECONDS, SECONDS + 60)
        if SECONDS:
            share = (self.robot.processor_seconds("recorder") - busy) / (time.monotonic() - begin)
            print(f"recorder: {100 * share:.1f} % of a core, {self.call('session.state')['bytes'] / 1e6:.0f} MB with the loggers' parts")
            self.assertLess(share, 0.05)
        self.robot.daemons["motorcontrol"].call("motor.stop")
        driver.end()
        self.assertAlmostEqual(self.call("session.mark", text="a door")["t_s"], self.call("session.state")["duration_s"], delta=1)
        stopped = self.call("session.stop")
        self.assertEqual(stopped["problems"], [])
        self.assertEqual({part["state"] for part in stopped["parts"]}, {"stopped"})
        (file,) = self.robot.files("drive")
        by_topic = {}
        for message in file.messages:
            by_topic.setdefault(file.channels[message.channel].topic, {})[message.sequence] = message
        for topic, listener in seen.items():
            messages = {message["seq"]: message for message in listener.messages}
            common = set(by_topic[topic]) & set(messages)
            self.assertGreater(len(common), 2, topic)
            self.assertEqual(common, set(range(min(common), max(common) + 1)), topic)
            for number in common - {min(common)}:  # that of the snapshot with which a subscription begins
                self.assertEqual(json.loads(by_topic[topic][number].data), messages[number]["data"], topic)
                self.assertAlmostEqual(by_topic[topic][number].publish_time * 1e-9, messages[number]["stamp"], delta=1e-5)
        self.assertEqual(json.loads(next(iter(by_topic["recorder/marks"].values())).data)["text"], "a door")
        methods = [json.loads(message.data)["method"] for message in by_topic["motorcontrol/commands"].values()]
        self.assertIn("motor.drive", methods)
        self.assertIn("motor.stop", methods)
        self.assertIn("simulator/settings", by_topic)
        (listed,) = self.call("session.list")
        self.assertEqual((listed["name"], listed["problems"]), ("drive", []))

    def test_killed_recorder_goes_on(self):
        self.call("session.start", name="drive")
        ends = []
        with Lateness() as lateness:
            for _ in range(KILLS):
                self.wait_for_messages(400)  # more than come in a second
                lateness.take_longest()
                killed = time.time()
                self.robot.kill("recorder")
                ends.append(killed - 2 * lateness.take_longest())  # what holds up a nap here holds up the recorder too
                self.robot.start("recorder")
                wait_for("the session", lambda: self.call("session.state")["state"] == "recording")
        self.wait_for_messages(50)
        state = self.call("session.stop")
        self.assertEqual({part["daemon"]: part["state"] for part in state["parts"]},
                         {"recorder": "stopped", "velodynelogger": "stopped", "seriallogger": "stopped"})
        files = self.robot.files("drive")
        self.assertEqual(len(files), KILLS + 1)
        for end, file in zip(ends, files):  # a second, and what a kill takes
            self.assertLess(end - max(message.log_time for message in file.messages) * 1e-9, 1.2)
        stamps = [message.log_time for file in files for message in file.messages]
        self.assertEqual(stamps, sorted(stamps))

    def test_all_killed_at_once_go_on(self):
        self.call("session.start", name="drive")
        self.call("session.mark", text="before")
        self.wait_for_messages(400)
        for name in self.robot.processes:
            self.robot.kill(name)
        for name in self.robot.processes:
            self.robot.start(name)
        parts = lambda: {part["daemon"]: part["state"] for part in self.call("session.state")["parts"]}
        wait_for("the parts", lambda: parts() == {"recorder": "recording", "velodynelogger": "recording", "seriallogger": "recording"})
        self.wait_for_messages(50)
        self.assertEqual([mark["text"] for mark in self.call("session.state")["marks"]], ["before"])
        self.assertEqual({part["state"] for part in self.call("session.stop")["parts"]}, {"stopped"})
        self.assertEqual(len(self.robot.files("drive")), 2)
        self.assertEqual(len(glob.glob(os.path.join(self.robot.records, "drive", "*.pcap"))), 2)
        self.robot.kill("recorder")  # what was stopped stays so
        self.robot.start("recorder")
        wait_for("what is on the disk", lambda: self.call("session.list"))
        self.assertEqual(self.call("session.state")["state"], "idle")

    def test_ended_in_order_goes_on_unless_it_was_stopped(self):
        def again():
            for name in self.robot.processes:
                self.assertEqual(self.robot.processes[name].stop(), 0)
            for name in self.robot.processes:
                self.robot.start(name)
        self.call("session.start", name="drive")
        self.wait_for_messages(50)
        again()
        parts = lambda: {part["daemon"]: part["state"] for part in self.call("session.state")["parts"]}
        wait_for("the parts", lambda: parts() == {"recorder": "recording", "velodynelogger": "recording", "seriallogger": "recording"})
        self.call("session.stop")
        os.remove(os.path.join(self.robot.records, ".recorder.ended"))  # as if its folder had come from elsewhere
        again()
        wait_for("the time for loggers", lambda: self.call("daemon.info")["uptime_s"] > 5)
        self.assertEqual(self.call("session.state")["state"], "idle")
        self.assertEqual(len(self.robot.files("drive")), 2)

    def test_replay_is_the_drive_again(self):
        seen = self.listen("motorcontrol/odometry", "scanmatcher/pose", "velodynelogger/scan2d", "seriallogger/lines")
        lidar = self.robot.daemons["velodynelogger"]
        wait_for("a GPS that sets the lidar's clock", lambda: lidar.call("source.status")["gps"].get("locked"))
        lidar.call("settings.set", values={"record": {"file_bytes": 1000000}})
        self.call("session.start", name="drive")
        self.drive(vx=0.3, way_m=0.5).end()
        state = self.call("session.stop")
        self.assertGreater(len(glob.glob(os.path.join(self.robot.records, "drive", "*.pcap"))), 1)
        wait_for("the standstill", lambda: fastest_wheel(self.robot.daemons["simulator"]) < 1e-6)
        wheels, before = self.pose(), {topic: len(listener.messages) for topic, listener in seen.items()}
        with Lateness() as lateness:
            self.call("session.replay", name="drive")
            wait_for("the end", lambda: self.call("session.state")["state"] == "idle")
            allowed_s = 0.1 + 2 * lateness.take_longest()  # what holds up a nap here holds up the loggers too
        late = {}
        for topic, listener in seen.items():
            came = list(zip(listener.times, listener.messages))
            first, again = came[:before[topic]], came[before[topic]:]
            if topic != "seriallogger/lines":
                marked = [message for _, message in again if message.get("replayed") or message["data"].get("replayed")]
                self.assertGreater(len(marked), 5, topic)
            if topic.endswith(("lines", "scan2d")):  # of which those at the beginning and at the end may be cut off
                first, again = ([(when, {**message["data"], "turn": None, "replayed": None}) for when, message in part
                                 if 0.2 < message["data"]["stamp"] - state["start"] < state["duration_s"] - 0.2] for part in (first, again))
                self.assertGreater(len(first), 5, topic)
                self.assertEqual([data for _, data in first], [data for _, data in again])
                self.assertEqual({data.get("lost_packets", 0) for _, data in again}, {0})
                late[topic] = statistics.median(now - then for (then, _), (now, _) in zip(first, again))
        apart = late["seriallogger/lines"] - late["velodynelogger/scan2d"]
        print(f"replay: lines and turns {1e3 * apart:+.1f} ms apart from how they came live")
        self.assertLess(abs(apart), allowed_s)
        self.assertEqual(self.pose(), wheels)

    def test_a_ring_becomes_a_session(self):
        self.call("settings.set", values={"record": {"ring_s": 30}})
        self.call("session.start", name="before")  # whose topics have other numbers
        self.call("session.stop")
        self.drive(vx=0.1, way_m=0.2)
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
            for method in ("start", "replay"):
                refusal(self.robot.recorder, "session." + method, f'"{name}" is being recorded', name=name)
            self.call("session.stop")
        refusal(self.robot.recorder, "session.replay", 'there is no session "three"', name="three")
        self.call("session.replay", name="one", paused=True)
        self.assertEqual(self.call("session.replay", name="two", paused=True)["name"], "two")
        refusal(self.robot.recorder, "session.start", "is replayed", name="three")
        self.assertEqual(self.call("session.live")["state"], "idle")
        full = self.robot.daemons["seriallogger"]
        full.call("settings.set", values={"record": {"free_warn_bytes": 1e15, "free_floor_bytes": 1e15}})
        told = refusal(self.robot.recorder, "session.start", "seriallogger: ", name="three").message  # all or none
        self.assertIn("free_floor_bytes", told)
        self.assertIn("velodynelogger had begun and was stopped", told)
        self.assertEqual(self.call("session.state")["state"], "idle")

    def test_who_dies_or_hangs_holds_nothing_up(self):
        lidar = self.robot.daemons["velodynelogger"]
        self.call("session.start", name="one")
        hung = self.robot.processes["velodynelogger"].process
        hung.send_signal(signal.SIGSTOP)
        self.assertIn("silent", [part["state"] for part in self.call("session.stop")["parts"]])
        hung.send_signal(signal.SIGCONT)
        wait_for("the end of its part", lambda: not lidar.call("record.status")["recording"])
        self.call("session.start", name="two")
        self.drive(vx=0.1)
        for name in ("motorcontrol", "velodynelogger"):
            self.robot.kill(name)
            self.robot.start(name)
        lidar = self.robot.daemons["velodynelogger"]
        wait_for("the lidar's part", lambda: lidar.call("record.status")["recording"])
        wait_for("it", lambda: "5 daemons" in self.robot.health("daemons"))
        wait_for("packets", lambda: lidar.call("record.status")["counts"]["packets"] > 0)
        ended = self.call("session.stop")
        part = next(part for part in ended["parts"] if part["daemon"] == "velodynelogger")
        self.assertEqual((part["state"], part["losses"]["interruptions"]), ("stopped", 1))
        self.assertIn("velodynelogger: lost: interruptions 1", ended["problems"])
        self.assertEqual(len(glob.glob(os.path.join(self.robot.records, "two", "*.pcap"))), 2)
        self.assertIn("Cause: motor control was ended or killed", self.call("session.explain", name="two")["text"])
        self.call("session.replay", name="two", loop=True)
        wait_for("the replay", lambda: self.source_of("velodynelogger") == "replay")
        self.robot.kill("recorder")
        wait_for("the lidar", lambda: self.source_of("velodynelogger") == "live")

    def test_sessions_are_renamed_and_removed(self):
        recorder = self.robot.recorder
        state = self.call("session.start", what=["seriallogger"])
        self.assertRegex(state["name"], r"^\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d$")
        self.assertEqual({part["daemon"] for part in state["parts"]}, {"recorder", "seriallogger"})
        refusal(recorder, "session.remove", "being recorded", name=state["name"], confirm=True)
        self.call("session.stop")
        self.assertEqual(self.call("session.rename", name=state["name"], to="two")["name"], "two")
        refusal(recorder, "session.remove", "confirm=true", name="two")
        self.assertEqual([one["name"] for one in self.call("session.list")], ["two"])
        self.call("session.remove", name="two", confirm=True)
        self.assertEqual(self.call("session.list"), [])
        self.assertNotIn("two", os.listdir(self.robot.records))
        for name in ("/", "../x", "a/b", ".hidden"):
            refusal(recorder, "session.start", name=name)


if __name__ == "__main__":
    unittest.main()
