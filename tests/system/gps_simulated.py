#!/usr/bin/env python3
"""The simulated GPS receiver and the lidar's position packets as programs see them that know nothing but NMEA 0183 and the
sensor's manual: fixes lie where the robot is, faults do what they should, a pulled line comes back."""
import calendar
import json
import math
import os
import select
import socket
import struct
import tempfile
import time

from support import BINARIES, Process, SerialPort, free_port

ORIGIN = 48.2, 11.5


class Receiver(SerialPort):
    """Reads lines as from a serial port."""

    def lines(self, seconds):
        """What comes within this time, without the part before the first line end."""
        end, text = time.monotonic() + seconds, b""
        while select.select([self.port], [], [], max(0.0, end - time.monotonic()))[0]:
            text += os.read(self.port, 4096)
        return [line.decode("ascii") for line in text.split(b"\r\n")[1:-1]]


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


def read_all(receiver, seconds):
    return [fields(line) for line in receiver.lines(seconds)]


def check_fixes(simulator, receiver):
    simulator.call("sim.place", x=3, y=-2, theta=0.5)
    receiver.lines(0.5)  # fixes from before
    told = read_all(receiver, 2)
    assert all(told) and 36 <= len(told) <= 42, told  # 10 Hz, RMC and GGA
    for sentence in told:
        if sentence[0] == "GPGGA":
            east, north = metres(sentence)
            assert abs(east - 3) < 0.005 and abs(north + 2) < 0.005, (east, north)
        else:
            stamp = time.strptime(sentence[9] + sentence[1][:6], "%d%m%y%H%M%S")
            assert abs(calendar.timegm(stamp) - time.time()) < 10, sentence


def check_faults(simulator, receiver, link):
    def fault(kind, **params):
        simulator.call("sim.fault", device="gps", kind=kind, **params)
        receiver.lines(0.3)  # what was on its way

    fault("silence")
    assert receiver.lines(0.6) == []
    fault("no_fix")
    told = read_all(receiver, 1)
    assert told and all(s[2] == "V" if s[0] == "GPRMC" else s[6] == "0" for s in told), told
    fault("corrupt", share=1)
    told = receiver.lines(1)
    assert told and not any(fields(line) for line in told), told
    fault("none")
    told = read_all(receiver, 1)
    assert told and all(told) and told[0][0][:2] == "GP", told
    simulator.call("sim.fault", device="gps", kind="pulled")
    assert not os.path.lexists(link)
    simulator.call("sim.fault", device="gps", kind="none")
    again = Receiver(link)
    assert all(read_all(again, 1)), "nothing comes from the line that was put back"
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
        link, world = os.path.join(folder, "devices", "gps"), os.path.join(folder, "hall.json")
        with open(world, "w", encoding="utf-8") as file:
            json.dump({"name": "hall", "edges": [[-9, -9, 9, -9]], "poses": [[0, 0, 0]]}, file)
        process = Process(BINARIES, "simulator", free_port(0), folder, {
            "gps.link": link, "gps.rate_hz": 10, "gps.sigma_m": 0, "gps.latitude_deg": ORIGIN[0],
            "gps.longitude_deg": ORIGIN[1], "gps.altitude_m": 0, "world": world,
            "lidar.port": free_port(0, socket.SOCK_DGRAM), "lidar.position_port": positions.getsockname()[1]})
        try:
            simulator = process.connect()
            receiver = Receiver(link)
            check_fixes(simulator, receiver)
            check_position_packets(positions)
            check_faults(simulator, receiver, link)
            receiver.close()
        finally:
            status = process.stop()
        assert status == 0, f"status {status}: {process.last_words()}"
        assert not os.path.lexists(link), "the link was left behind"
    print("fixes, faults and position packets are as they should be")


if __name__ == "__main__":
    main()
