"""Reads the laser scanners LD06 and LD19 of LDROBOT at a serial line, in plain Python 3 (LD06 development manual v1.0, chapter 3).

    for stamp, points in read_scans("/dev/ttyUSB0"):
        print(stamp, len(points))
"""
import math
import os
import select
import struct
import termios
import time

from hermes_serial import open_port

BAUD, PACKET_BYTES, POINTS = 230400, 47, 12
SILENT_S = 2  # without a byte the line is opened anew
MOST_POINTS = 4500 // 2  # of a turn: two turns a second at least
HEAD = bytes([0x54, 0x2C])
# A packet is complete so long after its first beam: its beams at 4,500 a second, then 10 bits a byte on the line.
DELAY_S = POINTS / 4500 + PACKET_BYTES * 10 / BAUD


def crc8(data):
    """The checksum of a packet: polynomial 0x4D, the highest bit first, from 0."""
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1 ^ (0x4D if crc & 0x80 else 0)) & 0xFF
    return crc


CRC_TABLE = [crc8([byte]) for byte in range(256)]


def is_packet(data):
    crc = 0
    for byte in data[:-1]:
        crc = CRC_TABLE[crc ^ byte]
    return data[:2] == HEAD and crc == data[-1]


class HostClock:
    """When the sensor's milliseconds, which begin again at 30,000, were by the clock of this computer. On a busy computer packets are
    read late, and several at once, but never early: those that were read soonest show how far apart both clocks are."""

    def __init__(self):
        self.sensor, self.before, self.passed, self.read, self.offset = 0.0, 0, 0.0, 0.0, math.inf

    def __call__(self, milliseconds):
        self.passed = (milliseconds - self.before) % 30000 / 1000  # since the packet before
        self.sensor, self.before = self.sensor + self.passed, milliseconds
        steady, known = time.monotonic(), self.offset + 1e-4 * self.passed  # clocks drift by 100 ppm at most
        if steady - self.read > 10:  # in a longer silence the sensor may have counted to 30,000
            known = math.inf
        self.read, self.offset = steady, min(steady - self.sensor, known)
        return self.sensor + self.offset + time.time() - steady


def read_packets(device):
    """Yields each packet that is not damaged."""
    port, data = open_port(device, BAUD), b""
    try:
        try:
            termios.tcflush(port, termios.TCIFLUSH)  # what came before, whenever that was
        except termios.error as error:
            raise OSError(f"{device}: {error.args[-1]}") from error
        while True:
            if not select.select([port], [], [], SILENT_S)[0]:
                raise OSError(f"{device}: it is silent")
            more = os.read(port, 4096)
            if not more:
                raise OSError(f"{device}: the line has gone")
            data += more
            while len(data) >= PACKET_BYTES:
                whole = is_packet(data[:PACKET_BYTES])
                if whole:
                    yield data[:PACKET_BYTES]
                data = data[PACKET_BYTES if whole else 1:]
    finally:
        os.close(port)


def read_scans(device):
    """Yields each whole turn: the time of its first beam (seconds since the epoch, clock of this computer), and of each beam in
    the order of measuring (angle, range, seconds after the first). Angles in rad counter-clockwise, 0 ahead of the sensor;
    ranges in metres, 0: nothing came back. OSError: the device cannot be opened, or has gone."""
    begin, points, before, is_whole, host_time = 0.0, [], -1.0, False, HostClock()
    for packet in read_packets(device):
        degrees_per_s, first = struct.unpack_from("<HH", packet, 2)
        last, milliseconds = struct.unpack_from("<HH", packet, 42)
        first, last, came = first / 100, last / 100, host_time(milliseconds)
        if host_time.passed > 0.02 or len(points) > MOST_POINTS:  # packets are missing (they come every 2.7 ms); the head is held
            points, is_whole = [], False
        elif first < before:  # past 0 degrees
            if is_whole:
                yield begin, points
            points, is_whole = [], True
        if not points:
            begin, start = came - DELAY_S, first
        before = first
        for i in range(POINTS):
            millimetres, _ = struct.unpack_from("<HB", packet, 6 + 3 * i)
            degrees = first + (last - first) % 360 * i / (POINTS - 1)  # clockwise
            points.append((-math.radians(degrees), millimetres / 1000, (degrees - start) / max(degrees_per_s, 1)))
