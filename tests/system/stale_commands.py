#!/usr/bin/env python3
"""A client fills its connection with commands that have no stamp, and is killed or freezes. Nothing of what still lies in the
connection moves the robot: not on its own, and not after a stop and its release by somebody else."""
import os
import socket
import subprocess
import sys
import tempfile
import time

from lateness import Lateness
from support import BINARIES, WORLD, Process, fastest_wheel, free_port, release, wait_for
from tls import issued, keys

CARRIERS, ENDS, STOPS = ("tcp", "unix", "tls"), ("kill", "freeze"), (None, "motor.stop", "motor.estop")
LIMIT_S = 0.45  # safety.command_timeout_s and the time of braking from 0.3 m/s, and 0.125 s

CLIENT = r"""
import os, select, socket, ssl, sys, time
port, carrier, end, key = int(sys.argv[1]), sys.argv[2], sys.argv[3], sys.argv[4]
if carrier == "unix":
    link = socket.socket(socket.AF_UNIX)
    link.connect(f"\0hermes:127.0.0.1:{port}")
else:
    link = socket.create_connection(("127.0.0.1", port))
if carrier == "tls":
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    context.load_cert_chain(os.path.join(key, "own.crt"), os.path.join(key, "own.key"))
    link = context.wrap_socket(link)
drive = b'{"jsonrpc":"2.0","method":"motor.drive","params":{"vx":0.3}}\n'
acquire = b'{"jsonrpc":"2.0","method":"control.acquire","params":{"timeout_s":60}}\n'
while not select.select([sys.stdin], [], [], 0.05)[0]:  # until it is told that the robot drives
    link.sendall(acquire + drive)
link.settimeout(1)
try:
    until = time.monotonic() + 0.2
    while time.monotonic() < until:
        link.sendall((acquire + drive) * 500)
except OSError:
    pass
print("full", flush=True)
if end == "kill":
    os.kill(os.getpid(), 9)
time.sleep(60)
"""


def turned_for(simulator, since):
    """Seconds after since at which a wheel turned last; seen when all have stood for a second."""
    last = since
    while time.monotonic() < last + 1:
        if fastest_wheel(simulator) > 0.05:
            last = time.monotonic()
        assert last < since + 20, "the wheels turn without end"
        time.sleep(0.003)
    return last - since


def trial(simulator, motors, client_line, stop):
    """How long the wheels turned after the end of the client, or after the release of the stop."""
    simulator.call("sim.place", x=0, y=0, theta=0)
    release(motors)
    wait_for("readiness", lambda: motors.call("motor.state")["ready"], 10)
    client = subprocess.Popen([sys.executable, "-c", CLIENT, *client_line], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    try:
        wait_for("the drive", lambda: fastest_wheel(simulator) > 2, 20)
        client.stdin.write("\n")
        client.stdin.flush()
        client.stdout.readline()
        since = time.monotonic()
        if stop:
            motors.call(stop)
            wait_for("standing", lambda: fastest_wheel(simulator) < 0.05, 5)
            release(motors)
            since = time.monotonic()
        return turned_for(simulator, since)
    finally:
        client.kill()
        client.wait()


def main():
    with tempfile.TemporaryDirectory() as folder:
        line, store, port, tls_port = os.path.join(folder, "line"), os.path.join(folder, "keys"), free_port(0), free_port(0)
        keys(store, "init")
        for name, role in (("robot", "daemon"), ("eva", "engineer")):
            keys(store, "issue", name, "--role", role)
        with Process(BINARIES, "simulator", free_port(0), folder, {
                "world": WORLD, "motors.link": line, "lidar.port": free_port(0, socket.SOCK_DGRAM)}) as simulated, \
                Process(BINARIES, "motorcontrol", port, folder, {f"controllers.{i}.url": f"serial://{line}?baud=115200" for i in (1, 2)},
                        ["--listen", f"tls://127.0.0.1:{tls_port}?keys={issued(store, 'robot')}"]) as driven, Lateness() as lateness:
            simulator, motors = simulated.connect(), driven.connect()
            for number in range(9):  # any two of carrier, end and stop meet
                carrier, end, stop = CARRIERS[number // 3], ENDS[number % 2], STOPS[number % 3]
                client_line = [str(tls_port if carrier == "tls" else port), carrier, end, issued(store, "eva")]
                for _ in range(3):
                    lateness.take_longest()
                    turned = trial(simulator, motors, client_line, stop)
                    late = lateness.take_longest()
                    if turned < LIMIT_S or late < 0.02:
                        break
                name = f"{end} over {carrier}" + (f", {stop} and its release" if stop else "")
                assert turned < LIMIT_S, f"{name}: the wheels turned {turned:.3f} s on ({late:.3f} s late)"
                print(f"{turned:.3f} s  {name}", flush=True)


if __name__ == "__main__":
    main()
