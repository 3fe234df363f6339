"""A client for Hermes daemons over a serial line or a radio modem, in plain Python 3: the framing `serial` of docs/protocol.md.

    with SerialDaemon("/dev/ttyUSB0", 115200) as motors:
        print(motors.call("daemon.status")["state"])
        motors.notify("motor.drive", vx=0.2)
        for message in motors.subscribe("odometry", max_rate_hz=5):
            print(message["stamp"], message["data"])

The daemon listens with --listen 'serial:///dev/ttyS1?baud=115200&protocol=serial'. Frames that are damaged on their way are
dropped here and there; a call is repeated until its reply comes, and the daemon carries it out once. Large replies and topics
come in pieces, which are put together here; requests go in one frame each, so they should be short.
"""
import array
import collections
import os
import random
import select
import struct
import sys
import termios
import time
import tty

PIECE, PIECE_TO_REPORT, REPORT = 0x10, 0x11, 0x12
PIECE_BYTES, ENDED = 96, 0xFFFF


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
    """Without its CRC; None when it is damaged."""
    return content[:-4] if len(content) > 4 and seal(content[:-4]) == content else None


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
    """None when it is no COBS."""
    out, at = bytearray(), 0
    while at < len(data):
        code = data[at]
        if at + code > len(data):
            return None
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


class Pieces:
    """Large messages on their way in."""

    def __init__(self):
        self.begun = {}  # (number, total): {index: bytes}
        self.ended = collections.deque(maxlen=32)

    def take(self, frame):
        """(the message when it is whole, the report that is due), or None for either."""
        kind, number, index = struct.unpack_from("<BHH", frame)
        key = number, int.from_bytes(frame[5:8], "little")
        count = -(-key[1] // PIECE_BYTES)
        if key not in self.ended:
            pieces = self.begun.setdefault(key, {})
            pieces[index] = frame[8:]
            if len(self.begun) > 8:
                del self.begun[next(iter(self.begun))]
            if len(pieces) == count:
                del self.begun[key]
                self.ended.append(key)
                return unseal(b"".join(pieces[i] for i in range(count))), struct.pack("<BHH", REPORT, number, ENDED)
        if kind != PIECE_TO_REPORT:
            return None, None
        pieces = self.begun.get(key)
        base = next(i for i in range(count + 1) if i not in pieces) if pieces else ENDED
        later = sum(1 << i - base for i in pieces or () if i > base)
        bits = later.to_bytes(8, "little").rstrip(b"\0")
        return None, struct.pack("<BHH", REPORT, number, base) + bits


class SerialDaemon:
    """One daemon at the other end of a line. Not for use from several threads at once."""

    def __init__(self, device, baud=115200, timeout=5.0):
        self.timeout, self.baud = timeout, baud
        self.port = os.open(device, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.port)
        attributes = termios.tcgetattr(self.port)
        attributes[4] = attributes[5] = getattr(termios, f"B{baud}")
        termios.tcsetattr(self.port, termios.TCSANOW, attributes)
        # Replies are kept for a while by what was asked: no id may be that of an earlier program.
        self.id = random.randrange(1 << 31)
        self.buffer = b""
        self.pieces = Pieces()
        self.topics = collections.defaultdict(lambda: collections.deque(maxlen=100))  # not yet asked for, by subscription
        self.round_trip = 0.05
        self.damaged = self.repeated = 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        os.close(self.port)

    def call(self, method, **params):
        """The result of a command; raises DaemonError when the daemon refuses it."""
        return self._ask(method, params, 0)

    def estop(self):
        """Stops the robot. At first it is sent again without waiting for a reply: some of many get through."""
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
                    if "error" in message:
                        raise DaemonError(message["error"])
                    return message["result"]
        raise TimeoutError(f"{method}: no reply within {self.timeout} s")

    def notify(self, method, **params):
        """Without an answer, and never repeated: what is soon sent anew."""
        self._send(to_cbor({"jsonrpc": "2.0", "method": method, "params": params}))

    def subscribe(self, topic, **options):
        """Yields the topic's messages {seq, stamp, dropped, data, ...} as they come, without end."""
        queue = self.topics[self.call("topics.subscribe", topic=topic, **options)["subscription"]]
        while True:
            while not queue:
                self._receive(time.monotonic() + 1)
            yield queue.popleft()

    def _send(self, content):
        frame = b"\0" + stuff(seal(content)) + b"\0"
        while frame:
            frame = frame[os.write(self.port, frame):]

    def _receive(self, until):
        """The replies that come until then, at least those of one reading."""
        wait = max(0.0, until - time.monotonic())
        if not select.select([self.port], [], [], wait)[0]:
            return []
        *frames, self.buffer = (self.buffer + os.read(self.port, 4096)).split(b"\0")
        messages = []
        for frame in filter(None, frames):
            content = unstuff(frame)
            content = unseal(content) if content else None
            report = None
            if content and content[0] in (PIECE, PIECE_TO_REPORT):
                content, report = self.pieces.take(content)
            elif not content:
                self.damaged += 1
            if report:
                self._send(report)
            if content and 0x80 <= content[0] <= 0xBF:
                message = from_cbor(content)[0]
                if message.get("method") == "topic":
                    self.topics[message["params"]["subscription"]].append(message["params"])
                else:
                    messages.append(message)
        return messages
