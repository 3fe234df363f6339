#!/usr/bin/env python3
"""Who commanded what is written down: one line for each command that changes something or stops, with the refused ones; set-points
are counted; files rotate, also under two daemons at once; a disk that does not take it is told."""
import json
import os
import sys
import tempfile
import time

from support import BINARIES, Daemon, Process, free_port, refusal, wait_for, text_of


def lines_of(folder, name):
    """All that is kept, the oldest first."""
    found = []
    for number in reversed(range(20)):
        path = os.path.join(folder, f"{name}.{number}.jsonl" if number else f"{name}.jsonl")
        if os.path.exists(path):
            assert os.stat(path).st_mode & 0o077 == 0, path
            found += [json.loads(line) for line in text_of(path).splitlines()]
    return found


def check_lines(folder, log_folder):
    with Process(BINARIES, "softwaretrigger", free_port(0), log_folder, {"audit.folder": folder}) as process:
        with process.connect() as daemon:
            begun = time.time()
            daemon.call("settings.set", values={"limits": {"clients": 20}})
            daemon.call("settings.get")  # changes nothing
            refusal(daemon, "trigger.fire", id="none")
            daemon.call("settings.reset", paths=["limits.clients"])
            health = {item["name"]: item for item in daemon.call("daemon.status")["health"]}
            daemon.call("daemon.shutdown")
        process.process.wait(10)
    lines = lines_of(folder, "softwaretrigger")
    assert [line["method"] for line in lines] == ["settings.set", "trigger.fire", "settings.reset", "daemon.shutdown"], lines
    assert lines[0]["params"] == {"values": {"limits": {"clients": 20}}} and lines[0]["role"] == "engineer", lines[0]
    assert "error" in lines[1] and "error" not in lines[0], lines
    assert all(begun - 1 < line["stamp"] < time.time() + 1 and "process" in line["client"] for line in lines), lines
    assert health["audit"]["level"] == "ok", health["audit"]


def check_repeated(folder, log_folder):
    """Set-points and refusals for the role: a line a second, and none is missing in the count."""
    line = f"serial://{folder}/none"
    with Process(BINARIES, "motorcontrol", free_port(0), log_folder,
                 {"audit.folder": folder, "controllers.1.url": line, "controllers.2.url": line, "access.plain": "observer"}) as process:
        with process.connect() as daemon:
            for _ in range(50):
                refusal(daemon, "motor.drive", vx=0.1)
            for _ in range(3):
                daemon.call("motor.estop")
        import hermes
        hermes.own_socket, own = lambda host, port: None, hermes.own_socket
        for _ in range(200):
            with Daemon(port=process.port) as stranger:
                refusal(stranger, "settings.reset", -32001, paths=[])
        hermes.own_socket = own
        wait_for("the counts", lambda: sum(line.get("calls", 1) for line in lines_of(folder, "motorcontrol")) >= 253, 10)
    lines = lines_of(folder, "motorcontrol")
    counts = {method: sum(line.get("calls", 1) for line in lines if line["method"] == method)
              for method in ("motor.drive", "motor.estop", "settings.reset")}
    assert counts == {"motor.drive": 50, "motor.estop": 3, "settings.reset": 200}, counts
    assert len(lines) < 60, len(lines)


def check_rotation(folder, log_folder):
    """Two of one name write to the same files."""
    settings = {"audit.folder": folder, "audit.file_bytes": 4096, "audit.files": 4}
    processes = [Process(BINARIES, "softwaretrigger", free_port(0), log_folder, settings) for _ in range(2)]
    try:
        daemons = [process.connect() for process in processes]
        for number in range(100):
            for daemon in daemons:
                daemon.call("settings.set", values={"limits": {"clients": 17 + number}})
        for daemon in daemons:
            wait_for("all lines", lambda d=daemon: audit_of(d)["values"]["written"] == 100, 10)
            assert audit_of(daemon)["values"]["lost"] == 0
    finally:
        for process in processes:
            process.stop()
    names = sorted(name for name in os.listdir(folder) if name.startswith("softwaretrigger"))
    assert names == ["softwaretrigger.1.jsonl", "softwaretrigger.2.jsonl", "softwaretrigger.3.jsonl", "softwaretrigger.jsonl"] or \
        len(names) == 3, names  # the newest may just have been moved
    assert all(os.path.getsize(os.path.join(folder, name)) < 4096 + 600 for name in names), names
    clients = [line["params"]["values"]["limits"]["clients"] for line in lines_of(folder, "softwaretrigger")]
    assert clients[-2:] == [116, 116] or 116 in clients[-4:], clients[-8:]


def check_flood(folder, log_folder):
    """Who commands without end does not push out what was told before; they are counted, and a warning tells it."""
    settings = {"audit.folder": folder, "audit.file_bytes": 65536, "audit.files": 4}
    process = Process(BINARIES, "softwaretrigger", free_port(0), log_folder, settings)
    total = 3000
    try:
        with process.connect() as daemon:
            daemon.call("settings.set", values={"limits": {"clients": 77}})
        for number in range(10):
            with process.connect() as daemon:  # under another name
                for _ in range(total // 10):
                    assert refusal(daemon, "trigger.fire", id="none" * 20) != 0
        with process.connect() as daemon:
            wait_for("a warning", lambda: "summed up" in audit_of(daemon)["message"], 10)
            assert audit_of(daemon)["level"] == "warn", audit_of(daemon)
    finally:
        process.stop()
    lines = lines_of(folder, "softwaretrigger")
    assert lines[0]["params"] == {"values": {"limits": {"clients": 77}}}, lines[0]
    fired = [line for line in lines if line["method"] == "trigger.fire"]
    assert sum(line.get("calls", 1) for line in fired) == total, len(fired)


def check_long(folder, log_folder):
    """What is too long is shortened, and what matters is told."""
    process = Process(BINARIES, "supervisor", free_port(0), log_folder, {"audit.folder": folder, "processes": "[]"})
    try:
        with process.connect() as daemon:
            daemon.call("process.add", name="x", program="/bin/true", arguments=["y" * 90] * 40)
            refusal(daemon, "process.add", name="z" * 9000, program="/bin/false", arguments=[])
    finally:
        process.stop()
    lines = [line for line in lines_of(folder, "supervisor") if line["method"] == "process.add"]
    assert lines[0]["params"]["program"] == "/bin/true" and lines[0]["params"]["name"] == "x", lines[0]
    assert lines[0]["params"]["arguments"][-1] == "... (40)" and lines[0]["params"]["arguments"][0] == "y" * 90, lines[0]
    assert lines[1]["params"]["program"] == "/bin/false" and lines[1]["params"]["name"].endswith("... (9000)"), lines[1]


def audit_of(daemon):
    return {item["name"]: item for item in daemon.call("daemon.status")["health"]}["audit"]


def check_trouble(folder, log_folder):
    """A file in the place of the folder, a pipe in that of the file: told, counted, and nobody is held up."""
    os.mkfifo(os.path.join(folder, "softwaretrigger.jsonl"))
    with open(os.path.join(folder, "file"), "wb"):
        pass
    for place, what in ((folder, "softwaretrigger.jsonl"), (os.path.join(folder, "file"), "cannot be made")):
        with Process(BINARIES, "softwaretrigger", free_port(0), log_folder, {"audit.folder": place}) as process:
            with process.connect() as daemon:
                daemon.call("settings.reset", paths=[])
                wait_for("a warning", lambda d=daemon: audit_of(d)["level"] == "warn", 10)
                assert what in audit_of(daemon)["message"] and audit_of(daemon)["values"]["lost"] == 1, audit_of(daemon)
            assert process.stop() == 0, process.last_words()


def main():
    for check in (check_lines, check_repeated, check_rotation, check_flood, check_long, check_trouble):
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as log_folder:
            check(folder, log_folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
