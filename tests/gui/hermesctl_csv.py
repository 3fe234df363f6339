#!/usr/bin/env python3
"""hermesctl watch --csv and --out: what is in the columns, what becomes of what has none, how a stream ends."""
import csv
import io
import os
import signal
import subprocess
import tempfile
import unittest

from ctl_support import PROGRAM, MadeUpDaemon, ThermometerCase, ctl

POSE = {"type": "object", "additionalProperties": False, "properties": {
    "x": {"type": "number", "unit": "m"}, "text": {"type": "string"}, "stamp": {"type": "number", "unit": "s"},
    "wheels": {"type": "array", "minItems": 2, "maxItems": 2, "items": {"type": "number", "unit": "rad/s"}},
    "points": {"type": "array", "items": {"type": "number"}},
    "twist": {"type": ["object", "null"], "additionalProperties": False, "properties": {"vx": {"type": "number", "unit": "m/s"}}}}}


def rows(text):
    return list(csv.reader(io.StringIO(text, newline="")))


class Csv(unittest.TestCase):
    def watch(self, messages, schema, *options):
        daemon = MadeUpDaemon({}, messages, schema)
        self.addCleanup(daemon.stop)
        return ctl("watch", daemon.address, "made.up", "--csv", "--count", str(len(messages)), *options)

    def test_columns_of_the_schema(self):
        shown = self.watch([(1, 0, {"x": 1.25, "text": 'a "b", c\nd', "stamp": 7, "wheels": [1, 2], "points": [1, 2, 3],
                                    "twist": {"vx": 0.5}}),
                            (2, 0, {"text": "", "wheels": [3, 4], "points": [], "twist": None})], POSE)
        self.assertEqual((shown.returncode, shown.stderr), (0, ""))
        self.assertEqual(rows(shown.stdout), [
            ["stamp [s]", "seq", "dropped", "points", "data.stamp [s]", "text", "twist.vx [m/s]", "wheels[0] [rad/s]",
             "wheels[1] [rad/s]", "x [m]"],
            ["1.500000", "1", "0", "[1,2,3]", "7", 'a "b", c\nd', "0.5", "1", "2", "1.25"],
            ["1.500000", "2", "0", "[]", "", "", "", "3", "4", ""]])

    def test_columns_of_the_first_message(self):
        shown = self.watch([(1, 0, {"b": 1, "a": {"c": True}}), (2, 0, {"b": 2, "z": 5, "a": {"c": False, "d": 1}}),
                            (3, 0, {"z": 6, "b": 3})], {"type": "object", "additionalProperties": True})
        self.assertEqual(rows(shown.stdout), [["stamp [s]", "seq", "dropped", "a.c", "b"], ["1.500000", "1", "0", "true", "1"],
                                              ["1.500000", "2", "0", "false", "2"], ["1.500000", "3", "0", "", "3"]])
        self.assertIn("z came in 2 messages after the header: it has no column", shown.stderr)
        self.assertIn("a.d came in 1 messages", shown.stderr)

    def test_a_value_and_a_list(self):
        self.assertEqual(rows(self.watch([(1, 0, 20.5)], {"type": "number", "unit": "C"}).stdout),
                         [["stamp [s]", "seq", "dropped", "data [C]"], ["1.500000", "1", "0", "20.5"]])
        self.assertEqual(rows(self.watch([(1, 0, [{"a": 1}])], {"type": "array", "items": {"type": "object"}}).stdout)[1][3],
                         '[{"a":1}]')

    def test_dropped_messages_are_told(self):
        shown = self.watch([(1, 0, 1), (9, 7, 2)], {"type": "number"})
        self.assertEqual(rows(shown.stdout)[2], ["1.500000", "9", "7", "2"])
        self.assertIn("7 messages are missing", shown.stderr)

    def test_out(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "pose.csv")
            arguments = ([(1, 0, 1)], {"type": "number"}, "--out", file)
            self.assertEqual(self.watch(*arguments).stdout, "")
            with open(file, encoding="utf-8") as written:
                first = written.read()
            self.assertEqual(len(rows(first)), 2)
            refused = self.watch([(1, 0, 2)], {"type": "number"}, "--out", file)
            self.assertEqual(refused.returncode, 1)
            self.assertIn("--force", refused.stderr)
            with open(file, encoding="utf-8") as written:
                self.assertEqual(written.read(), first)
            self.assertEqual(self.watch([(1, 0, 2)], {"type": "number"}, "--force", "--out", file).returncode, 0)
            with open(file, encoding="utf-8") as written:
                self.assertEqual(rows(written.read())[1][3], "2")
            absent = os.path.join(folder, "absent.csv")
            self.assertEqual(ctl("watch", "127.0.0.1:1", "x", "--csv", "--out", absent).returncode, 1)
            self.assertFalse(os.path.exists(absent))  # nothing was said
            nowhere = self.watch([(1, 0, 1)], {"type": "number"}, "--out", os.path.join(absent, "x"))
            self.assertEqual(nowhere.returncode, 1)
            self.assertIn("cannot be written", nowhere.stderr)


class Ends(ThermometerCase):
    def start(self, topic, *options):
        return subprocess.Popen([PROGRAM, "watch", self.daemon.address, topic, *options], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def test_signal(self):
        watching = self.start("temperature", "--csv")
        lines = [watching.stdout.readline() for _ in range(3)]  # each is there at once
        watching.send_signal(signal.SIGINT)
        rest, errors = watching.communicate(timeout=20)
        self.assertEqual((watching.returncode, errors), (0, ""))
        self.assertTrue((lines[-1] + rest).endswith("\n"))
        self.assertEqual({len(row) for row in rows("".join(lines) + rest)}, {4})

    def test_reader_goes(self):
        for topic in "temperature", "extremes":  # the other one is silent after its first message
            watching = self.start(topic)
            watching.stdout.readline()
            watching.stdout.close()
            with watching.stderr:
                self.assertEqual((watching.wait(20), watching.stderr.read()), (0, ""))


if __name__ == "__main__":
    unittest.main()
