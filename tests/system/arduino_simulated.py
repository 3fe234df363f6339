#!/usr/bin/env python3
"""The simulated Arduino as a program sees it that knows nothing but its text protocol: a client of a few lines on the pseudo-terminal
drives the robot of a running simulator; its own time-out, faults, a pulled line and another speed do what they should."""
import math
import os
import select
import tempfile
import termios
import time

from support import SerialPort, fastest_wheel, refusal, simulated_hall, wait_for

ARDUINO = {"motors.kind": "arduino", "frame.layout": "differential", "frame.counts_per_turn": 3600, "motors.full_speed": 12000}
COUNTS_A_METRE = 3600 / (2 * math.pi * 0.1)


class Arduino(SerialPort):
    def __init__(self, path, speed=termios.B57600):
        super().__init__(path)
        settings = termios.tcgetattr(self.port)
        settings[4] = settings[5] = speed
        termios.tcsetattr(self.port, termios.TCSANOW, settings)

    def ask(self, command, limit_s=5):
        termios.tcflush(self.port, termios.TCIFLUSH)  # what came too late for an earlier one
        os.write(self.port, command.encode() + b"\r")
        answer = b""
        deadline = time.monotonic() + limit_s
        while not answer.endswith(b"\r\n") and select.select([self.port], [], [], max(0.0, deadline - time.monotonic()))[0]:
            answer += os.read(self.port, 100)
        return answer.decode("latin-1").removesuffix("\r\n") if answer else None

    def counts(self):
        return [int(part) for part in self.ask("e").split(" ")]


def check_drive(simulator, client):
    assert client.ask("b") == "57600" and client.ask("r") == "OK" and client.counts() == [0, 0]
    before = simulator.call("sim.state")["pose"]
    end = time.monotonic() + 2
    while time.monotonic() < end:
        assert client.ask("m 57 57") == "OK"
        time.sleep(0.02)
    state = simulator.call("sim.state")
    expected = 57 / 0.033 / COUNTS_A_METRE
    assert abs(math.hypot(state["twist"]["vx"], state["twist"]["vy"]) - expected) < 0.02, state
    wait_for("its time-out", lambda: fastest_wheel(simulator) == 0)
    state = simulator.call("sim.state")
    way = math.hypot(state["pose"]["x"] - before["x"], state["pose"]["y"] - before["y"])
    left, right = client.counts()
    assert abs(left / COUNTS_A_METRE - way) < 0.005 and abs(right - left) < 5 and way > 2.5 * expected, (way, left, right)
    controller, = state["motors"]["controllers"]
    assert controller["timeouts"] == 1 and controller["serial_timeout_s"] == 2 and "status" not in controller, controller


def check_faults(simulator, client, link):
    def fault(device, kind, **params):
        simulator.call("sim.fault", device=device, kind=kind, **params)

    fault("controller1", "silence")
    assert client.ask("e", 0.1) is None
    fault("controller1", "none")
    fault("controller1", "slow", delay_s=0.2)
    began = time.monotonic()
    assert client.ask("b") == "57600" and time.monotonic() - began > 0.19
    fault("controller1", "none")
    fault("controller1", "corrupt", share=0.1)
    wait_for("a damaged command", lambda: client.ask("b", 0.1) not in (None, "57600"))
    for kind in ("loss", "deaf", "mute", "stuck_timeout", "none"):
        fault("controller1", kind)
    client.ask("", 0.1)
    assert client.counts() != [0, 0]
    fault("controller1", "restart")
    began = time.monotonic()
    assert client.ask("e", 0.5) is None
    wait_for("its restart", lambda: client.ask("e", 0.1) == "0 0")
    assert 1.5 < time.monotonic() - began < 10
    fault("rear_right", "jump", counts=-123456)
    assert client.counts() == [0, -123456]
    refusal(simulator, "sim.fault", "controller1 has no fault brownout; it has: none, silence", device="controller1", kind="brownout")
    for device in ("controller2", "controllers", "line2"):
        refusal(simulator, "sim.fault", "a robot with an Arduino has no " + device, device=device, kind="none")
    refusal(simulator, "settings.set", "differential", values={"frame": {"layout": "mecanum"}})
    fault("line1", "pulled")
    wait_for("vanishing of the link", lambda: not os.path.lexists(link))
    fault("line1", "none")
    fast = Arduino(link, termios.B115200)
    heard = [fast.ask("e", 0.02) for _ in range(50)]
    assert not any(answer and answer.replace("-", "").replace(" ", "").isdigit() for answer in heard), heard
    fast.close()
    again = Arduino(link)
    wait_for("the counts at the right speed", lambda: again.ask("e", 0.2) in ("0 -123456", "0 0"))  # garbage may have restarted it
    again.close()


def main():
    with tempfile.TemporaryDirectory() as folder:
        process, link = simulated_hall(folder, pose=(0, 0, 0.5), **ARDUINO)
        with process:
            simulator = process.connect()
            client = Arduino(link)
            check_drive(simulator, client)
            check_faults(simulator, client, link)
            assert process.stop() == 0, process.last_words()
    print("driven, stopped, failed and recovered")


if __name__ == "__main__":
    main()
