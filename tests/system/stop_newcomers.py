#!/usr/bin/env python3
"""Whatever others do, a client that comes can stop the robot: beside more silent clients than there are file descriptors, storms of
connections, strangers to TLS, datagrams without end, and requests that take the most memory. Each row says what others do; while
they do it NEWCOMERS come, one after another, and call motor.estop. The memory of the daemon stays below a bound all the time."""
import functools
import json
import multiprocessing
import os
import resource
import socket
import tempfile
import time

from support import BINARIES, Process, free_port, text_of, wait_for
from tls import Client, context_of, issued, keys as make_keys

NEWCOMERS, LATEST_S, MOST_MEMORY, ROOM = 8, 5, 200 << 20, 800 << 20
DEAREST = b'{"jsonrpc":"2.0","id":1,"method":"motor.drive","params":{"vx":[' + b",".join([b'{"a":1}'] * 128000) + b"]}}\n"


def silent(count, address):
    """Connections that say nothing, over TCP and over the Unix socket."""
    crowd = []
    for _ in range(count):
        for family, where in ((socket.AF_INET, address), (socket.AF_UNIX, f"\0hermes:127.0.0.1:{address[1]}")):
            one = socket.socket(family)
            one.settimeout(1)
            try:
                one.connect(where)
            except OSError:
                pass
            crowd.append(one)
    time.sleep(3600)


def storm(kept, pause_s, address):
    """One connection after another, the last `kept` of them open."""
    crowd = []
    while True:
        one = socket.socket()
        one.setblocking(False)
        one.connect_ex(address)
        crowd.append(one)
        if len(crowd) > kept:
            crowd.pop(0).close()
        time.sleep(pause_s)


def datagrams(data, address):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.connect(address)
        while True:
            try:
                sender.send(data)
            except OSError:
                pass


def repeat(data, address):
    while True:
        try:
            with socket.create_connection(address, 3) as connection:
                while True:
                    connection.sendall(data)
                    connection.recv(65536)
        except OSError:
            time.sleep(0.01)


def unread(address):
    """Asks for much and reads nothing."""
    while True:
        try:
            with socket.create_connection(address, 3) as connection:
                connection.settimeout(None)  # it waits until the daemon closes it
                while True:
                    connection.sendall(b'{"jsonrpc":"2.0","id":1,"method":"rpc.discover"}\n' * 20)
        except OSError:
            time.sleep(0.01)


def memory(process):
    with open(f"/proc/{process.process.pid}/status", encoding="utf-8") as status:
        return next(int(text.split()[1]) * 1024 for text in status if text.startswith("VmRSS"))


def check(folder, name, settings, descriptors, work, count, told=""):
    """How long the slowest newcomer took, and the most memory; told: what the daemon logs of the others."""
    keys, tls_port, udp_port = os.path.join(folder, "keys"), free_port(0), free_port(0)
    process = Process(BINARIES, "motorcontrol", free_port(0), folder, {
        "controllers": json.dumps({n: {"url": f"serial://{folder}/none"} for n in "12"}), **settings},
        ["--listen", f"tls://127.0.0.1:{tls_port}?keys={issued(keys, 'robot')}", "--listen", f"udp://127.0.0.1:{udp_port}"])
    others = []
    try:
        process.connect().close()
        resource.prlimit(process.process.pid, resource.RLIMIT_NOFILE, (descriptors, descriptors))
        resource.prlimit(process.process.pid, resource.RLIMIT_AS, (ROOM, ROOM))
        port = {"tcp": process.port, "tls": tls_port, "udp": udp_port}[name.split(",")[0]]
        others = [multiprocessing.Process(target=work, args=(("127.0.0.1", port),), daemon=True) for _ in range(count)]
        for other in others:
            other.start()
        slowest = most = 0
        for newcomer in range(NEWCOMERS):
            time.sleep(0.2)
            began = time.monotonic()
            if name.startswith("tls"):
                with Client(tls_port, context_of(issued(keys, "anna"))) as client:
                    client.call("motor.estop")
            else:
                with socket.create_connection(("127.0.0.1", process.port), LATEST_S) as connection:
                    connection.sendall(b'{"jsonrpc":"2.0","id":1,"method":"motor.estop"}\n')
                    answer = connection.makefile().readline()
                assert '"result"' in answer, f"{name}: newcomer {newcomer} could not stop: {answer}"
            slowest, most = max(slowest, time.monotonic() - began), max(most, memory(process))

        def is_told():
            nonlocal most
            most = max(most, memory(process))
            return told in text_of(process.log_name)
        wait_for(f"{name}: {told!r} in the log", is_told)
        assert most < MOST_MEMORY, f"{name}: {most >> 20} MB"
        print(f"{name}: the slowest of {NEWCOMERS} newcomers took {1000 * slowest:.0f} ms, {most >> 20} MB at most", flush=True)
    finally:
        for other in others:
            other.kill()
        status = process.stop()
    assert status == 0, process.last_words()


def check_log(folder):
    """A crowd that is turned away for want of descriptors is told once a second."""
    process = Process(BINARIES, "motorcontrol", free_port(0), folder, {})
    try:
        process.connect().close()
        most = len(os.listdir(f"/proc/{process.process.pid}/fd")) + 4
        resource.prlimit(process.process.pid, resource.RLIMIT_NOFILE, (most, most))
        began = time.monotonic()
        for _ in range(300):
            with socket.create_connection(("127.0.0.1", process.port), LATEST_S) as connection:
                assert connection.recv(1) == b"", "a client was not turned away"

        def told():
            return text_of(process.log_name).count("nearly no file descriptors are left")
        wait_for("a warning in the log", told, 10)
        assert told() <= time.monotonic() - began + 1, f"{told()} warnings"
    finally:
        process.stop()


def main():
    with tempfile.TemporaryDirectory() as folder:
        make_keys(os.path.join(folder, "keys"), "init")
        for name, role in (("robot", "daemon"), ("anna", "operator")):
            make_keys(os.path.join(folder, "keys"), "issue", name, "--role", role)
        many = {"limits.clients": 1000}
        for row in (("tcp, 40 descriptors, silent clients", {}, 40, functools.partial(silent, 40), 1),
                    ("tcp, 1,000 clients allowed, 1,000 silent", many, 1024, functools.partial(silent, 500), 1),
                    ("tcp, a storm that hangs up", {}, 1024, functools.partial(storm, 0, 0.0001), 2),
                    ("tcp, a storm that stays", {}, 1024, functools.partial(storm, 300, 0.0001), 2),
                    ("tls, strangers that say nothing", {}, 1024, functools.partial(storm, 300, 0.002), 1),
                    ("udp, empty lines", {}, 1024, functools.partial(datagrams, b"\n" * 200), 1),
                    ("udp, requests", {}, 1024, functools.partial(datagrams, b'{"jsonrpc":"2.0","method":"daemon.status"}\n' * 10), 1),
                    ("tcp, replies that nobody reads", {"limits.reply_bytes": 15 << 20}, 1024, unread, 16, "all clients together"),
                    ("tcp, requests of 128,000 values", {}, 1024, functools.partial(repeat, DEAREST), 20)):
            check(folder, *row)
        check_log(folder)


if __name__ == "__main__":
    main()
