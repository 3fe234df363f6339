#!/usr/bin/env python3
"""A client for Hermes daemons over a serial line or a radio modem, in plain Python 3: the framing `serial` of docs/protocol.md.

    with SerialDaemon("/dev/ttyUSB0", 115200) as motors:
        print(motors.call("daemon.status")["state"])
        motors.notify("motor.drive", vx=0.2)
        for message in motors.subscribe("odometry", max_rate_hz=5):
            print(message["stamp"], message["data"])

The daemon listens with --listen 'serial:///dev/ttyS1?baud=115200&protocol=serial'. Frames that are damaged on their way are
dropped here and there; a call is repeated until its reply comes, and the daemon carries it out once. Large replies and topics
come in pieces, which are put together here; requests go in one frame each, so they should be short. A frame that is whole but
nonsense counts as damaged, too. When the device goes (an adapter is pulled out), ConnectionError says which.

As a program it calls one command: hermes_serial.py /dev/ttyUSB0 motor.drive vx=0.2
"""
import argparse
import array
import collections
import fcntl
import json
import os
import random
import select
import struct
import sys
import termios
import time
import tty

PIECE, PIECE_TO_REPORT, REPORT = 0x10, 0x11, 0x12
PIECE_BYTES, WINDOW, MOST_PIECES, ENDED = 96, 64, 0xFFFF, 0xFFFF
MOST_BEGUN, MOST_BYTES = 8, 2 << 20  # messages in pieces, and of one: no reply is larger (limits.reply_bytes)
MOST_FRAME_BYTES = 1 << 20


class DaemonError(Exception):
    """The daemon refused a call: code, message, and data that name the reason."""

    def __init__(self, error):
        super().__init__(f"{error['message']} ({error['code']})")
        self.code, self.message, self.data = error["code"], error["message"], error.get("data")


def make_crc_table():
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = byte >> 1 ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    return table


CRC_TABLE = make_crc_table()


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc = crc >> 8 ^ CRC_TABLE[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFFFFFF


def seal(content):
    return content + struct.pack("<I", crc32c(content))


def unseal(content):
    """Without its CRC; ValueError when it is damaged."""
    if len(content) <= 4 or seal(content[:-4]) != content:
        raise ValueError("damaged")
    return content[:-4]


def stuff(data):
    """COBS: no zero in it."""
    out = bytearray()
    for run in bytes(data).split(b"\0"):
        while len(run) >= 254:
            out += b"\xff" + run[:254]
            run = run[254:]
        out += bytes([len(run) + 1]) + run
    return bytes(out)


def unstuff(data):
    """ValueError when it is no COBS."""
    out, at = bytearray(), 0
    while at < len(data):
        code = data[at]
        if at + code > len(data):
            raise ValueError("no COBS")
        out += data[at + 1:at + code]
        at += code
        if code < 0xFF and at < len(data):
            out.append(0)
    return bytes(out)


def to_cbor(value):
    """What JSON can hold, as CBOR (RFC 8949)."""
    def head(kind, number):
        for more, code in ((0, "B"), (24, "B"), (25, "H"), (26, "I"), (27, "Q")):
            if number < (24 if more == 0 else 1 << 8 * struct.calcsize(code)):
                return bytes([kind << 5 | (more or number)]) + (struct.pack(">" + code, number) if more else b"")
        raise OverflowError(number)
    if value is None or isinstance(value, bool):
        return {None: b"\xf6", False: b"\xf4", True: b"\xf5"}[value]
    if isinstance(value, int):
        return head(0, value) if value >= 0 else head(1, -1 - value)
    if isinstance(value, float):
        return b"\xfb" + struct.pack(">d", value)
    if isinstance(value, str):
        return head(3, len(value.encode())) + value.encode()
    if isinstance(value, dict):
        return head(5, len(value)) + b"".join(to_cbor(key) + to_cbor(one) for key, one in value.items())
    return head(4, len(value)) + b"".join(map(to_cbor, value))


TYPED = {64: "B", 69: "<H", 70: "<I", 72: "b", 77: "<h", 78: "<i", 85: "<f", 86: "<d"}  # RFC 8746; what daemons send


def from_cbor(data, at=0):
    """(value, where it ends). What daemons send."""
    kind, more = data[at] >> 5, data[at] & 31
    at += 1
    if kind == 7:
        floats = {25: ">e", 26: ">f", 27: ">d"}
        if more in floats:
            size = struct.calcsize(floats[more])
            return struct.unpack(floats[more], data[at:at + size])[0], at + size
        return {20: False, 21: True, 22: None}[more], at
    endless = more == 31
    size = {24: 1, 25: 2, 26: 4, 27: 8}.get(more, 0)
    number = int.from_bytes(data[at:at + size], "big") if size else more
    at += size
    if kind in (0, 1):
        return (number if kind == 0 else -1 - number), at
    if kind in (2, 3) and not endless:
        raw = data[at:at + number]
        return (raw.decode() if kind == 3 else raw), at + number
    if kind == 6:
        value, at = from_cbor(data, at)
        if number in TYPED and isinstance(value, bytes):
            numbers = array.array(TYPED[number][-1], value)
            if sys.byteorder == "big":
                numbers.byteswap()
            value = list(numbers)
        return value, at
    items, left = [], number * (2 if kind == 5 else 1)
    while data[at] != 0xFF if endless else left > 0:
        value, at = from_cbor(data, at)
        items.append(value)
        left -= 1
    at += endless
    if kind == 3:
        return "".join(items), at
    return (dict(zip(items[::2], items[1::2])) if kind == 5 else items), at


def message_in(content):
    """A message of a topic, or a reply to one request; ValueError when it is neither."""
    try:
        message, end = from_cbor(content)
    except (LookupError, OverflowError, RecursionError, TypeError, struct.error) as error:
        raise ValueError("no CBOR") from error
    if end != len(content) or not isinstance(message, dict):
        raise ValueError("no message")
    params, error = message.get("params"), message.get("error")
    is_topic = message.get("method") == "topic" and isinstance(params, dict) and isinstance(params.get("subscription"), int)
    is_error = isinstance(error, dict) and {"code", "message"} <= error.keys()
    if not is_topic and not ("id" in message and ("result" in message or is_error)):
        raise ValueError("no message of a daemon")
    return message


class Pieces:
    """Large messages on their way in. Beyond MOST_BEGUN the one that got no piece for the longest time is forgotten."""

    def __init__(self):
        self.begun = {}  # (number, total): (bytes, index of the first piece that is missing, bits of those from that one on)
        self.ended = collections.deque(maxlen=32)

    def take(self, frame):
        """(the message with its CRC when it is whole, the report that is due), or None for either. ValueError: no such piece."""
        if len(frame) <= 8:
            raise ValueError("no piece")
        kind, number, index = struct.unpack_from("<BHH", frame)
        total, at, piece = int.from_bytes(frame[5:8], "little"), index * PIECE_BYTES, frame[8:]
        count = -(-total // PIECE_BYTES)
        if count > MOST_PIECES or len(piece) != min(PIECE_BYTES, total - at):
            raise ValueError("no such piece")
        key, ended = (number, total), struct.pack("<BHH", REPORT, number, ENDED)
        if key in self.ended:
            return None, ended if kind == PIECE_TO_REPORT else None
        content, base, later = self.begun.pop(key, (bytearray(), 0, 0))
        if index >= base + WINDOW:  # the beginning went to somebody else
            return None, ended
        if total > MOST_BYTES:
            self.ended.append(key)
            return None, ended
        if index >= base:
            content.extend(bytes(max(0, at + len(piece) - len(content))))
            content[at:at + len(piece)] = piece
            later |= 1 << index - base
        while later & 1:
            base, later = base + 1, later >> 1
        if base == count:
            self.ended.append(key)
            return bytes(content), ended
        self.begun[key] = content, base, later  # as the newest
        if len(self.begun) > MOST_BEGUN:
            del self.begun[next(iter(self.begun))]
        bits = later.to_bytes(8, "little").rstrip(b"\0")
        return None, struct.pack("<BHH", REPORT, number, base) + bits if kind == PIECE_TO_REPORT else None


def open_port(device, baud):
    """The descriptor of a serial line that passes on bytes as they are, for this program alone. OSError names the device."""
    if not hasattr(termios, f"B{baud}"):
        raise OSError(f"{device}: no serial line has {baud} baud")
    port = os.open(device, os.O_RDWR | os.O_NOCTTY)
    try:
        fcntl.flock(port, fcntl.LOCK_EX | fcntl.LOCK_NB)
        tty.setraw(port)
        attributes = termios.tcgetattr(port)
        attributes[4] = attributes[5] = getattr(termios, f"B{baud}")
        termios.tcsetattr(port, termios.TCSANOW, attributes)
    except (termios.error, BlockingIOError) as error:
        os.close(port)
        raise OSError(f"{device}: " + ("in use by another program" if isinstance(error, OSError) else "is no serial line")) from error
    return port


class SerialDaemon:
    """One daemon at the other end of a line, which answers within `timeout` seconds. Not for use from several threads at once."""

    def __init__(self, device, baud=115200, timeout=5.0):
        self.device, self.timeout, self.baud = device, timeout, baud
        self.port = open_port(device, baud)
        # Replies are kept for a while by what was asked: no id may be that of an earlier program.
        self.id = random.randrange(1 << 31)
        self.buffer = b""
        self.pieces = Pieces()
        self.topics = {}  # messages that were not asked for as yet, by subscription of ours
        self.early = None  # while one is made: those of others, one of which it may be
        self.round_trip = 0.05
        self.damaged = self.repeated = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Ends the subscriptions, too: a line has no end that the daemon could see."""
        self.timeout = min(self.timeout, 2)
        try:
            for subscription in self.topics:
                self.call("topics.unsubscribe", subscription=subscription)
        except (OSError, DaemonError):
            pass  # the daemon has gone, or begun anew; who comes next on this line unsubscribes what is left
        finally:
            os.close(self.port)

    def call(self, method, **params):
        """The result of a command; raises DaemonError when the daemon refuses it."""
        return self._ask(method, params, 0)

    def estop(self):
        """Stops the robot. At first it is sent again without waiting for a reply: some of many get through."""
        # Not behind what waits in the kernel. A frame that is cut by this spoils nothing: each begins with a zero, which ends it.
        self._do(termios.tcflush, termios.TCOFLUSH)
        return self._ask("motor.estop", {}, 9)

    def _ask(self, method, params, hurried):
        self.id += 1
        request = to_cbor({"jsonrpc": "2.0", "id": self.id, "method": method, "params": params})
        begun = time.monotonic()
        period, due = 2 * self.round_trip + 0.02, begun
        while time.monotonic() < begun + self.timeout:
            if time.monotonic() >= due:
                self.repeated += due > begun
                self._send(request)
                if hurried > 0:
                    due, hurried = time.monotonic() + 10 * (len(request) + 8) / self.baud, hurried - 1
                else:
                    due, period = time.monotonic() + period, min(1.5 * period, 1)
            for message in self._receive(due):
                if message.get("id") == self.id:
                    self.round_trip += 0.2 * (min(time.monotonic() - begun, 1) - self.round_trip)
                    if "result" in message:
                        return message["result"]
                    raise DaemonError(message["error"])
        raise TimeoutError(f"{method}: no reply within {self.timeout} s")

    def notify(self, method, **params):
        """Without an answer, and never repeated: what is soon sent anew."""
        self._send(to_cbor({"jsonrpc": "2.0", "method": method, "params": params}))

    def subscribe(self, topic, **options):
        """Yields the topic's messages {seq, stamp, dropped, data, ...} as they come, without end."""
        self.early = collections.deque(maxlen=100)
        try:
            own = self.call("topics.subscribe", topic=topic, **options)["subscription"]
            queue = self.topics[own] = collections.deque((one for one in self.early if one["subscription"] == own), maxlen=100)
        finally:
            self.early = None
        while True:
            while not queue:
                self._receive(time.monotonic() + 1)
            yield queue.popleft()

    def _do(self, action, *arguments):
        try:
            return action(self.port, *arguments)
        except (OSError, termios.error) as error:
            raise ConnectionError(f"{self.device}: {error.args[-1]}") from error

    def _send(self, content):
        frame = b"\0" + stuff(seal(content)) + b"\0"
        while frame:
            frame = frame[self._do(os.write, frame):]

    def _receive(self, until):
        """The replies that come until then, at least those of one reading."""
        wait = max(0.0, until - time.monotonic())
        if not select.select([self.port], [], [], wait)[0]:
            return []
        data = self._do(os.read, 4096)
        if not data:
            raise ConnectionError(f"{self.device}: the line has gone")
        *frames, self.buffer = (self.buffer + data).split(b"\0")
        if len(self.buffer) > MOST_FRAME_BYTES:
            self.buffer = b""
            self.damaged += 1
        messages = []
        for frame in filter(None, frames):
            try:
                message = self._message_of(frame)
            except ValueError:
                self.damaged += 1
                continue
            if message and message.get("method") == "topic":
                self._keep(message["params"])
            elif message:
                messages.append(message)
        return messages

    def _message_of(self, frame):
        """What the frame holds or makes whole, if anything; ValueError when it is damaged, or nonsense."""
        content = unseal(unstuff(frame))
        if content[0] == REPORT:
            return None  # nothing is sent in pieces here
        if content[0] in (PIECE, PIECE_TO_REPORT):
            whole, report = self.pieces.take(content)
            if report:
                self._send(report)
            if not whole:
                return None
            content = unseal(whole)
        return message_in(content)

    def _keep(self, message):
        subscription = message["subscription"]
        if subscription in self.topics:
            self.topics[subscription].append(message)
        elif self.early is not None:
            self.early.append(message)
        else:  # made by an earlier program
            self.notify("topics.unsubscribe", subscription=subscription)


def parameter(text):
    """NAME=VALUE, of which the value is JSON or a text."""
    name, value = text.split("=", 1)
    try:
        return name, json.loads(value)
    except ValueError:
        return name, value


def main():
    parser = argparse.ArgumentParser(description="Calls one command of a daemon at the other end of a serial line.")
    parser.add_argument("device")
    parser.add_argument("method")
    parser.add_argument("parameters", nargs="*", type=parameter, metavar="NAME=VALUE")
    parser.add_argument("--baud", type=int, default=115200)
    arguments = parser.parse_args()
    try:
        with SerialDaemon(arguments.device, arguments.baud) as daemon:
            print(json.dumps(daemon.call(arguments.method, **dict(arguments.parameters)), indent=4))
    except KeyboardInterrupt:
        sys.exit(130)
    except (OSError, DaemonError) as error:
        sys.exit(f"hermes_serial.py: {error}")


if __name__ == "__main__":
    main()
