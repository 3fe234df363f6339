#!/usr/bin/env python3
"""Whatever happens to a settings file or a disk, the service stays up, the robot stands, hermesctl list, the health items that the window
shows and the journal name what, where, what was found and what was expected; when the cause is gone all goes on by itself.

What needs a full disk, a file that cannot be read or a folder that cannot be written to is left out where it cannot be made."""
import json
import os
import re
import shutil
import subprocess
import unittest

from robot import NAMES
from robot_case import INTERPOSED, RobotCase
from support import DaemonError, wait_for, text_of


class BadFiles(RobotCase):
    WRONG_SETTINGS = {
        "syntax": (b'{\n "record": {"folder": "/tmp"},\n "ports": [}\n', "line 3"),
        "unknown key": (b'{"prots": []}', "prots"),
        "wrong type": (b'{"limits": {"clients": "many"}}', "limits.clients.*many"),
        "out of range": (b'{"limits": {"clients": 0}}', "limits.clients.*0.*(1|from)"),
        "empty": (b"", "0 bytes"),
        "zeros": (b"{}" + bytes(100), "line 1"),
        "Latin-1": (b'{"record": {"folder": "/tmp/M\xfcll"}}', "line 1"),
        "UTF-16": ("{}".encode("utf-16"), "expected UTF-8"),
        "no object": (b"[1, 2]", "expected a JSON object"),
        "binary": (bytes(range(256)) * 4, "line 1"),
        "cut off": (b'{"record": {"folder": "/t', "line 1"),
        "folder": (os.mkdir, "regular file"),
        "pipe": (os.mkfifo, "regular file"),
        "device": (lambda path: os.symlink("/dev/zero", path), "regular file"),
        "links in a circle": (lambda path: os.symlink(path, path), "[Ll]inks"),
        "huge": (lambda path: subprocess.run(["truncate", "-s", "1G", path], check=True), "1073741824 bytes"),
        "unreadable": (lambda path: os.close(os.open(path, os.O_CREAT, 0)), "[Pp]ermission"),
        "absent": (lambda path: None, "No such file")}

    def spoil(self, name, what):
        """Puts that in the place of a settings file; False where it cannot be made."""
        made, path = self.WRONG_SETTINGS[what][0], self.robot.path(name)
        if what == "unreadable" and os.geteuid() == 0:
            return False
        if isinstance(made, bytes):
            self.robot.write_text(name, made)
        else:
            os.remove(path)
            made(path)
        return True

    def mend(self, name):
        if os.path.isdir(self.robot.path(name)):
            os.rmdir(self.robot.path(name))
        self.robot.write(name)

    def test_wrong_settings_of_a_daemon(self):
        robot = self.robot_at_work()
        name = "seriallogger"
        for what, (_, word) in self.WRONG_SETTINGS.items():
            with self.subTest(what):
                since = robot.journal_size()
                if not self.spoil(name, what):
                    continue
                try:
                    self.assertIsNotNone(robot.items(name), "a daemon that runs reads its file")
                    robot.call("supervisor", "process.restart", name=name)
                    self.tells("supervisor", f"process {name}", re.escape(robot.path(name)), word, since=since, down=name)
                finally:
                    self.mend(name)
                wait_for("a start by itself", lambda: robot.items(name) is not None, 15)
        self.until_well()

    def test_settings_that_do_not_go_together(self):
        """The file with what the command line insists on."""
        robot, name = self.robot_at_work(), "motorcontrol"
        entries = robot.settings["supervisor"]["processes"]
        next(one for one in entries if one["name"] == name)["arguments"] += ["--set", "faults.battery_v=22"]
        robot.call("supervisor", "settings.set", values={"processes": entries})
        self.until_well("other arguments")
        since = robot.journal_size()
        robot.write(name, faults={"battery_warning_v": 21.8})
        robot.call("supervisor", "process.restart", name=name)
        self.tells("supervisor", f"process {name}", re.escape(robot.path(name)), "--set.*battery_v is 22", since=since, down=name)
        robot.write(name, faults={"battery_warning_v": 23})
        wait_for("a start by itself", lambda: robot.items(name) is not None, 15)
        self.until_well()

    def test_wrong_settings_of_the_supervisor(self):
        robot = self.robot_at_work()
        for what, (_, word) in self.WRONG_SETTINGS.items():
            with self.subTest(what):
                since = robot.journal_size()
                if not self.spoil("supervisor", what):
                    continue
                try:
                    robot.process.terminate()
                    wait_for("the end", lambda: robot.items("supervisor") is None, 20)
                    wait_for("the service", lambda: robot.items("supervisor") is not None, 20)
                    self.assertEqual(robot.call("supervisor", "process.list")["processes"][0]["state"], "stopped")
                    told = robot.items("supervisor")
                    self.assertTrue(any(robot.path("supervisor") in one and re.search(word, one) for one in told), told)
                    shown, journal = robot.shown(), robot.written(since)
                    for text in (shown, journal):
                        self.assertIn(robot.path("supervisor"), text)
                        self.assertRegex(text, word)
                finally:
                    self.mend("supervisor")
                wait_for("the processes", self.is_first_running, 20)
        self.until_well()

    def is_first_running(self):
        try:
            return self.robot.call("supervisor", "process.list")["processes"][0]["state"] == "running"
        except (OSError, DaemonError):  # it ends, and starts anew
            return False

    def mount(self, folder, *how):
        done = subprocess.run(["mount", *how, folder], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            self.skipTest(f"{folder} cannot be mounted here: " + done.stderr.strip())
        self.addCleanup(subprocess.run, ["umount", "-l", folder], check=True)

    @staticmethod
    def make(folder, access):
        subprocess.run(["mount", "-o", f"remount,bind,{access}", folder], check=True)

    def small_disk(self):
        disk = os.path.join(self.folder, "disk")
        os.mkdir(disk)
        self.mount(disk, "-t", "tmpfs", "-o", "size=2m", "tmpfs")
        return disk

    @staticmethod
    def fill(disk):
        with open(os.path.join(disk, "filler"), "ab", buffering=0) as filler:
            for size in (65536, 4096, 1):
                try:
                    while True:
                        filler.write(bytes(size))
                except OSError:
                    pass

    def test_files_of_a_recording_that_are_removed(self):
        """Or replaced, while they are recorded: their loggers go on writing to what has no name."""
        records = os.path.join(self.folder, "recordings")
        robot = self.robot_at_work(velodynelogger={"record": {"folder": records}}, seriallogger={"record": {"folder": records}})
        for name, file in (("velodynelogger", "velodynelogger-0001.pcap"), ("seriallogger", "seriallogger-gps.raw"),
                           ("seriallogger", "seriallogger-gps.index"), ("seriallogger", "seriallogger-events.jsonl")):
            for how in ("removed", "replaced"):
                with self.subTest(file, how=how):
                    since, run = robot.journal_size(), f"{file}-{how}"
                    path = os.path.join(robot.call(name, "record.start", name=run)["folder"], file)
                    if how == "removed":
                        os.remove(path)
                    else:
                        shutil.copy(path, path + ".copy")
                        os.replace(path + ".copy", path)
                    self.tells(name, "error", "recording", path, {"removed": "removed", "replaced": "another file"}[how], since=since)
                    with self.assertRaisesRegex(DaemonError, file):
                        robot.call(name, "record.stop")
                    told = next(one for one in robot.call(name, "record.list") if one["name"] == run)
                    self.assertEqual((told["complete"], told["ended"]), (False, "failed"), told)
        for name in ("velodynelogger", "seriallogger"):
            robot.call(name, "record.start", name=f"{name} again")
            self.until_well(names=[name])
            robot.call(name, "record.stop")

    def test_full_disk(self):
        """Under recordings, the audit and the settings files."""
        disk = self.small_disk()
        self.simulate()
        record = {"folder": os.path.join(disk, "recordings"), "free_floor_bytes": 0, "free_warn_bytes": 0}
        audit = {"folder": os.path.join(disk, "audit")}
        robot = self.robot_of(velodynelogger={"record": record, "audit": audit}, seriallogger={"record": record},
                              motorcontrol={"audit": audit})
        etc = os.path.join(disk, "etc")
        os.mkdir(etc)
        robot.write("supervisor", setup={**robot.settings["supervisor"]["setup"], "folder": etc})
        self.until_well()
        robot.process.terminate()
        self.until_well("another folder of settings")
        robot.call("supervisor", "setup.apply", settings={"seriallogger": {"limits": {"clients": 20}}})
        with open(os.path.join(etc, "seriallogger.json"), "rb") as file:
            old = file.read()
        for name in ("velodynelogger", "seriallogger"):
            wait_for("it", lambda name=name: robot.items(name) is not None)
            robot.call(name, "record.start", name=f"run-{name}")
        self.drive(lambda: not self.stands())
        since = robot.journal_size()
        self.fill(disk)

        def audits():  # the last page of the file has room for some lines
            self.fill(disk)  # recordings that end give back what they had reserved
            for method in ["odometry.reset"] * 40:  # stops would be summed up
                robot.call("motorcontrol", method)
            return any("audit" in item for item in robot.items("motorcontrol"))
        wait_for("a full disk under the audit", audits, 15)
        for name, words in {"velodynelogger": ("recording", "run"), "seriallogger": ("recording", "run"),
                            "motorcontrol": ("audit", "audit of commands cannot be written")}.items():
            self.tells(name, *words, disk, "[Ss]pace|full", since=since)
            if words[0] == "recording":
                wait_for("its end", lambda: not robot.call(name, "record.status")["recording"])
            self.fill(disk)
        for method, params in {"setup.apply": {"settings": {"seriallogger": {"limits": {"clients": 30}}, "simulator": {}}},
                               "setup.undo": {}}.items():
            with self.assertRaisesRegex(DaemonError, f"{disk}.*[Ss]pace"):
                robot.call("supervisor", method, **params)
            with open(os.path.join(etc, "seriallogger.json"), "rb") as file:
                self.assertEqual(file.read(), old, method)
            self.assertEqual(sorted(os.listdir(etc)), ["seriallogger.json", "seriallogger.json.previous"])
        os.remove(os.path.join(disk, "filler"))
        shutil.rmtree(os.path.join(disk, "recordings"))
        for name in ("velodynelogger", "seriallogger"):
            robot.call(name, "record.start", name=f"next-{name}")
            robot.call(name, "record.stop")
        self.until_well("room on the disk")
        robot.call("supervisor", "setup.undo")
        self.assertEqual(json.loads(text_of(os.path.join(etc, "seriallogger.json"))), {})
        self.drive(lambda: not self.stands())

    def test_state_that_is_read_only(self):
        """From the start; when it is no longer, all goes on."""
        state = os.path.join(self.folder, "state")
        os.mkdir(state)
        self.mount(state, "--bind", state)
        self.make(state, "ro")
        self.simulate()
        record, maps = {"folder": os.path.join(state, "recordings")}, os.path.join(state, "maps")
        robot = self.robot_of({"STATE_DIRECTORY": state, "XDG_STATE_HOME": state}, velodynelogger={"record": record},
                              seriallogger={"record": record}, scanmatcher={"map": {"folder": maps, "journal": "drive.journal"}})
        self.tells("scanmatcher", "journal", maps, "[Rr]ead-only")
        self.drive(lambda: not self.stands())
        self.tells("motorcontrol", "audit", os.path.join(state, "audit"), "[Rr]ead-only")
        calls = {name: lambda name=name: robot.call(name, "record.start", name=f"run-{name}") for name in ("velodynelogger", "seriallogger")}
        calls["scanmatcher"] = lambda: robot.call("scanmatcher", "map.save", path="first.csv")
        for name, call in calls.items():
            with self.subTest(name), self.assertRaisesRegex(DaemonError, f"{state}.*[Rr]ead-only"):
                call()
        self.make(state, "rw")
        for call in calls.values():
            call()
        for name in ("velodynelogger", "seriallogger"):
            robot.call(name, "record.stop")
        wait_for("the audit", lambda: os.path.getsize(os.path.join(state, "audit", "seriallogger.jsonl")) > 0)
        self.drive(lambda: not self.stands())
        self.until_well("a folder to write to", limit_s=90)  # what was not written down is told for a minute

    def test_settings_that_cannot_be_written(self):
        """A full disk, one that is read-only: the files stay as they are."""
        robot = self.robot_of()
        wait_for("the start", lambda: all(robot.items(name) is not None for name in ("supervisor", *NAMES)))
        self.mount(robot.etc, "-t", "tmpfs", "-o", "size=64k", "tmpfs")
        for name in robot.settings:
            robot.write(name)
        robot.call("supervisor", "setup.apply", settings={"seriallogger": {"limits": {"clients": 20}}})
        wait_for("it", lambda: robot.items("seriallogger") is not None)
        before = self.files(robot.etc)
        robot.call("seriallogger", "settings.set", values={"limits": {"clients": 30}})
        full = os.path.join(robot.etc, "filler")
        for what, spoil, mend in (("[Ss]pace", lambda: self.fill(robot.etc), lambda: os.remove(full)),
                                  ("not writable|[Rr]ead-only", lambda: self.make(robot.etc, "ro"), lambda: self.make(robot.etc, "rw"))):
            spoil()
            for name, method in (("seriallogger", "settings.save"), ("supervisor", "setup.apply"), ("supervisor", "setup.undo")):
                params = {"settings": {"seriallogger": {"limits": {"clients": 40}}}} if method == "setup.apply" else {}
                with self.subTest(f"{what} {method}"), self.assertRaisesRegex(DaemonError, f"{robot.etc}.*({what})"):
                    robot.call(name, method, **params)
            mend()
            self.assertEqual(self.files(robot.etc), before)
        robot.call("seriallogger", "settings.save")
        self.assertEqual(self.files(robot.etc)["seriallogger.json"]["limits"], {"clients": 30})

    @staticmethod
    def files(folder):
        found = {}
        for name in os.listdir(folder):
            if not name.endswith((".json", ".previous")):
                continue  # a draft of a program that was killed
            found[name] = json.loads(text_of(os.path.join(folder, name)))
        return found

    def test_killed_while_settings_are_replaced(self):
        """At each step of setup.apply: all files are as they were, or it is told and setup.undo makes them so."""
        robot = self.robot_of()
        changes = {name: {"limits": {"clients": 30}} for name in ("motorcontrol", "seriallogger")}
        before = self.files(robot.etc)

        def is_up():
            return robot.items("supervisor") is not None

        def are_all_up():
            return all(robot.items(name) is not None for name in ("supervisor", *NAMES))
        wait_for("the service", is_up)
        told = 0
        for at in range(1, 100):
            robot.environment = {**INTERPOSED, "HERMES_KILL_AT": str(at)}
            robot.process.terminate()
            wait_for("the end", lambda: not is_up())
            wait_for("the service", is_up)
            robot.environment, since = {}, robot.journal_size()
            try:
                robot.call("supervisor", "setup.apply", settings=changes)
                break
            except OSError:  # it was killed
                wait_for("the service", are_all_up)
            if robot.items("supervisor"):
                told += 1
                self.tells("supervisor", "settings files", robot.etc, "cut off", "setup.undo", since=since)
                with self.assertRaisesRegex(DaemonError, "cut off"):
                    robot.call("supervisor", "setup.apply", settings=changes)
                robot.call("supervisor", "setup.undo")
            now = self.files(robot.etc)
            self.assertEqual({name: now[name] for name in before}, before, f"killed at step {at}")
            wait_for("that all is well", lambda: not robot.items("supervisor"), 10)
        self.assertGreater(told, 1)
        self.assertEqual(self.files(robot.etc)["motorcontrol.json"]["limits"], {"clients": 30})


if __name__ == "__main__":
    unittest.main(verbosity=2)
