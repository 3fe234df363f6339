#!/usr/bin/env python3
"""`hermesctl session` against a recorder that is made up: what it is asked for by each command, and how its answers are shown."""
import json
import os
import pty
import signal
import subprocess
import unittest

from ctl_support import PROGRAM, MadeUpDaemon, ctl

ODD = "\x1b[2Jevil"
PARTS = [{"daemon": "recorder", "state": "recording", "bytes": 2500000.0, "counts": {"messages": 1200, "none": 0}, "losses": {}, "problem": ""},
         {"daemon": "velodynelogger", "state": "silent", "bytes": 0.0, "counts": {}, "losses": {"queue": 3}, "problem": "gone"}]
STATE = {"state": "recording", "name": "run1", "session": "7f3a", "start": 1.7e9, "duration_s": 12.345, "bytes": 2500000.0,
         "free_bytes": 55.2e9, "left_s": 7200.0, "parts": PARTS, "marks": [{"t_s": 3.25, "text": "a door"}], "problems": [], "silent": []}
SUMMARY = {"name": "run1", "session": "7f3a", "start": 1.7e9, "end": 1.7e9 + 60, "bytes": 1e6, "daemons": ["recorder", "velodynelogger"],
           "problems": ["velodynelogger: cut off"]}
INFO = {"summary": SUMMARY, "duration_s": 60.0, "driven_m": 12.5, "parts": PARTS, "marks": STATE["marks"],
        "topics": [{"topic": "motorcontrol/odometry", "messages": 600, "lost": 2, "rate_hz": 10.0, "longest_gap_s": 0.31}],
        "stops": ["12.34 s: motor.estop by 127.0.0.1:5000"], "faults": ["13.00 s: motorcontrol roboclaw error: silent"]}


def replaying(position_s, **more):
    return {**STATE, "state": "replaying", "parts": [], "marks": [],
            "replay": {"position_s": position_s, "duration_s": 60.0, "speed": 2.0, "paused": False, "loop": False}, **more}


class Recorder(MadeUpDaemon):
    """Writes down what it was asked for."""

    def __init__(self, replies, messages=()):
        self.asked = []
        super().__init__({method: self.listener(method, reply) for method, reply in replies.items()}, messages)

    def listener(self, method, reply):
        def answer(params):
            self.asked.append((method, params))
            return reply(params) if callable(reply) else reply
        return answer


def removal(params):
    return None if params.get("confirm") else MadeUpDaemon.Error(code=-32005, message='"run1": 9 MB of recorder would be removed',
                                                                 data={"confirm": True})


class Session(unittest.TestCase):
    def recorder(self, *messages, **replies):
        recorder = Recorder({"session." + method: reply for method, reply in replies.items()}, messages)
        self.addCleanup(recorder.stop)
        return recorder

    def ctl(self, recorder, *words, status=0):
        shown = ctl(*words, "--recorder", recorder.address)
        self.assertEqual(shown.returncode, status, shown)
        return shown.stdout if status == 0 else shown.stderr

    def test_what_is_asked_for(self):
        live = {"problems": []}
        for words, method, params in (
                ("session start", "start", {}),
                ("record start run1", "start", {"name": "run1"}),
                ("session start run1 --daemons a,b", "start", {"name": "run1", "what": ["a", "b"]}),
                ("record stop", "stop", {}), ("record status", "state", {}), ("session live", "live", {}),
                ("record mark here", "mark", {"text": "here"}),
                ("record list --count 5", "list", {"max": 5}), ("session list", "list", {}),
                ("session info run1", "info", {"name": "run1"}),
                ("session rename run1 run2", "rename", {"name": "run1", "to": "run2"}),
                ("session remove run1 --yes", "remove", {"name": "run1", "confirm": True}),
                ("session explain run1 --at 12.5", "explain", {"name": "run1", "at_s": 12.5}),
                ("session export run1 --format csv --topics a/b,c/d", "export", {"name": "run1", "format": "csv", "topics": ["a/b", "c/d"]}),
                ("replay run1 --detach", "replay", {"name": "run1"}),
                ("session replay run1 --detach --loop --speed 2 --from 5 --without scanmatcher", "replay",
                 {"name": "run1", "loop": True, "speed": 2, "from_s": 5, "without": ["scanmatcher"]})):
            with self.subTest(words):
                recorder = self.recorder(**{method: live})
                self.assertEqual(json.loads(self.ctl(recorder, *words.split(), "--json")), live)
                self.assertEqual(recorder.asked, [("session." + method, params)])

    def test_tables(self):
        for words, replies, lines in (
                ("session status", {"state": STATE},
                 [r"session +state +start +duration \[s\] +size +free +full in \[h\]", r"run1 +recording +\S+ +12.3\d +2.5 MB +55.2 GB +2.0",
                  r"daemon +state +size +recorded +lost", r"recorder +recording +2.5 MB +messages 1200 +nothing",
                  r"velodynelogger +silent +0 bytes +nothing +queue 3", r"at \[s\] +mark", r"3.25 +a door"]),
                ("session status", {"state": {**STATE, "state": "idle", "name": "", "start": 0, "parts": [], "marks": [], "silent": ["scanmatcher"]}},
                 [r"state .*", r"idle .*", r"silent: scanmatcher"]),
                ("session status", {"state": replaying(3.5)},
                 [r"session .*", r"run1 +replaying .*", r"at \[s\] +duration \[s\] +speed +paused +loop", r"3.50 +60 +2 +false +false"]),
                ("session mark x", {"mark": {"t_s": 1.5, "text": "x"}}, [r"at \[s\] +mark", r"1.50 +x"]),
                ("session list", {"list": [SUMMARY, {**SUMMARY, "name": "run2", "problems": []}, {**SUMMARY, "end": None}]},
                 [r"session +start +end +size +daemons +problems",
                  r"run1 +20\d\d-\S+ +20\d\d-\S+ +1.0 MB +recorder, velodynelogger +velodynelogger: cut off", r"run2 .* -", r"run1 +\S+ +- .*"]),
                ("session list", {"list": []}, []),
                ("session rename run0 run1", {"rename": SUMMARY}, [r"session .*", r"run1 .*"]),
                ("session info run1", {"info": INFO},
                 [r"session .*duration \[s\] +driven \[m\].*", r"run1 .* 60 +12.50 .*", r"daemon .*", r"recorder .*", r"velodynelogger .*",
                  r"topic +messages +lost +rate \[Hz\] +gap \[s\]", r"motorcontrol/odometry +600 +2 +10 +0.31", r"at \[s\] +mark", r"3.25 +a door",
                  r"stop: 12.34 s: motor.estop by 127.0.0.1:5000", r"fault: 13.00 s: .*"]),
                ("session explain run1", {"explain": {"text": "First.\nSecond.\n"}}, ["First.", "Second."]),
                ("session export run1 --format csv", {"export": {"paths": ["/a/b.csv", "/a/c.csv"]}}, ["/a/b.csv", "/a/c.csv"])):
            with self.subTest(words, replies=replies.keys()):
                shown = self.ctl(self.recorder(**replies), *words.split()).splitlines()
                self.assertEqual(len(shown), len(lines), shown)
                for line, expected in zip(shown, lines):
                    self.assertRegex(line, f"^{expected}$")

    def test_problems(self):
        state = {**STATE, "problems": ["velodynelogger: lost: queue 3", "no answer"]}
        recorder = self.recorder(start=state, stop=state, state=state)
        self.assertIn("not all was recorded; velodynelogger: lost: queue 3; no answer (-32005)", self.ctl(recorder, "record", "stop", status=1))
        self.assertIn("hermesctl: velodynelogger: lost: queue 3; no answer (-32005)", self.ctl(recorder, "record", "status", status=1))
        shown = ctl("record", "start", "--recorder", recorder.address)
        self.assertEqual((shown.returncode, shown.stderr), (0, "hermesctl: velodynelogger: lost: queue 3\nhermesctl: no answer\n"))
        recorder = self.recorder(export={"paths": ["/a.csv"], "problems": ["being recorded"]})
        shown = ctl("session", "export", "x", "--format", "csv", "--recorder", recorder.address)
        self.assertEqual((shown.returncode, shown.stdout, shown.stderr), (0, "/a.csv\n", "hermesctl: being recorded\n"))

    def test_without_a_recorder(self):
        for words in (["status"], ["list"], ["replay", "run1"]):
            shown = ctl("session", *words, "--host", "127.77.77.77")
            self.assertEqual(shown.returncode, 1)
            self.assertIn("tcp://127.77.77.77:7460: Connection refused", shown.stderr)
            self.assertIn("start hermes-recorder on 127.77.77.77", shown.stderr)
            self.assertIn("process.start name=recorder starts it", shown.stderr)

    def test_wrong_usage(self):
        for words, told in ((["record"], "one of these is expected: start, stop"), (["session", "begin"], 'unknown command "session begin"'),
                            (["session", "mark"], "usage: hermesctl session mark TEXT"), (["session", "rename", "a"], "usage"),
                            (["record", "stop", "x"], "usage"), (["replay"], "usage: hermesctl session replay SESSION"),
                            (["record", "stop", "--loop"], '--loop is no option of "session stop"'),
                            (["record", "stop", "--recorder", "nobody"], "unknown daemon")):
            shown = ctl(*words)
            self.assertEqual(shown.returncode, 2, shown)
            self.assertIn(told, shown.stderr)

    def test_remove_asks(self):
        recorder = self.recorder(remove=removal)
        self.assertIn("--yes removes it", self.ctl(recorder, "session", "remove", "run1", status=1))
        for answer, asked, status in ((b"n\n", [{}], 1), (b"y\n", [{}, {"confirm": True}], 0)):
            recorder.asked.clear()
            far, near = pty.openpty()
            with subprocess.Popen([PROGRAM, "session", "remove", "run1", "--recorder", recorder.address], stdin=near, stderr=near) as process:
                os.write(far, answer)
                self.assertEqual(process.wait(20), status)
            os.close(near)
            self.assertIn(b"would be removed. Do you confirm? [y/N]", os.read(far, 10000))
            os.close(far)
            self.assertEqual(recorder.asked, [("session.remove", {"name": "run1", **more}) for more in asked])

    def test_replay_until_its_end(self):
        updates = [replaying(1.0), replaying(2.0, problems=["seriallogger does not answer"]), {**STATE, "state": "idle", "problems": ["seriallogger does not answer"]}]
        for last, status in ((updates[-1], 0), ({**STATE, "name": "run2"}, 0), ({**STATE, "state": "idle", "problems": ["the disk failed"]}, 1)):
            recorder = self.recorder(*enumerate_updates(updates[:2] + [last]), replay=replaying(0.0))
            shown = ctl("replay", "run1", "--json", "--recorder", recorder.address)
            self.assertEqual(shown.returncode, status, shown)
            self.assertEqual([json.loads(line) for line in shown.stdout.splitlines()], updates[:2])
            self.assertIn({"note": "seriallogger does not answer"}, [json.loads(line) for line in shown.stderr.splitlines()])
            self.assertEqual("the disk failed" in shown.stderr, status == 1)
            self.assertEqual([method for method, _ in recorder.asked], ["session.replay"])

    def test_replay_ends_with_a_signal(self):
        recorder = self.recorder(*enumerate_updates([replaying(1.0)]), replay=replaying(0.0), live=STATE)
        with subprocess.Popen([PROGRAM, "replay", "run1", "--json", "--recorder", recorder.address], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True) as process:
            self.assertEqual(json.loads(process.stdout.readline()), replaying(1.0))
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(20), 0)
        self.assertEqual([method for method, _ in recorder.asked], ["session.replay", "session.live"])

    def test_a_recorder_that_goes(self):
        class Gone(Recorder):
            def answer(self, request, out):
                super().answer(request, out)
                if request["method"] == "topics.subscribe":
                    raise OSError("it is gone")

        recorder = Gone({"session.replay": replaying(0.0)}, enumerate_updates([replaying(1.0)]))
        self.addCleanup(recorder.stop)
        self.assertIn("(-32011)", self.ctl(recorder, "replay", "run1", status=1))

    def test_odd_replies(self):
        """Whatever a recorder says: no command of the terminal, no crash."""
        odd = {**STATE, "name": ODD, "parts": [{"daemon": ODD, "counts": {ODD: 1}}, ODD, 7], "marks": [{"t_s": ODD}], "silent": [ODD, 1], "problems": []}
        for reply in (odd, [odd, None, 3], None, 5, ODD, {"replay": {"position_s": 1e308}, "bytes": -1e300, "problems": {"a": 1}}):
            recorder = self.recorder(**{method: reply for method in ("state", "list", "info", "explain", "export", "replay")})
            for words in ("status", "list", "info x", "explain x", "export x --format csv", "replay x --detach"):
                shown = ctl("session", *words.split(), "--recorder", recorder.address)
                self.assertIn(shown.returncode, (0, 1), (words, reply))
                self.assertNotIn("\x1b", shown.stdout + shown.stderr)

    def test_completion(self):
        recorder = self.recorder(list=[SUMMARY, {**SUMMARY, "name": "run2"}])
        for line, expected in ((f"replay --recorder {recorder.address} ", ["run1", "run2"]),
                               (f"session remove --recorder {recorder.address} run2", ["run2"]),
                               (f"call {recorder.address} session.info name=", ["name=run1", "name=run2"]),
                               ("session export x --format c", ["csv", "carmen"]), ("session export x --format p", ["pcap"]), ("session st", ["start", "stop", "status"]),
                               ("session list --recorder rec", ["recorder"])):
            shown = ctl("complete", "hermesctl " + line)
            self.assertEqual([one.split("\t")[0] for one in shown.stdout.splitlines()], expected, line)


def enumerate_updates(states):
    return [(i + 1, 0, state) for i, state in enumerate(states)]


if __name__ == "__main__":
    unittest.main()
