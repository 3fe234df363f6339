#!/usr/bin/env python3
"""docs/examples/hermes_serial.py against a daemon at the other end of a serial line, with damage on it."""
import contextlib
import os
import random
import struct
import subprocess
import sys
import tempfile
import threading
import time
import tty
import unittest

from support import BINARIES, SOURCE, wait_for
sys.path.insert(0, os.path.join(SOURCE, "docs", "examples"))
import hermes_serial  # noqa: E402
from hermes_serial import DaemonError, Pieces, SerialDaemon, crc32c, from_cbor, seal, stuff, to_cbor, unseal, unstuff  # noqa: E402


class Noisy(SerialDaemon):
    """Hears and says one byte in so many wrongly."""

    def __init__(self, device, one_in, seed):
        super().__init__(device)
        self.one_in, self.source = one_in, random.Random(seed)

    def spoil(self, data):
        return bytes(byte ^ self.source.randrange(1, 256) if self.source.randrange(self.one_in) == 0 else byte for byte in data)


class OtherEnd:
    """A line's other end that says what no daemon would, and hears all."""

    def __init__(self):
        self.port, self.near = os.openpty()
        tty.setraw(self.near)
        self.device = os.ttyname(self.near)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for port in (self.port, self.near):
            if port is not None:
                os.close(port)

    def say(self, *contents):
        os.write(self.port, b"\0" + b"".join(stuff(seal(content)) + b"\0" for content in contents))

    def hear(self):
        """The contents of the whole frames that have come, and how many bytes that was."""
        data = b""
        os.set_blocking(self.port, False)
        try:
            while part := os.read(self.port, 1 << 16):
                data += part
        except BlockingIOError:
            os.set_blocking(self.port, True)
        contents = []
        for frame in filter(None, data.split(b"\0")):
            with contextlib.suppress(ValueError):
                contents.append(unseal(unstuff(frame)))
        return contents, len(data)

    def vanish(self):
        os.close(self.port)
        self.port = None


def piece(index, total, content, number=7, kind=0x11):
    return struct.pack("<BHH", kind, number, index) + total.to_bytes(3, "little") + content


def report(base, later=b"", number=7):
    return struct.pack("<BHH", 0x12, number, base) + later


def reply_to(client, result="fine"):
    """To what it will ask next."""
    return to_cbor({"jsonrpc": "2.0", "id": client.id + 1, "result": result})


def topic_message(subscription, data):
    return to_cbor({"jsonrpc": "2.0", "method": "topic", "params": {"subscription": subscription, "topic": "pose", "seq": 1, "stamp": 0.5, "data": data}})


def unsubscribed_by(client):
    """The subscriptions that it ends from now on because they are of others."""
    numbers, notify = [], client.notify
    client.notify = lambda method, **params: (numbers.append(params["subscription"]), notify(method, **params))
    return numbers


class NonsenseTest(unittest.TestCase):
    """What comes from a daemon is believed no more than what comes to one."""

    def test_pieces(self):
        whole, ended = bytes(96), report(0xFFFF)
        pieces = Pieces()
        for at, total, content, expected in ((0, 192, whole, report(1)), (1, 192, whole, ended), (1, 192, whole, ended)):
            self.assertEqual(pieces.take(piece(at, total, content))[1], expected)
        self.assertEqual(pieces.take(piece(63, 9600, whole, 8))[1], report(0, bytes(7) + b"\x80", 8))
        self.assertEqual(pieces.take(piece(0, 9600, whole, 8, 0x10)), (None, None))
        self.assertEqual(pieces.take(piece(64, 9600, whole, 8))[1], report(1, bytes(7) + b"\xc0", 8))
        self.assertEqual(pieces.take(piece(65, 9600, whole, 8))[1], report(0xFFFF, number=8))  # 64 behind the first that is missing
        self.assertEqual(pieces.take(piece(70, 9600, whole, 9, 0x10))[1], report(0xFFFF, number=9))  # the beginning went to somebody else
        self.assertEqual(pieces.begun, {})

    def test_pieces_are_bounded(self):
        pieces = Pieces()
        self.assertEqual(pieces.take(piece(0, 3 << 20, bytes(96)))[1], report(0xFFFF))
        self.assertEqual(pieces.begun, {})
        for number in range(100):
            pieces.take(piece(0, 960, bytes(96), 0))
            pieces.take(piece(0, 960, bytes(96), number))
        self.assertEqual(sorted(number for number, _ in pieces.begun), [0, *range(93, 100)])  # and the one in use was not forgotten

    def test_no_piece(self):
        for frame in (b"\x10ab", b"\x11", piece(0, 0, b""), piece(0, 0, b"a"), piece(0, 96, b""), piece(0, 96, bytes(95)), piece(0, 95, bytes(96)),
                      piece(1, 96, bytes(96)), piece(2, 100, b"aaaa"), piece(0xFFFF, 0xFFFFFF, bytes(96)), piece(0, 0xFFFFFF, bytes(96))):
            with self.assertRaises(ValueError, msg=frame):
                Pieces().take(frame)

    def test_nonsense_is_counted(self):
        with OtherEnd() as other, SerialDaemon(other.device) as client:
            client.timeout = 10
            for nonsense in (b"\x10ab", piece(2, 100, b"aaaa"), piece(0, 5, b"abcde"), piece(0, 8, seal(b"\x80\x80\x80\x80"), 8), b"\x55", b"\x80",
                             to_cbor([{"jsonrpc": "2.0", "id": 1, "result": 1}]), to_cbor({"method": "topic"}), to_cbor({"method": "topic", "params": 3}),
                             to_cbor({"method": "topic", "params": {"subscription": [1]}}), to_cbor({"id": client.id + 1}), to_cbor({}),
                             to_cbor({"id": client.id + 1, "error": 3}), to_cbor({"id": client.id + 1, "error": {"code": 1}}),
                             b"\xa1\x80\x01", b"\xa1", b"\xbf", b"\xa1\x61\xff\x01", b"\xa1\x61a" + b"\x81" * 3000, b"\xa1\x61a\xfb", b"\xa1\x61a\xf7",
                             b"\xa1\x61a\x1c", b"\xa1\x61a\xd8\x56\x41a", b"\xa1\x61a\x7f\x01\xff", b"\xbb" + b"\xff" * 8, b"\xa1\x61a\x7b" + b"\xff" * 8):
                damaged = client.damaged
                other.say(nonsense, reply_to(client))
                self.assertEqual(client.call("any"), "fine", nonsense[:20])
                self.assertEqual(client.damaged, damaged + 1, nonsense[:20])
                other.hear()
            damaged = client.damaged
            other.say(report(3), to_cbor({"id": None, "error": {"code": -32700, "message": "no request"}}), reply_to(client))
            self.assertEqual(client.call("any"), "fine")
            self.assertEqual(client.damaged, damaged)  # these are for others, and in order

    def test_random_frames(self):
        seed = int(os.environ.get("HERMES_SEED", random.randrange(1 << 30)))
        print(f"HERMES_SEED={seed}")
        source = random.Random(seed)
        with OtherEnd() as other, SerialDaemon(other.device) as client:
            client.timeout = 10
            for _ in range(1000):
                model = bytearray(source.choice((topic_message(1, {"a": [1.5, "x", None]}), reply_to(client, {"b": [1, 2]}), piece(3, 900, bytes(96)),
                                                 b"\xa1\x61a\xd8\x56\x48" + bytes(8), bytes(source.randrange(256) for _ in range(20)))))
                for _ in range(source.randrange(1, 4)):
                    model[source.randrange(len(model))] = source.randrange(256)
                other.say(bytes(model[:source.randrange(1, len(model) + 1)]), to_cbor({"jsonrpc": "2.0", "id": client.id + 1, "result": "fine"}))
                client.call("any")
                other.hear()

    def test_endless_frame(self):
        with OtherEnd() as other, SerialDaemon(other.device) as client:
            client.timeout = 30
            reply, receive, largest = reply_to(client), client._receive, 0

            def speak():
                for _ in range(400):
                    os.write(other.port, b"x" * 10000)
                other.say(reply)

            def watch(until):
                nonlocal largest
                messages = receive(until)
                largest = max(largest, len(client.buffer))
                return messages
            client._receive = watch
            speaker = threading.Thread(target=speak)
            speaker.start()
            self.assertEqual(client.call("any"), "fine")
            speaker.join()
            self.assertLess(largest, 3 << 20)
            self.assertGreater(client.damaged, 0)


class LineTest(unittest.TestCase):
    def test_device_has_gone(self):
        for use in (lambda client: client.call("any"), lambda client: client.estop(), lambda client: client.notify("any"),
                    lambda client: next(client.subscribe("pose")), lambda client: client._receive(time.monotonic() + 10)):
            with OtherEnd() as other:
                with SerialDaemon(other.device) as client:
                    client.timeout = 10
                    other.vanish()
                    begun = time.monotonic()
                    with self.assertRaises(ConnectionError) as gone:
                        use(client)
                    self.assertIn(other.device, str(gone.exception))
                    self.assertLess(time.monotonic() - begun, 5)

    def test_stop_passes_what_waits_in_the_kernel(self):
        with OtherEnd() as other, SerialDaemon(other.device) as client:
            waiting = 0
            os.set_blocking(client.port, False)
            try:
                while waiting < 1 << 20:
                    waiting += os.write(client.port, b"\0" + stuff(seal(to_cbor({"method": "motor.drive", "params": {"vx": 0.2}}))) + b"\0")
            except BlockingIOError:
                os.set_blocking(client.port, True)
            client.timeout = 0.1
            with self.assertRaises(TimeoutError):
                client.estop()
            contents, size = other.hear()
            self.assertLess(size, waiting / 2)
            stops = [b"motor.estop" in content for content in contents]
            self.assertGreater(stops.count(True), 1)
            self.assertEqual(stops, sorted(stops))  # the frame before the first one may be cut; none of these is

    def test_messages_of_others(self):
        with OtherEnd() as other, SerialDaemon(other.device) as client:
            client.timeout = 10
            other.say(*(topic_message(number, 0) for number in range(40, 50)), reply_to(client))
            client.call("any")
            asked = [from_cbor(content)[0] for content in other.hear()[0]]
            self.assertEqual([one["params"]["subscription"] for one in asked if one["method"] == "topics.unsubscribe"], list(range(40, 50)))
            self.assertFalse(any("id" in one for one in asked if one["method"] == "topics.unsubscribe"))
            self.assertEqual(len(client.topics), 0)
            other.say(topic_message(4, "foreign"), topic_message(5, "early"), reply_to(client, {"subscription": 5}), topic_message(5, "late"))
            messages = client.subscribe("pose")
            self.assertEqual([next(messages)["data"] for _ in range(2)], ["early", "late"])
            self.assertEqual(list(client.topics), [5])
            client.timeout = 0.1  # nobody answers its last words


class SerialClientTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.link = os.path.join(self.folder.name, "line")
        self.daemon = subprocess.Popen([os.path.join(BINARIES, "hermes-softwaretrigger"), "--set", "access.plain=engineer", "--listen", f"pty://{self.link}?protocol=serial"],
                                       stderr=subprocess.DEVNULL)
        wait_for("the line", lambda: os.path.exists(self.link))

    def tearDown(self):
        self.daemon.terminate()
        self.daemon.wait()
        self.folder.cleanup()

    def test_parts(self):
        self.assertEqual(crc32c(b"123456789"), 0xE3069283)
        source = random.Random(1)
        for size in (0, 1, 253, 254, 255, 508, 509, 1000):
            for zeros in (1, 10, 1000):
                data = bytes(source.randrange(256) if source.randrange(zeros) else 0 for _ in range(size))
                self.assertEqual(unstuff(stuff(data)), data)
                self.assertNotIn(0, stuff(data))
        value = {"a": [1, -1, 23, 24, 255, 256, 65536, 1 << 40, -500, 1.5, None, True, False], "\u00e4": "x" * 300, "": {}}
        self.assertEqual(from_cbor(to_cbor(value))[0], value)

    def test_calls_topics_errors(self):
        with SerialDaemon(self.link) as trigger:
            self.assertEqual(trigger.call("daemon.info")["name"], "softwaretrigger")
            self.assertGreater(len(trigger.call("rpc.discover")["methods"]), 10)  # in pieces
            with self.assertRaises(DaemonError) as refused:
                trigger.call("no.such")
            self.assertEqual(refused.exception.code, -32601)
            messages = trigger.subscribe("settings")
            self.assertIsInstance(next(messages)["data"], dict)
            trigger.notify("daemon.info")
            self.assertEqual(trigger.damaged, 0)

    def test_subscriptions_end(self):
        left = SerialDaemon(self.link)
        next(left.subscribe("settings"))
        os.close(left.port)  # as one that was killed
        with SerialDaemon(self.link) as second:
            unsubscribed, messages = unsubscribed_by(second), second.subscribe("settings")
            next(messages)
            second.call("settings.set", values={"limits": {"clients": 7}})
            next(messages)
            wait_for("a message of the first one's subscription", lambda: (second.call("daemon.info"), unsubscribed)[1])
            self.assertEqual(set(unsubscribed), set(left.topics))
            known = len(unsubscribed)
            second.call("settings.set", values={"limits": {"clients": 8}})
            next(messages)
            second.call("daemon.status")
            self.assertEqual(len(unsubscribed), known)
            self.assertEqual(len(second.topics), 1)
        with SerialDaemon(self.link) as third:
            unsubscribed, messages = unsubscribed_by(third), third.subscribe("settings")
            next(messages)
            third.call("settings.set", values={"limits": {"clients": 9}})
            next(messages)
            for _ in range(5):
                third.call("daemon.status")
            self.assertEqual(unsubscribed, [])

    def test_damaged_line(self):
        seed = int(os.environ.get("HERMES_SEED", random.randrange(1 << 30)))
        print(f"HERMES_SEED={seed}")
        real_write, real_read = os.write, os.read
        with Noisy(self.link, 300, seed) as trigger:
            trigger.timeout = 30
            hermes_serial.os.write = lambda port, data: real_write(port, trigger.spoil(data)) if port == trigger.port else real_write(port, data)
            hermes_serial.os.read = lambda port, size: trigger.spoil(real_read(port, size)) if port == trigger.port else real_read(port, size)
            try:
                before = time.monotonic()
                for i in range(30):
                    trigger.call("settings.set", values={"limits": {"clients": 5 + i}})
                    self.assertEqual(trigger.call("settings.get", path="limits.clients"), 5 + i)
                self.assertGreater(len(trigger.call("topics.list")), 3)
                with self.assertRaises(DaemonError):
                    trigger.estop()  # a trigger has no motors
                self.assertEqual(trigger.call("settings.get", path="limits.clients"), 34)  # late replies to repeats are passed over
                took = time.monotonic() - before
            finally:
                hermes_serial.os.write, hermes_serial.os.read = real_write, real_read
            channel = next(one for one in trigger.call("daemon.status")["health"] if one["name"] == "channel")["values"]
            print(f"63 calls in {took:.1f} s; {trigger.repeated} repeated, {trigger.damaged} frames damaged here, "
                  f"{channel['line_damaged_frames']} there")
            self.assertGreater(trigger.repeated, 0)
            self.assertGreater(channel["line_repeated_requests"], 0)
            self.assertLessEqual(channel["requests"], 64)  # and none was carried out twice


if __name__ == "__main__":
    unittest.main()
