#!/usr/bin/env python3
"""hermesctl says what to do about a failure, and speaks JSON where it is asked to."""
import json
import math
import os
import socket
import subprocess
import tempfile
import time
import unittest

from ctl_support import PROGRAM, MadeUpDaemon, Thermometer, ThermometerCase, at_terminal, ctl

# A command with an object, and a setting, as their daemon describes them.
WHEN = {"type": "object", "additionalProperties": False, "properties": {
    "kind": {"type": "string"}, "period_s": {"type": "number", "unit": "s", "description": "Of the firings"},
    "angle": {"type": "number", "unit": "rad"}}}
DESCRIPTION = {"methods": [{"name": "trigger.define", "summary": "Defines", "params": [
    {"name": "id", "schema": {"type": "string"}}, {"name": "when", "schema": WHEN}]}]}
SETTINGS = {"properties": {"sensor": {"properties": {"theta_rad": {"type": "number", "unit": "rad"}}},
                           "ports": {"type": "array", "items": {"properties": {"url": {"type": "string"}, "name": {"type": "string"}}}}}}


class Advice(ThermometerCase):
    def fails(self, *arguments, status=1):
        shown = ctl(*arguments)
        self.assertEqual((shown.returncode, shown.stdout), (status, ""), shown.stderr)
        return shown.stderr

    def test_nobody_there(self):
        with socket.socket() as taken:  # and nobody listens
            taken.bind(("127.0.0.1", 0))
            port = taken.getsockname()[1]
            self.assertIn(f"--listen 'tcp://127.0.0.1:{port}", self.fails("call", f"127.0.0.1:{port}", "daemon.info"))
        with socket.socket() as taken:
            taken.bind(("127.77.0.1", 7450))
            text = self.fails("call", "scanmatcher", "daemon.info", "--host", "127.77.0.1")
        self.assertIn("start hermes-scanmatcher on 127.77.0.1", text)
        self.assertIn("port 7450", text)

    def test_other_framing(self):
        other = Thermometer("cbor")
        try:
            text = self.fails("call", other.address, "daemon.info", "--timeout", "0.3")
            self.assertIn(f"speaks cbor, and was spoken to in json; name it as 'tcp://{other.address}?protocol=cbor'", text)
            self.assertEqual(ctl("call", f"tcp://{other.address}?protocol=cbor", "daemon.info").returncode, 0)
        finally:
            other.stop()
        text = self.fails("get", f"tcp://{self.daemon.address}?protocol=cbor", "--timeout", "0.3")
        self.assertIn("speaks json, and was spoken to in cbor", text)

    def test_names(self):
        address = self.daemon.address
        for arguments, near in ((("call", address, "thermometer.raed"), "did you mean thermometer.read?"),
                                (("call", address, "thermometer.read", "units=C"), "did you mean unit?"),
                                (("watch", address, "temprature"), "did you mean temperature?"),
                                (("get", address, "limits.client"), "did you mean limits.clients"),
                                (("set", address, "perod_s=1"), "did you mean period_s?")):
            self.assertIn(near, self.fails(*arguments))
        for arguments, near in ((("wacth", address), "watch"), (("call", "scanmacher", "x"), "scanmatcher"),
                                (("watch", address, "x", "--cvs"), "--csv")):
            self.assertIn(f"did you mean {near}", self.fails(*arguments, status=2))

    def test_options_of_another_command(self):
        for words, text in ((("drive", "motorcontrol", "vx=0", "--count", "3"), '--count is no option of "drive", which has --for'),
                            (("watch", self.daemon.address, "temperature", "--for=1"), '--for is no option of "watch"'),
                            (("keys", "list", "--csv"), '--csv is no option of "keys list"')):
            self.assertIn(text, self.fails(*words, status=2))

    def test_commands_that_people_try(self):
        self.assertIn("no robot is there", self.fails("estop", self.daemon.address))
        self.assertEqual(ctl("help").stdout, ctl("--help").stdout)
        text = self.fails("call", "127.0.0.1:99999", "daemon.info", status=2)
        self.assertIn("the port is 99999, at most 65535", text)
        self.assertNotIn("own=1", text)
        self.assertIn("without a port", self.fails("list", "--host", "127.0.0.1:7490", status=2))
        self.assertIn("option --role is missing", self.fails("keys", "issue", "ben", status=2))
        self.assertIn('"vx=0.1" is no daemon; usage: hermesctl drive D [vx=]', self.fails("drive", "vx=0.1", "--for", "1", status=2))
        self.assertIn("no daemon listens", self.fails("get", "127.0.0.1:1?protocol=json"))
        self.assertIn("drives no robot", self.fails("drive", self.daemon.address, "vx=0.1", "--for", "1"))

    def test_a_topic_that_is_silent(self):
        silent = MadeUpDaemon({"daemon.info": {}})
        self.addCleanup(silent.stop)
        self.assertIn("made.up: no message within 0.5 s", self.fails("watch", silent.address, "made.up", "--timeout", "0.5"))
        with subprocess.Popen([PROGRAM, "watch", silent.address, "made.up"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as watch:
            self.assertIn("no message of made.up yet", watch.stderr.readline())
            watch.terminate()

    def test_wrong_values(self):
        text = self.fails("call", self.daemon.address, "thermometer.calibrate", "offset_k=warm")
        self.assertIn("offset_k: a number from -5 to 5 in K; Shift", text)
        text = self.fails("set", self.daemon.address, "period_s=often")
        self.assertIn("period_s: a number from 0.001 to 60 in s; default 0.1; Time between readings", text)

    def made_up(self, **replies):
        daemon = MadeUpDaemon({"rpc.discover": DESCRIPTION, "settings.schema": SETTINGS,
                               **{name.replace("__", "."): reply for name, reply in replies.items()}})
        self.addCleanup(daemon.stop)
        return daemon.address

    def test_members_of_parameters(self):
        def refused(path, expected="nothing of this name"):
            return MadeUpDaemon.Error(code=-32602, message="invalid params", data={"errors": [{"path": path, "expected": expected}]})
        for path, advice in (("when.perod_s", "when.perod_s is unknown; did you mean when.period_s?; when holds angle, kind, period_s"),
                             ("when.period_s", "when.period_s: a number in s; Of the firings"),
                             ("wen", "wen is unknown; did you mean when?; there is id, when")):
            address = self.made_up(trigger__define=refused(path))
            self.assertIn(advice + "\n", self.fails("call", address, "trigger.define", "id=x"))
        wrong = MadeUpDaemon.Error(code=-32003, message="wrong", data={"errors": [{"path": "ports.0.ulr"}]})
        self.assertIn("ports.0.ulr is unknown; did you mean ports.0.url?; ports.0 holds name, url",
                      self.fails("set", self.made_up(settings__set=wrong), 'ports=[{"ulr":"x"}]'))

    def test_dotted_parameters_make_objects(self):
        echo = json.loads(ctl("call", self.daemon.address, "thermometer.echo", "value.a.b=1", "value.c=x").stdout)
        self.assertEqual(echo, {"a": {"b": 1}, "c": "x"})

    def test_degrees_for_radians(self):
        for arguments, text in ((("trigger.define", "when.angle=90"), "when.angle: 90 rad is 14.3 turns; did you mean 1.571 rad (90 degrees)?"),
                                (("trigger.define", "when.angle=6.28", "when.period_s=90"), None)):
            shown = ctl("call", self.made_up(trigger__define={}), *arguments)
            self.assertEqual((shown.returncode, shown.stderr), (0, f"hermesctl: {text}\n" if text else ""), arguments)
        address = self.made_up(settings__set={"changed": ["sensor.theta_rad"], "restart": []})
        shown = ctl("set", address, "sensor.theta_rad=-180", "--json")
        self.assertEqual((shown.returncode, json.loads(shown.stderr)),
                         (0, {"note": "sensor.theta_rad: -180 rad is 28.6 turns; did you mean -3.142 rad (-180 degrees)?"}))

    def test_angles_typed_in_degrees(self):
        echo = lambda params: params
        shown = ctl("call", self.made_up(trigger__define=echo), "trigger.define", "when.angle=90deg", "id=90deg")
        self.assertEqual((json.loads(shown.stdout), shown.stderr), ({"when": {"angle": math.pi / 2}, "id": "90deg"}, ""))
        shown = ctl("set", self.made_up(settings__set=echo), "sensor.theta_rad=-180deg", "--json")
        self.assertEqual(json.loads(shown.stdout), {"values": {"sensor": {"theta_rad": -math.pi}}})

    def test_a_hint_that_cannot_be_had_is_no_error(self):
        daemon = MadeUpDaemon({"trigger.define": {"id": "x"}})
        shown = ctl("call", daemon.address, "trigger.define", "when.angle=90")
        daemon.stop()
        self.assertEqual((shown.returncode, json.loads(shown.stdout), shown.stderr), (0, {"id": "x"}, ""))

    def test_relative_paths(self):
        address = self.made_up(trigger__define=MadeUpDaemon.Error(code=-32008, message="/x: No such file"))
        with tempfile.NamedTemporaryFile(dir=".") as file:
            name = os.path.basename(file.name)
            self.assertIn(f"for the file in this folder: id={os.path.join(os.getcwd(), name)}",
                          self.fails("call", address, "trigger.define", f"id={name}"))
        self.assertNotIn("folder", self.fails("call", address, "trigger.define", f"id={name}"))  # it is nowhere

    def test_control_of_another(self):
        held = MadeUpDaemon.Error(code=-32002, message="Ann holds the control", data={"holder": "Ann"})
        daemon = MadeUpDaemon({"motor.drive": held})
        text = self.fails("call", daemon.address, "motor.drive", "vx=1")
        daemon.stop()
        self.assertIn("Ann holds the control until", text)
        self.assertIn("take_over=true", text)


class Patience(ThermometerCase):
    """A call takes as long as it takes, while the daemon answers other requests."""

    def calibrate(self, settle_ms, *options):
        return ("call", self.daemon.address, "thermometer.calibrate", "offset_k=0", f"settle_ms={settle_ms}", *options)

    def test_a_long_call(self):
        shown = ctl(*self.calibrate(7000))
        self.assertEqual((shown.returncode, shown.stderr), (0, ""))

    def test_a_limit(self):
        begun = time.monotonic()
        shown = ctl(*self.calibrate(9000, "--timeout", "0.5"))
        self.assertEqual((shown.returncode, shown.stderr.splitlines()[0]),
                         (1, "hermesctl: thermometer.calibrate: no reply within 0.5 s (-32010)"))
        self.assertIn("the daemon answers other requests", shown.stderr)
        self.assertLess(time.monotonic() - begun, 8)

    def test_progress_at_a_terminal(self):
        shown = at_terminal(*self.calibrate(4500))
        self.assertIn("waiting, second 3", shown)
        self.assertTrue(shown.endswith("\r\x1b[K"), shown)

    def test_a_robot_that_tells_no_odometry(self):
        daemon = MadeUpDaemon({name: {} for name in ("daemon.info", "motor.state", "control.acquire", "motor.stop", "control.release")})
        shown = ctl("drive", daemon.address, "vx=0.1", "--for", "1", "--timeout", "1")
        daemon.stop()
        self.assertEqual((shown.returncode, shown.stderr.splitlines()[0]), (1, "hermesctl: no odometry came within 1 s (-32010)"))
        self.assertNotIn("takes longer", shown.stderr)

    def test_a_daemon_that_hangs(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            begun = time.monotonic()
            shown = ctl("call", f"127.0.0.1:{silent.getsockname()[1]}", "daemon.info")
            self.assertIn("daemon.info: no reply within 5 s (-32010)", shown.stderr)
            self.assertLess(time.monotonic() - begun, 20)


class Json(ThermometerCase):
    def value(self, *arguments):
        shown = ctl(*arguments, "--json")
        self.assertEqual((shown.returncode, shown.stderr), (0, ""))
        return json.loads(shown.stdout)

    def test_values(self):
        address = self.daemon.address
        self.assertEqual(self.value("call", address, "thermometer.echo", "value=x"), "x")
        self.assertIn("limits", self.value("get", address))
        self.assertEqual(self.value("set", address, "period_s=0.02"), {"changed": ["period_s"], "restart": []})
        self.assertEqual(self.value("discover", address)["openrpc"], "1.2.6")
        self.assertEqual(set(self.value("doc", address)), {"description", "settings"})
        self.assertEqual(set(self.value("doc", "--all", "--daemons", address)), {"thermometer"})
        self.assertIn("complete -o nospace", self.value("completion", "bash"))
        self.assertEqual(self.value("--version")["name"], "hermesctl")
        self.assertEqual(self.value("watch", address, "temperature", "--count", "1")["seq"] > 0, True)

    def test_streams(self):
        for arguments in (["log", self.daemon.address], ["watch", self.daemon.address, "temperature", "--count", "3"]):
            shown = ctl(*arguments, "--json")
            self.assertEqual(shown.returncode, 0)
            self.assertTrue(all(json.loads(line)["stamp"] > 0 for line in shown.stdout.splitlines()))

    def test_errors(self):
        address = self.daemon.address
        for arguments, status, code in ((["call", address, "thermometer.read", "unit=F"], 1, -32602),
                                        (["set", address, "period_s=-1"], 1, -32003),
                                        (["watch", address, "nothing"], 1, -32006),
                                        (["list", "--host", "127.77.77.77"], 1, -32011),
                                        (["record", "list", "--recorder", address], 1, -32601),
                                        (["call", address], 2, -32602), (["--foo"], 2, -32602), ([], 2, -32602),
                                        (["watch", address, "x", "--csv"], 2, -32602)):
            shown = ctl(*arguments, "--json")
            self.assertEqual((shown.returncode, shown.stdout), (status, ""), arguments)
            error = json.loads(shown.stderr)
            self.assertEqual((error["code"], bool(error["message"])), (code, True))
        self.assertEqual(error.keys() & {"data", "hint"}, set())
        wrong = json.loads(ctl("call", address, "thermometer.read", "unit=F", "--json").stderr)
        self.assertEqual(wrong["data"]["errors"][0]["path"], "unit")
        self.assertIn('"K"', wrong["hint"])


if __name__ == "__main__":
    unittest.main()
