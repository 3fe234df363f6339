#!/usr/bin/python3
"""hermes-web beside a whole robot: an independent client of Foxglove's protocol validates every channel (HERMES_SECONDS, 5), hostile
ones change nothing for others, and a teleop panel that ends stops the robot. Skipped without hermes-web or python3-websockets."""
import json
import os
import random
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from support import BINARIES, Listener, fastest_wheel, free_port, release, wait_for

try:
    import jsonschema  # noqa: F401  pylint: disable=unused-import
    import websockets
except ImportError as error:
    print(f"skipped: {error.name} is not installed")
    sys.exit(77)
if not os.path.exists(os.path.join(BINARIES, "hermes-web")):
    print("skipped: hermes-web is not built (libqt5websockets5-dev)")
    sys.exit(77)

from recorded_robot import Driver, Robot  # noqa: E402
from web_client import Judge, WebClient, judge_schema, seconds, strict_json  # noqa: E402

SECONDS = float(os.environ.get("HERMES_SECONDS", "5"))
SEED = int(os.environ.get("HERMES_SEED", random.randrange(1 << 30)))
ALWAYS = {"frames", "motorcontrol/odometry", "motorcontrol/power", "motorcontrol/status", "motorcontrol/settings", "motorcontrol/wheels",
          "velodynelogger/scan2d", "velodynelogger/cloud", "scanmatcher/pose", "scanmatcher/pose/frame", "scanmatcher/map",
          "scanmatcher/match", "seriallogger/fix", "seriallogger/fix/place", "simulator/truth"}
CLIENTS = 20
MB = 1 << 20
MEMORY_MB = 60  # of one that does not read, and of what 19 others have under way
STILL = 0.02  # m/s
RELEASE_S = 1.2  # web.release_s
CLOSED_S = 0.5  # with the braking, from 0.3 m/s


class WebCase(unittest.TestCase):
    """Tests with such a robot, and with hermes-web for observers and for engineers."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.robot = Robot(folder)
        cls.addClassCleanup(cls.robot.stop)
        daemons = json.dumps([f"127.0.0.1:{port}" for port in cls.robot.ports.values()])
        cls.web = {}
        for role in ("observer", "engineer"):
            cls.web[role] = free_port(0)
            cls.robot.ports["web"] = free_port(0)
            cls.robot.settings["web"] = {"daemons": daemons, "web.listen": f"127.0.0.1:{cls.web[role]}", "web.role": role}
            cls.robot.start("web")
            cls.robot.processes[role], cls.robot.daemons[role] = cls.robot.processes.pop("web"), cls.robot.daemons.pop("web")
        cls.motors = cls.robot.daemons["motorcontrol"]
        for port in cls.web.values():  # all daemons are known
            with WebClient(port) as client:
                wait_for("channels", lambda: ALWAYS <= client.topics() and len(client.services) > 20)  # pylint: disable=cell-var-from-loop

    def client(self, role="observer", judge=None, **options):
        client = WebClient(self.web[role], judge, **options)
        self.addCleanup(client.close)
        wait_for("services", lambda: "motorcontrol/motor.estop" in client.services)
        return client

    def values(self, role="observer"):
        """Of the health item `web`."""
        return next(one for one in self.robot.daemons[role].call("daemon.status")["health"] if one["name"] == "web")["values"]

    def memory(self, role="observer"):
        with open(f"/proc/{self.robot.processes[role].process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * 4096

    def speed(self):
        twist = self.motors.call("motor.state")["twist"]
        return max(map(abs, twist.values()))

    def until_still(self):
        wait_for("standstill", lambda: self.speed() < STILL, 10)

    def until_driving(self, act=lambda: None):
        def is_driving():
            act()
            time.sleep(0.05)
            return self.speed() > 0.1
        try:
            wait_for("a drive", is_driving, 10)
        except AssertionError as error:
            raise AssertionError(f"{error}: {self.motors.call('motor.state')['halted']}") from error


class Channels(WebCase):
    def test_every_channel_is_what_it_says(self):
        judge = Judge()
        client = self.client(judge=judge)
        judge.declare(client.channels.values())
        self.assertEqual(len({channel["topic"] for channel in client.channels.values()}), len(client.channels))
        self.assertNotIn("motorcontrol/commands", client.topics())  # for engineers
        driver = Driver(self.robot.ports["motorcontrol"], "anna", vx=0.1, omega=0.2)
        client.subscribe(*client.topics())
        end = time.monotonic() + SECONDS
        wait_for("all channels", lambda: ALWAYS <= set(judge.seen) and time.monotonic() > end, SECONDS + 30)
        driver.end()
        self.assertEqual(judge.faults[:20], [])
        self.assertEqual([one for one in client.statuses if one["level"] == 2], [])
        print(f"{sum(judge.seen.values())} messages of {len(judge.seen)} channels of {len(client.channels)}")
        pose, frame = client.messages["scanmatcher/pose"], client.messages["scanmatcher/pose/frame"]
        places = {(one["pose"]["position"]["x"], one["pose"]["position"]["y"]) for one in frame}
        self.assertTrue({(one["x"], one["y"]) for one in pose[1:-1]} <= places)
        self.assertLess(abs(client.times["motorcontrol/odometry"][-1] * 1e-9 - time.time()), 30)
        self.assertLess(abs(seconds(client.messages["frames"][-1]["transforms"][0]["timestamp"]) - time.time()), 30)

    def test_who_comes_later_sees_the_whole_map(self):
        first = self.client()
        first.subscribe("scanmatcher/map")
        edges = self.robot.daemons["scanmatcher"].call("matcher.state")["map_segments"]
        first.wait("scanmatcher/map")
        second = self.client()
        second.subscribe("scanmatcher/map")
        message = wait_for("all of it", lambda: next((one for one in second.messages["scanmatcher/map"] if one["deletions"]), None))
        self.assertGreaterEqual(sum(len(one["lines"][0]["points"]) // 2 for one in message["entities"]), edges // 2)
        self.assertEqual(message["deletions"][0]["type"], 1)

    def test_unsubscribed_is_silent(self):
        client, other = self.client(), self.client()
        client.subscribe("motorcontrol/odometry", "motorcontrol/wheels")
        other.subscribe("motorcontrol/odometry")
        client.wait("motorcontrol/odometry")
        client.send({"op": "unsubscribe", "subscriptionIds": list(client.subscribed)})
        wait_for("silence", lambda: self.is_silent(client, "motorcontrol/odometry"))
        other.wait("motorcontrol/odometry", 5)
        client.subscribe("motorcontrol/wheels")
        client.wait("motorcontrol/wheels", 5)

    @staticmethod
    def is_silent(client, topic):
        before = len(client.messages[topic])
        time.sleep(0.3)
        return len(client.messages[topic]) == before

    def test_a_daemon_that_goes_and_comes(self):
        client = self.client()
        topics = {"seriallogger/fix", "seriallogger/status"}
        wait_for("its channels", lambda: topics <= client.topics())
        before = {channel["topic"]: number for number, channel in client.channels.items()}
        self.robot.kill("seriallogger")
        wait_for("their end", lambda: not topics & client.topics())
        self.assertIn("motorcontrol/odometry", client.topics())
        self.assertNotIn("seriallogger/mark", client.services)
        self.robot.start("seriallogger")
        wait_for("its channels", lambda: topics <= client.topics())
        after = {channel["topic"]: number for number, channel in client.channels.items()}
        self.assertEqual(before, after)

    def test_parameters_are_the_settings_in_force(self):
        observer, engineer = self.client(), self.client("engineer")
        name = "velodynelogger.cloud.max_points"
        expected = {name, "motorcontrol.safety.command_timeout_s", "recorder.record.ring_s"}
        for client in (observer, engineer):  # they come a moment after the channels
            wait_for("settings", lambda: expected <= client.ask("getParameters", parameterNames=[]).keys())  # pylint: disable=cell-var-from-loop
        everything = observer.ask("getParameters", parameterNames=[])
        observer.send({"op": "subscribeParameterUpdates", "parameterNames": [name]})
        self.assertEqual(observer.ask("setParameters", parameters=[{"name": name, "value": 5000}]), {name: everything[name]})
        observer.told("for the role engineer")
        self.assertEqual(engineer.ask("setParameters", parameters=[{"name": name, "value": 5000}]), {name: 5000})
        wait_for("the update", lambda: observer.parameters.get(None) == {name: 5000})
        self.assertEqual(engineer.ask("setParameters", parameters=[{"name": name, "value": -1}]), {name: 5000})
        engineer.told("velodynelogger.cloud.max_points")
        self.assertEqual(engineer.ask("setParameters", parameters=[{"name": name}]), {name: everything[name]})
        self.assertEqual(engineer.ask("setParameters", parameters=[{"name": "none.such", "value": 1}]), {})

    def test_services_by_role(self):
        observer, engineer = self.client(), self.client("engineer")
        for service in engineer.services.values():
            for side in ("request", "response"):
                judge_schema(strict_json(service[side]["schema"]))
        self.assertNotIn("clientPublish", observer.info["capabilities"])
        self.assertNotIn("velodynelogger/settings.set", observer.services)
        self.assertIn("velodynelogger/settings.set", engineer.services)
        self.assertFalse([name for name in engineer.services if "motor.drive" in name or "/control." in name])
        self.assertEqual(observer.call("motorcontrol/daemon.info")["result"]["name"], "motorcontrol")
        told = {service["id"] for service in observer.services.values()}
        hidden = [number for number in range(1, 500) if number not in told]
        for number in hidden:  # those of others, too, which are told to nobody here
            observer.send(struct.pack("<BIII", 2, number, 10000 + number, 4) + b"json{}")
        wait_for("refusals", lambda: len(observer.failures) + len(observer.answers) >= len(hidden))
        refused = [answer for number, (_, answer) in observer.answers.items() if number > 10000]
        self.assertGreater(len(refused), 20)
        self.assertEqual({(answer["ok"], answer["code"]) for answer in refused}, {(False, -32001)})
        self.assertFalse(engineer.call("velodynelogger/settings.set", values={"none": 1})["ok"])

    @unittest.skipIf(os.geteuid() != 0, "root alone can be somebody else")
    def test_other_users_are_observers(self):
        script = ("import asyncio, websockets\nasync def main():\n async with websockets.connect('ws://127.0.0.1:%d', "
                  "subprotocols=['foxglove.websocket.v1']) as one: print(await one.recv())\nasyncio.run(main())") % self.web["engineer"]
        told = subprocess.run([sys.executable, "-c", script], user=65534, group=65534, extra_groups=[], cwd="/", capture_output=True, check=True)
        self.assertEqual(strict_json(told.stdout)["metadata"], {"role": "observer"})
        self.assertEqual(self.client("engineer").info["metadata"], {"role": "engineer"})

    def test_stop_is_for_everybody(self):
        observer = self.client()
        driver = Driver(self.robot.ports["motorcontrol"], "anna", vx=0.2)
        self.until_driving()
        self.assertTrue(observer.call("motorcontrol/motor.estop", wait_s=3)["ok"])
        self.until_still()
        self.assertTrue(self.motors.call("motor.state")["estop"])
        driver.end()
        observer.send(struct.pack("<BIII", 2, observer.services["motorcontrol/motor.stop"]["id"], 77, 4) + b"json{broken")
        wait_for("the answer", lambda: 77 in observer.answers)
        self.assertTrue(observer.answers[77][1]["ok"])  # a stop is never refused for its form
        release(self.motors)


class Hostile(WebCase):
    def raw(self, request, limit_s=15, role="observer"):
        """What is answered until the end of the connection."""
        with socket.create_connection(("127.0.0.1", self.web[role]), timeout=limit_s) as connection:
            connection.sendall(request)
            answer = b""
            try:
                while piece := connection.recv(65536):
                    answer += piece
            except ConnectionResetError:
                pass
            return answer

    def upgrade(self, *lines, role="observer"):
        port = self.web[role]
        head = ["GET / HTTP/1.1", f"Host: 127.0.0.1:{port}", "Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ=="]
        names = {line.split(":")[0] for line in lines}
        head = [line for line in head if line.split(":")[0] not in names]
        return ("\r\n".join([*head, *lines]) + "\r\n\r\n").encode()

    def first_line(self, request):
        """Of the answer, without waiting for the end."""
        with socket.create_connection(("127.0.0.1", self.web["observer"]), timeout=10) as connection:
            connection.sendall(request)
            return connection.recv(65536)

    def test_commands_from_the_network_need_a_word(self):
        def check(*settings):
            words = [word for setting in settings for word in ("--set", setting)]
            return subprocess.run([os.path.join(BINARIES, "hermes-web"), "--check", *words], capture_output=True, text=True, check=False)
        network, operator = "web.listen=0.0.0.0:8765", "web.role=operator"
        for settings in ((), (operator,), (network,), (network, operator, "insecure=true")):
            self.assertEqual(check(*settings).returncode, 0, settings)
        refused = check(network, operator)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("insecure", refused.stderr)
        for wrong in ("8765", "robot:8765", "udp://127.0.0.1:8765", "127.0.0.1:99999"):
            self.assertNotEqual(check("web.listen=" + wrong).returncode, 0, wrong)

    def test_documents(self):
        page = self.raw(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
        self.assertTrue(page.startswith(b"HTTP/1.1 200 OK\r\nContent-Type: text/html"), page[:80])
        self.assertIn(b"STOP", page)
        layout = json.loads(self.raw(b"GET /layout.json HTTP/1.1\r\n\r\n").split(b"\r\n\r\n", 1)[1])
        self.assertIn("configById", layout)
        for request, status in ((b"GET /etc/passwd HTTP/1.1\r\n\r\n", 404), (b"GET /../page.html HTTP/1.1\r\n\r\n", 404),
                                (b"POST / HTTP/1.1\r\n\r\n", 405), (b"\x16\x03\x01\r\n\r\n", 400), (b"\r\n\r\n", 400),
                                (b"GET / HTTP/1.1\r\nno colon\r\n\r\n", 400), (b"GET / HTTP/1.1\r\nX: " + b"x" * 9000, 431),
                                (b"{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"daemon.info\"}\r\n\r\n", 400)):
            self.assertEqual(self.raw(request)[:12], f"HTTP/1.1 {status}".encode(), request[:50])

    def test_half_requests_end(self):
        held = [socket.create_connection(("127.0.0.1", self.web["observer"]), timeout=30) for _ in range(4)]
        for connection, request in zip(held, (b"GET / HT", b"GET / HTTP/1.1\r\nHost: x\r\n", b"")):
            connection.sendall(request)
        begin = time.monotonic()
        with self.assertRaises(OSError):  # a byte now and then does not help
            while time.monotonic() < begin + 30:
                held[3].sendall(b"x")
                time.sleep(0.2)
        for connection in held[:3]:
            self.assertEqual(connection.recv(100), b"")
            connection.close()
        held[3].close()

    def test_who_may_connect(self):
        port, offer = self.web["observer"], "Sec-WebSocket-Protocol: foxglove.websocket.v1"
        self.assertEqual(self.raw(self.upgrade())[:12], b"HTTP/1.1 400")
        self.assertEqual(self.raw(self.upgrade("Sec-WebSocket-Protocol: chat"))[:12], b"HTTP/1.1 400")
        for origin in ("https://evil.example", "null", f"http://evil.example:{port}", "http://127.0.0.1:1", f"https://127.0.0.1:{port}"):
            self.assertEqual(self.raw(self.upgrade(offer, f"Origin: {origin}"))[:12], b"HTTP/1.1 403", origin)
        # A stranger's name that leads here.
        answer = self.raw(self.upgrade(offer, f"Host: evil.example:{port}", f"Origin: http://evil.example:{port}"))
        self.assertEqual(answer[:12], b"HTTP/1.1 403")
        for origin in (f"http://127.0.0.1:{port}", "https://app.foxglove.dev", "file://"):
            self.assertEqual(self.first_line(self.upgrade(offer, f"Origin: {origin}"))[:12], b"HTTP/1.1 101", origin)
        for offered in ("foxglove.sdk.v1", "chat, foxglove.sdk.v1, foxglove.websocket.v1"):
            answer = self.first_line(self.upgrade("Sec-WebSocket-Protocol: " + offered))
            self.assertEqual(answer.count(b"Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"), 1, answer)
        self.assertGreater(self.values()["refused"], 5)

    def test_bad_frames_are_answered(self):
        client = self.client()
        client.subscribe("motorcontrol/odometry")
        for frame, words in (("{broken", "no JSON"), ("[]", "object"), ("[" * 5000, "no JSON"), ({"op": "fly"}, "unknown operation"),
                             ({"op": 1}, "unknown operation"), ({}, "unknown operation"), (b"\xff\x00", "binary frame"), (b"", "binary frame"),
                             (struct.pack("<BIII", 2, 1, 1, 0xffffffff), "binary frame"), (struct.pack("<BI", 1, 5), "cannot drive"),
                             ({"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 99999}]}, "no such channel"),
                             ({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": "x"}]}, "no such channel"),
                             ({"op": "unsubscribe", "subscriptionIds": [5000, None, {}]}, "no such subscription"),
                             ({"op": "advertise", "channels": [{"id": 1, "topic": "x", "encoding": "json"}]}, "role operator")):
            client.statuses.clear()
            client.send(frame)
            client.told(words)
        client.send({"op": "subscribe", "subscriptions": {"id": 1}})  # no list: nothing to do
        dice, bad = random.Random(SEED), self.values()["bad_frames"]
        print("seed", SEED)
        for _ in range(300):
            client.send(dice.randbytes(dice.randrange(40)))
        wait_for("answers", lambda: self.values()["bad_frames"] > bad)
        client.wait("motorcontrol/odometry", 10)

    def test_large_frames_end_their_connection_alone(self):
        other = self.client()
        other.subscribe("motorcontrol/odometry")
        before = self.memory()
        for frame in ("x" * (2 * MB), b"\x02" * (2 * MB)):
            client = self.client()
            try:
                client.send(frame)
            except websockets.ConnectionClosed:
                pass
            wait_for("the end", client.is_over.is_set)
        offer = self.upgrade("Sec-WebSocket-Protocol: foxglove.websocket.v1")
        held = []
        for _ in range(8):  # frames that never end, and one that says it is huge
            held.append(socket.create_connection(("127.0.0.1", self.web["observer"])))
            held[-1].sendall(offer + struct.pack(">BBQ", 0x82, 0xff, (1 << 20) - 100) + bytes(500000))
        held.append(socket.create_connection(("127.0.0.1", self.web["observer"])))
        held[-1].sendall(offer + struct.pack(">BBQ", 0x82, 0xff, 1 << 40) + bytes(1000))
        other.wait("motorcontrol/odometry", 50)
        self.assertLess(self.memory() - before, 40 * MB)
        for connection in held:
            connection.close()
        wait_for("their end", lambda: self.values()["clients"] == 1)

    def test_places_come_back(self):
        offer = self.upgrade("Sec-WebSocket-Protocol: foxglove.websocket.v1")
        broken = self.upgrade("Sec-WebSocket-Protocol: foxglove.websocket.v1", "Sec-WebSocket-Key: ")
        for request in 5 * [offer, b"x\r\n\r\n", broken, b"GET / HTTP/1.1\r\n\r\n", b""]:
            held = [socket.create_connection(("127.0.0.1", self.web["observer"])) for _ in range(20)]
            for connection in held:
                connection.sendall(request)
            if request == offer:
                wait_for("clients", lambda: self.values()["clients"] == 20)
            for connection in held:
                connection.close()
            wait_for("their end", lambda: self.values()["clients"] == 0)
        wait_for("a place", lambda: self.first_line(offer)[:12] == b"HTTP/1.1 101")

    def test_too_many_clients(self):
        offer = self.upgrade("Sec-WebSocket-Protocol: foxglove.websocket.v1")
        held = [socket.create_connection(("127.0.0.1", self.web["observer"])) for _ in range(60)]
        for connection in held:
            try:
                connection.sendall(offer)
            except OSError:
                pass  # turned away already
        wait_for("clients", lambda: self.values()["clients"] == 32)
        wait_for("refusals", lambda: self.values()["refused"] >= 60 - 32)
        for connection in held:
            connection.close()
        wait_for("their end", lambda: self.values()["clients"] == 0)
        self.client().subscribe("motorcontrol/odometry")

    def test_one_of_many_does_not_read(self):
        topics = ("motorcontrol/odometry", "scanmatcher/pose", "velodynelogger/cloud")
        clients = [self.client() for _ in range(CLIENTS - 1)]
        before = self.memory()
        deaf = self.client()
        deaf.subscribe(*topics)
        deaf.wait("velodynelogger/cloud")
        deaf.loop.call_soon_threadsafe(deaf.socket.transport.pause_reading)
        truth = Listener(self.robot.ports["motorcontrol"], "odometry")
        truth.wait(1)
        for client in clients:
            client.subscribe("motorcontrol/odometry", "scanmatcher/pose")
        for client in clients:
            client.wait("motorcontrol/odometry", 1)
        begin = truth.messages[-1]["seq"]
        wait_for("drops", lambda: self.values()["dropped"] > 0, 90)
        truth.wait(len(truth.messages) + 50)
        stamps = {int(one["stamp"] * 1e9) // 1000 for one in truth.messages if one["seq"] > begin + 10}
        last = max(stamps)
        for client in clients:
            wait_for("the last", lambda: client.times["motorcontrol/odometry"][-1] // 1000 >= last - 1)  # pylint: disable=cell-var-from-loop
            mine = {time_ // 1000 for time_ in client.times["motorcontrol/odometry"]}
            missing = [one for one in stamps if not {one - 1, one, one + 1} & mine]
            self.assertEqual(missing, [])
            self.assertEqual([one for one in client.statuses if "buffer" in one["message"]], [])
        grown = (self.memory() - before) / MB
        print(f"{grown:.0f} MB more with one that does not read")
        self.assertLess(grown, MEMORY_MB)
        deaf.loop.call_soon_threadsafe(deaf.socket.transport.resume_reading)
        deaf.told("Send buffer limit reached")


class TeleopCase(WebCase):
    CHANNEL = 7

    def panel(self):
        client = self.client("engineer")
        self.assertIn("clientPublish", client.info["capabilities"])
        client.send({"op": "advertise", "channels": [{"id": self.CHANNEL, "topic": "cmd_vel", "encoding": "json",
                                                      "schemaName": "geometry_msgs/Twist"}]})
        return client

    def holder(self):
        return self.motors.call("control.state").get("holder")

    def until_free(self):
        self.until_still()
        wait_for("the end of the control", lambda: not self.motors.call("control.state")["held"])


class Teleop(TeleopCase):
    def test_a_closed_tab_stops_the_robot(self):
        for end in ("close", "drop"):
            panel = self.panel()
            self.until_driving(lambda: panel.twist(self.CHANNEL, 0.2))  # pylint: disable=cell-var-from-loop
            self.assertIn("web", self.holder())
            getattr(panel, end)()
            self.until_free()

    def test_a_killed_daemon_stops_the_robot(self):
        panel = self.panel()
        self.until_driving(lambda: panel.twist(self.CHANNEL, 0.2))
        process = self.robot.processes["engineer"]
        process.process.kill()
        self.until_free()
        process.process.wait()
        self.robot.ports["web"] = process.port
        self.robot.start("web")  # with the settings of the last: those of the engineer
        self.robot.processes["engineer"], self.robot.daemons["engineer"] = self.robot.processes.pop("web"), self.robot.daemons.pop("web")

    def test_what_was_wished_while_it_stood_still_is_void(self):
        panel = self.panel()
        self.until_driving(lambda: panel.twist(self.CHANNEL, 0.2))
        process = self.robot.processes["engineer"].process
        process.send_signal(signal.SIGSTOP)
        try:
            for _ in range(20):
                panel.twist(self.CHANNEL, 0.2)
            self.until_free()
        finally:
            process.send_signal(signal.SIGCONT)
        self.values("engineer")  # it works again, and has read them
        panel.ask("getParameters", parameterNames=[])
        self.assertLess(self.speed(), STILL)
        self.assertFalse(self.motors.call("control.state")["held"])
        time.sleep(1.2 * RELEASE_S)  # let go
        self.until_driving(lambda: panel.twist(self.CHANNEL, 0.2))

    def test_let_go_stops_the_robot(self):
        panel = self.panel()
        self.until_driving(lambda: panel.twist(self.CHANNEL, turn=0.5))
        self.until_free()  # nothing is sent any more
        self.until_driving(lambda: panel.twist(self.CHANNEL, -0.2))  # and it can be pressed again
        panel.send({"op": "unadvertise", "channelIds": [self.CHANNEL]})
        self.until_free()

    def test_it_takes_the_control_from_nobody(self):
        driver = Driver(self.robot.ports["motorcontrol"], "anna", omega=0.3)
        self.until_driving()
        panel = self.panel()
        end = threading.Event()
        presses = threading.Thread(target=lambda: [panel.twist(self.CHANNEL, 0.2) for _ in iter(lambda: end.wait(0.1), True)])
        presses.start()
        panel.told("anna")
        self.assertEqual(self.holder(), "anna")
        self.assertGreater(abs(self.motors.call("motor.state")["twist"]["omega"]), 0.1)
        driver.end()
        self.until_free()  # still pressed: it has to be let go first
        time.sleep(0.5)
        self.assertLess(self.speed(), STILL)
        end.set()
        presses.join()

    def test_after_a_stop_of_somebody_it_must_be_let_go(self):
        panel, phone = self.panel(), self.client()
        self.until_driving(lambda: panel.twist(self.CHANNEL, 0.2))
        self.assertTrue(phone.call("motorcontrol/motor.stop", wait_s=3)["ok"])

        def is_held_off():
            panel.twist(self.CHANNEL, 0.2)
            time.sleep(0.05)
            return any("drive" == one.get("id") for one in panel.statuses)
        wait_for("a word", is_held_off)
        self.until_free()

    def test_bad_wishes_move_nothing(self):
        panel = self.panel()
        for json_text in (b"", b"{", b"[1]", b"{}", b'{"linear":{"x":"fast"}}', b'{"linear":[1]}', b'{"linear":{"x":NaN}}'):
            panel.send(struct.pack("<BI", 1, self.CHANNEL) + json_text)
        panel.send(struct.pack("<BI", 1, 8) + b'{"linear":{"x":1}}')
        panel.told("not advertised")
        self.assertLess(self.speed(), STILL)
        self.assertFalse(self.motors.call("control.state")["held"])


@unittest.skipUnless(os.environ.get("HERMES_TIMING"), "its tier is timing")
class Times(TeleopCase):
    """How long the robot drives on. What browsers and networks add is not in it."""

    def until_standing(self, act):
        panel = self.panel()
        self.until_driving(lambda: panel.twist(self.CHANNEL, 0.3))
        act(panel)
        begin = time.monotonic()
        wait_for("standstill", lambda: fastest_wheel(self.robot.daemons["simulator"]) < STILL / 0.1)
        took = time.monotonic() - begin
        self.until_free()
        return took

    def test_times(self):
        for what, act, limit_s in (("a closed tab", lambda panel: panel.close(), CLOSED_S), ("a crashed browser", lambda panel: panel.drop(), CLOSED_S),
                                   ("a button let go", lambda panel: None, RELEASE_S + CLOSED_S)):
            times = [self.until_standing(act) for _ in range(5)]
            print(f"{what}: {max(times):.2f} s at most")
            self.assertLess(max(times), limit_s, what)


if __name__ == "__main__":
    unittest.main(verbosity=2, defaultTest="Times.test_times" if os.environ.get("HERMES_TIMING") else None)
