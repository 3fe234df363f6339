#!/usr/bin/env python3
"""The simulated motor controllers as a program sees them that knows nothing but packet serial: a client of a few lines on the
pseudo-terminal drives the robot of a running simulator; faults, a pulled line and the controllers' own time-out do what they
should."""
import binascii
import math
import os
import select
import struct
import tempfile
import time

from support import SerialPort, refusal, simulated_hall, wait_for


class RoboClaw(SerialPort):
    """A client of its own: packet serial as the manual of the controllers describes it."""

    def exchange(self, packet, size, limit_s=5):
        os.write(self.port, packet)
        answer = b""
        deadline = time.monotonic() + limit_s
        while len(answer) < size and select.select([self.port], [], [], max(0.0, deadline - time.monotonic()))[0]:
            answer += os.read(self.port, size - len(answer))
        return answer

    def write(self, address, command, fmt="", *values):
        packet = bytes([address, command]) + struct.pack(">" + fmt, *values)
        return self.exchange(packet + struct.pack(">H", binascii.crc_hqx(packet, 0)), 1) == b"\xff"

    def read(self, address, command, fmt, limit_s=5):
        asked = bytes([address, command])
        answer = self.exchange(asked, struct.calcsize(">" + fmt) + 2, limit_s)
        if len(answer) < struct.calcsize(">" + fmt) + 2:
            return None
        assert binascii.crc_hqx(asked + answer, 0) == 0, f"wrong CRC: {answer.hex()}"
        return struct.unpack(">" + fmt, answer[:-2])

    def drive(self, speed, acceleration=120000):
        for address in (0x80, 0x81):
            assert self.write(address, 40, "Iii", acceleration, speed, speed)


def speed_of(simulator):
    twist = simulator.call("sim.state")["twist"]
    return math.hypot(twist["vx"], twist["vy"])


def check_drive(simulator, client):
    for address in (0x80, 0x81):
        assert client.write(address, 14, "B", 10)  # they stop after 1 s of silence
        for command in (28, 29):
            assert client.write(address, command, "IIII", 0x4000, 0x10000, 0x8000, 150000)
    before = simulator.call("sim.state")["pose"]
    client.drive(30240)  # 0.5 m/s
    end = time.monotonic() + 2
    while time.monotonic() < end:
        assert client.read(0x80, 78, "II") and client.read(0x81, 24, "H")
        time.sleep(0.02)
    assert abs(speed_of(simulator) - 0.5) < 0.02, speed_of(simulator)
    wait_for("stopping of the silent controllers", lambda: speed_of(simulator) == 0)
    state = simulator.call("sim.state")
    assert all(controller["timeouts"] == 1 for controller in state["motors"]["controllers"]), state
    way = math.hypot(state["pose"]["x"] - before["x"], state["pose"]["y"] - before["y"])
    counted = client.read(0x80, 78, "ii")[0] / 38000 * 2 * math.pi * 0.1
    assert abs(way - counted) < 0.002 and way > 0.7, (way, counted)
    assert state["placed"]


def check_faults(simulator, client, link):
    def fault(device, kind, **params):
        simulator.call("sim.fault", device=device, kind=kind, **params)

    fault("controller1", "silence")
    assert client.read(0x80, 24, "H", 0.1) is None and client.read(0x81, 24, "H")
    fault("controller1", "none")
    fault("controller2", "emergency_stop")
    assert client.read(0x81, 90, "I")[0] & 1 and not client.read(0x80, 90, "I")[0]
    fault("controller2", "none")
    fault("controller1", "slow", delay_s=0.2)
    began = time.monotonic()
    assert client.read(0x80, 24, "H") and time.monotonic() - began > 0.19
    fault("controller1", "none")
    fault("battery", "charge", share=0)
    wait_for("an empty battery", lambda: client.read(0x80, 24, "H")[0] <= 200)
    fault("battery", "none")
    for kind in ("blocked", "encoder", "backward", "none"):
        fault("rear_left", kind)
    for kind in ("deaf", "mute"):
        fault("controller1", kind)
        assert client.read(0x80, 24, "H", 0.1) is None and client.read(0x81, 24, "H")
        fault("controller1", "none")
    fault("controller1", "echo")
    assert client.exchange(b"\x80\x18", 6)[:2] == b"\x80\x18"
    fault("controller1", "none")
    for kind in ("latched", "stuck_timeout", "none"):
        fault("controller1", kind)
    before = client.read(0x80, 78, "II")[0]
    fault("front_left", "jump", counts=-123456)
    assert client.read(0x80, 78, "II")[0] == (before - 123456) % 2**32
    fault("controllers", "swapped")
    assert client.read(0x81, 78, "II")[0] == (before - 123456) % 2**32
    fault("controllers", "none")
    fault("line1", "adapter", delay_s=0.1)
    began = time.monotonic()
    assert client.read(0x80, 24, "H") and time.monotonic() - began > 0.09
    fault("line1", "none")
    fault("controller2", "brownout", delay_s=0.2)
    assert client.read(0x81, 24, "H", 0.05) is None
    wait_for("the restarted controller", lambda: client.read(0x81, 15, "B", 0.1) == (0,))
    refusal(simulator, "sim.fault", "controllers has no fault deaf", device="controllers", kind="deaf")
    refusal(simulator, "sim.fault", "lidar has no fault blocked; it has: none, silence, loss", device="lidar", kind="blocked")
    refusal(simulator, "sim.fault", "share line1", device="line2", kind="pulled")

    fault("line1", "pulled")
    wait_for("vanishing of the link", lambda: not os.path.lexists(link))
    fault("line1", "none")
    again = RoboClaw(link)
    assert again.read(0x80, 55, "IIII") == (0x10000, 0x8000, 0x4000, 150000), "the controllers were not switched off"
    again.close()


def main():
    with tempfile.TemporaryDirectory() as folder:
        process, link = simulated_hall(folder, pose=(0, 0, 0.5), **{"motors.link": os.path.join(folder, "devices", "motors")})
        with process:
            simulator = process.connect()
            lines = simulator.call("sim.state")["motors"]["lines"]
            assert lines == [{"link": link, "device": os.path.realpath(link)}], lines
            client = RoboClaw(link)
            check_drive(simulator, client)
            check_faults(simulator, client, link)
            assert process.stop() == 0, process.last_words()
        assert not os.path.lexists(link), "the link was left behind"
    print("driven, stopped, failed and recovered")


if __name__ == "__main__":
    main()
