#!/usr/bin/env python3
"""hermesctl says what to do about a failure, and speaks JSON where it is asked to."""
import json
import socket
import unittest

from ctl_support import MadeUpDaemon, Thermometer, ctl


class Advice(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = Thermometer()

    @classmethod
    def tearDownClass(cls):
        cls.daemon.stop()

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

    def test_wrong_values(self):
        text = self.fails("call", self.daemon.address, "thermometer.calibrate", "offset_k=warm")
        self.assertIn("offset_k: a number from -5 to 5 in K; Shift", text)
        text = self.fails("set", self.daemon.address, "period_s=often")
        self.assertIn("period_s: a number from 0.001 to 60 in s; default 0.1; Time between readings", text)

    def test_control_of_another(self):
        held = MadeUpDaemon.Error(code=-32002, message="Ann holds the control", data={"holder": "Ann"})
        daemon = MadeUpDaemon({"motor.drive": held})
        text = self.fails("call", daemon.address, "motor.drive", "vx=1")
        daemon.stop()
        self.assertIn("Ann holds the control until", text)
        self.assertIn("take_over=true", text)


class Json(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = Thermometer()

    @classmethod
    def tearDownClass(cls):
        cls.daemon.stop()

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
                                        (["record", "list", "--daemons", address], 1, -32011),
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
