#!/usr/bin/env python3
"""The simulated GPS receiver and the lidar's position packets as programs see them that know nothing but NMEA 0183 and the
sensor's manual: fixes lie where the robot is, faults do what they should, a pulled line comes back."""
import calendar
import math
import os
import select
import socket
import struct
import tempfile
import time

from support import SerialPort, simulated_hall

ORIGIN = 48.2, 11.5


class Receiver(SerialPort):
    """Reads lines as from a serial port."""

    def __init__(self, path):
        super().__init__(path)
        self.text = b""
        self.line()  # it may have begun before

    def receive(self, end):
        """False when nothing came until then."""
        came = select.select([self.port], [], [], max(0.0, end - time.monotonic()))[0]
        self.text += os.read(self.port, 4096) if came else b""
        return bool(came)

    def line(self, limit_s=10):
        """The next one."""
        end = time.monotonic() + limit_s
        while b"\r\n" not in self.text:
            assert self.receive(end), f"no line came in {limit_s} s"
        line, self.text = self.text.split(b"\r\n", 1)
        return line.decode("ascii", errors="replace")

    def lines(self, seconds):
        """What comes within this time."""
        end = time.monotonic() + seconds
        while self.receive(end):
            pass
        *lines, self.text = self.text.split(b"\r\n")
        return [line.decode("ascii", errors="replace") for line in lines]


def fields(line):
    """The fields of a sentence; none when its checksum is wrong."""
    body, _, checksum = line.partition("*")
    value = 0
    for byte in body[1:].encode():
        value ^= byte
    return body[1:].split(",") if line[:1] == "$" and checksum == f"{value:02X}" else None


def angle(text, letter):
    degrees = int(text[:text.index(".") - 2]) + float(text[text.index(".") - 2:]) / 60
    return -degrees if letter in "SW" else degrees


def metres(gga):
    """East and north of the origin; good to millimetres near it."""
    phi = math.radians(ORIGIN[0])
    w = math.sqrt(1 - 0.00669437999014 * math.sin(phi) ** 2)
    meridian, parallel = 6378137 * (1 - 0.00669437999014) / w ** 3, 6378137 / w * math.cos(phi)
    return (math.radians(angle(gga[4], gga[5]) - ORIGIN[1]) * parallel,
            math.radians(angle(gga[2], gga[3]) - ORIGIN[0]) * meridian)


def utc(rmc):
    return calendar.timegm(time.strptime(rmc[9] + rmc[1][:6], "%d%m%y%H%M%S")) + float(rmc[1][6:])


def check_fixes(simulator, receiver):
    simulator.call("sim.place", x=3, y=-2, theta=0.5)
    placed, begin = simulator.call("sim.state")["stamp"], time.monotonic()
    while (sentence := fields(receiver.line()))[0] != "GPRMC" or utc(sentence) < placed:
        pass  # fixes from before
    told = [sentence] + [fields(receiver.line()) for _ in range(39)]
    assert 1 < time.monotonic() - begin < 10, "2 s of fixes take another time"
    assert all(told) and [sentence[0] for sentence in told] == ["GPRMC", "GPGGA"] * 20, told
    times = [utc(sentence) for sentence in told[::2]]
    assert all(abs(after - before - 0.1) < 1e-6 for before, after in zip(times, times[1:])), times
    assert abs(times[-1] - time.time()) < 10, (times[-1], time.time())
    for sentence in told[1::2]:
        east, north = metres(sentence)
        assert abs(east - 3) < 0.005 and abs(north + 2) < 0.005, (east, north)


def check_faults(simulator, receiver, link):
    def check(kind, is_right, **params):
        """With this fault the lines of a second are right, as soon as what was on its way has come."""
        simulator.call("sim.fault", device="gps", kind=kind, **params)
        end = time.monotonic() + 10
        while not is_right(lines := receiver.lines(1)):
            assert time.monotonic() < end, (kind, lines)

    check("silence", lambda lines: not lines)
    check("no_fix", lambda lines: lines and all(s and (s[2] == "V" if s[0] == "GPRMC" else s[6] == "0")
                                                for s in map(fields, lines)))
    check("corrupt", lambda lines: lines and not any(map(fields, lines)), share=1)
    check("none", lambda lines: lines and all(s and s[0][:2] == "GP" for s in map(fields, lines)))
    simulator.call("sim.fault", device="gps", kind="pulled")
    assert not os.path.lexists(link)
    simulator.call("sim.fault", device="gps", kind="none")
    again = Receiver(link)
    assert fields(again.line())
    again.close()


def check_position_packets(positions):
    for _ in range(300):  # past what came while the receiver had no fix
        packet = positions.recv(2000)
        assert len(packet) == 512, len(packet)
    stamp_us, pps = struct.unpack_from("<IB", packet, 0xC6)
    text = packet[0xCE:].rstrip(b"\0").decode("ascii")
    assert pps == 2, f"the PPS is not locked: {pps}"
    assert text.endswith("\r\n") and len(text) <= 74, text
    rmc = fields(text.strip())
    assert rmc[0] == "GPRMC" and rmc[2] == "A", rmc
    late = stamp_us / 1e6 - (int(rmc[1][2:4]) * 60 + float(rmc[1][4:]))
    assert 0.05 < late % 3600 < 1.1, late


def main():
    with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as positions:
        positions.bind(("127.0.0.1", 0))
        positions.settimeout(5)
        link = os.path.join(folder, "devices", "gps")
        process, _ = simulated_hall(folder, **{
            "gps.link": link, "gps.rate_hz": 10, "gps.sigma_m": 0, "gps.latitude_deg": ORIGIN[0],
            "gps.longitude_deg": ORIGIN[1], "gps.altitude_m": 0, "lidar.position_port": positions.getsockname()[1]})
        with process:
            simulator = process.connect()
            receiver = Receiver(link)
            check_fixes(simulator, receiver)
            check_position_packets(positions)
            check_faults(simulator, receiver, link)
            receiver.close()
            assert process.stop() == 0, process.last_words()
        assert not os.path.lexists(link), "the link was left behind"
    print("fixes, faults and position packets are as they should be")


if __name__ == "__main__":
    main()
