#!/usr/bin/env python3
"""hermes-make-room removes the oldest recordings, as few as needed, and never what is written, marked, young or no recording."""
import importlib.machinery
import importlib.util
import json
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "system"))
from support import BINARIES, SOURCE, Process, free_port  # noqa: E402

PROGRAM = os.path.join(SOURCE, "deploy", "board", "hermes-make-room")
loader = importlib.machinery.SourceFileLoader("make_room", PROGRAM)
make_room = importlib.util.module_from_spec(importlib.util.spec_from_loader("make_room", loader))
loader.exec_module(make_room)
DAY_S = 86400


class MakeRoom(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def recording(self, name, age_s, **changes):
        folder = self.root / name
        folder.mkdir()
        for file in ("gps.raw", "gps.index", "events.jsonl"):
            (folder / ("seriallogger-" + file)).write_bytes(b"$GPRMC")
        sidecar = {"format": "hermes recording 1", "ended": "stopped", "end": time.time() - age_s,
                   "files": [{"name": "seriallogger-gps.raw"}], **changes}
        (folder / "seriallogger.json").write_text(json.dumps(sidecar))
        return folder

    def names(self):
        return sorted(path.name for path in self.root.iterdir())

    def run_program(self, *options):
        return subprocess.run([PROGRAM, self.root, *options], capture_output=True, text=True, stdin=subprocess.DEVNULL)

    def only_an_old_one_goes(self):
        """What is told where no disk is large enough."""
        before = self.names()
        self.recording("old", DAY_S)
        told = self.run_program("--free", "900T")
        self.assertEqual(self.names(), before)
        return told

    def test_the_oldest_go_until_enough_is_free(self):
        for name, days in (("b", 3), ("a", 2), ("c", 1)):
            self.recording(name, days * DAY_S)
        with mock.patch.object(make_room, "free_bytes", lambda root: 4e9 - 1e9 * len(self.names())), \
                mock.patch.object(sys, "argv", [PROGRAM, str(self.root), "--free", "2G"]):
            make_room.main()
        self.assertEqual(self.names(), ["a", "c"])

    def test_nothing_goes_while_enough_is_free(self):
        self.recording("old", DAY_S)
        self.assertEqual(self.run_program("--free", "0").returncode, 0)
        self.assertEqual(self.names(), ["old"])

    def test_what_is_kept_whatever_is_asked_for(self):
        (self.recording("marked", DAY_S) / "KEEP").touch()
        self.recording("young", 60)
        self.recording("future", -DAY_S)
        self.recording("recording", DAY_S, ended=None, end=None)
        (self.recording("one-of-two", DAY_S) / "velodynelogger.json").write_text(
            json.dumps({"format": "hermes recording 1", "ended": None, "end": None}))
        (self.recording("begins", DAY_S) / ".velodynelogger.reserve").touch()
        (self.recording("damaged", DAY_S) / "velodynelogger.json").write_text("{")
        self.recording("other-format", DAY_S, format="something else")
        self.recording("no-end", DAY_S, end=None)
        (self.root / "no-recording").mkdir()
        (self.root / "file").touch()
        (self.root / "link").symlink_to(self.root / "marked")
        told = self.only_an_old_one_goes()
        self.assertEqual(told.returncode, 1)
        self.assertIn("old: removed", told.stdout)
        self.assertIn("damaged: kept", told.stderr)
        self.assertIn("expected", told.stderr)

    def test_any_sidecar_keeps_its_folder_alone(self):
        for number, text in enumerate(("[" * 200000, "[]", "null", '{"format": 1}', "\udcff", "1" * 5000)):
            (self.recording(f"odd-{number}", DAY_S) / "odd.json").write_bytes(text.encode(errors="surrogateescape"))
        for number, end in enumerate((float("nan"), 10 ** 400, "yesterday", [])):
            self.recording(f"end-{number}", DAY_S, end=end)
        (self.recording("pipe", DAY_S) / "pipe.json").unlink(missing_ok=True)
        os.mkfifo(self.root / "pipe" / "pipe.json")
        told = self.only_an_old_one_goes()
        self.assertIn("old: removed", told.stdout)

    def test_the_age_is_known_before_the_clock_is_set(self):
        long_ago = time.time() - 300
        young = {"boot": make_room.boot(), "end_mono": time.monotonic() - 300}
        self.recording("young", long_ago, **young)
        self.recording("young-by-a-clock-of-last-year", 400 * DAY_S, **young)
        self.recording("of-another-run", long_ago, boot="another", end_mono=5)
        told = self.only_an_old_one_goes()
        self.assertIn("of-another-run: kept", told.stderr)
        with mock.patch.object(make_room, "YOUNG_S", 200):
            ends = [make_room.end_of(self.root / name, time.time()) for name in ("young", "young-by-a-clock-of-last-year")]
        self.assertTrue(all(abs(time.time() - 300 - end) < 30 for end in ends), ends)

    def test_a_recording_with_something_else_in_its_folder_is_kept(self):
        elsewhere = self.root / "elsewhere"
        elsewhere.touch()
        for number, name in enumerate(("notes.txt", "map.csv", "velodynelogger-0001.pcap", "seriallogger-gps-lines.csv",
                                       "seriallogger-gps (copy).raw", ".hidden")):
            (self.recording(f"file-{number}", DAY_S) / name).touch()
        (self.recording("subfolder", DAY_S) / "pictures").mkdir()
        (self.recording("folder-with-the-name-of-a-file", DAY_S, files=[{"name": "a.pcap"}]) / "a.pcap").mkdir()
        (self.recording("link", DAY_S, files=[{"name": "a.pcap"}]) / "a.pcap").symlink_to(elsewhere)
        self.recording("no-list-of-files", DAY_S, files=None)
        told = self.only_an_old_one_goes()
        self.assertIn("file-0: kept", told.stderr)
        self.assertIn("notes.txt", told.stderr)

    def test_dry_run_tells_in_order_and_removes_nothing(self):
        self.recording("newer", DAY_S)
        self.recording("older", 2 * DAY_S)
        told = self.run_program("--free", "900T", "--dry-run").stdout
        self.assertLess(told.index("older: would be removed"), told.index("newer: would be removed"))
        self.assertEqual(self.names(), ["newer", "older"])

    def test_what_was_left_half_removed_is_removed(self):
        self.recording(".removing-old", DAY_S)
        self.assertEqual(self.run_program("--free", "0").returncode, 0)
        self.assertEqual(self.names(), [])

    def test_a_wrong_size_or_folder_is_told(self):
        self.assertIn("8X", self.run_program("--free", "8X").stderr)
        told = subprocess.run([PROGRAM, self.root / "none", "--free", "1G"], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
        self.assertEqual(told.returncode, 1)
        self.assertIn("no such folder", told.stderr)

    def test_loggers_record_on(self):
        recordings = self.root / "recordings"
        loggers = []
        for name, settings in (("velodynelogger", {"source.port": free_port(0, socket.SOCK_DGRAM), "source.position_port": 0}),
                               ("seriallogger", {"ports": '[{"name": "gps", "url": "tcp://127.0.0.1:1"}]'})):
            process = Process(BINARIES, name, free_port(0), self.root,
                              {"record.folder": recordings, "record.free_floor_bytes": 0, "audit.on": "false", **settings})
            self.addCleanup(process.stop)
            loggers.append(process.connect())
        self.root = recordings
        for logger in loggers:
            logger.call("record.start", name="now", session="both")
        self.remove_of_any_age()
        self.assertIn("now", self.names())
        for logger in loggers:
            logger.call("record.stop")
        self.remove_of_any_age()
        self.assertNotIn("now", self.names())

    def remove_of_any_age(self):
        with mock.patch.object(make_room, "YOUNG_S", -DAY_S), self.assertRaises(SystemExit), \
                mock.patch.object(sys, "argv", [PROGRAM, str(self.root), "--free", "900T"]):
            make_room.main()


if __name__ == "__main__":
    unittest.main()
