#!/usr/bin/env python3
"""A serial line that is pulled, a logger that is killed: what was recorded is there and is right."""
import json
import os
import random
import time

from lateness import Lateness
from support import wait_for
from seriallog import chunks  # of docs/examples
from serial_port import Device, Logger, make_folder


def load(path, mode="rb"):
    with open(path, mode) as file:
        return file.read()


def sidecar(folder):
    return json.loads(load(os.path.join(folder, "seriallogger.json")))


def events(folder):
    return [json.loads(line) for line in load(os.path.join(folder, "seriallogger-events.jsonl")).splitlines()]


def check_replug(folder, times=20):
    """Pulled and plugged in again, each time as another device under the same link."""
    link = os.path.join(folder, "device")
    device, sent, source = Device(link), b"", random.Random(1)
    with Logger(folder, link) as logger:
        logger.wait_open()
        recorded = logger.daemon.call("record.start", name="replug")["folder"]
        for i in range(times):
            line = logger.wait_open(i + 1)
            assert line["device"] == os.path.realpath(link), line
            piece = source.randbytes(source.randrange(1, 5000))
            device.write(piece)
            sent += piece
            logger.wait_bytes(len(sent))
            device.pull()
            wait_for("closing of the line", lambda: logger.line()["state"] != "open")
            device = Device(link)
        logger.wait_open(times + 1)
        logger.daemon.call("record.stop")
        assert logger.stop() == 0, logger.last_words()
    device.pull()
    assert load(os.path.join(recorded, "seriallogger-dev.raw")) == sent
    kinds = [event["event"] for event in events(recorded)]
    assert kinds == ["closed", "opened"] * times, kinds
    print(f"pulled and plugged in {times} times, {len(sent)} bytes, none lost")


def check_kill(folder, times):
    """Killed while it records: what was sent more than 100 ms before is there, and the next start completes the sidecar."""
    with Lateness() as lateness:
        missing = [kill(folder, number, lateness) for number in range(times)]
    # What holds up a nap here holds up the logger too.
    assert all(lost_s < 0.1 + 2 * late_s for lost_s, late_s in missing), missing
    print(f"killed {times} times: at most the last {max(missing)[0] * 1e3:.0f} ms were missing; each sidecar was completed")


def kill(folder, number, lateness):
    """One kill: the seconds that are missing, and how late the machine was before it."""
    link = os.path.join(folder, "device")
    source = random.Random(number)
    device = Device(link)
    logger = Logger(folder, link)
    logger.wait_open()
    recorded = logger.daemon.call("record.start", name=f"kill{number}")["folder"]
    logger.daemon.call("mark", text="before the end")
    sent, arrived = b"", []
    lateness.take_longest()
    end = time.monotonic() + source.uniform(0.3, 0.8)
    while time.monotonic() < end:
        piece = source.randbytes(500)
        device.write(piece)
        sent += piece
        arrived.append((len(sent), time.monotonic()))
        time.sleep(0.005)
    logger.process.kill()
    killed = time.monotonic()
    late = lateness.take_longest()
    logger.process.wait()
    device.pull()
    raw = load(os.path.join(recorded, "seriallogger-dev.raw"))
    assert sent.startswith(raw), "bytes were altered"
    assert sidecar(recorded)["ended"] is None
    device = Device(link)
    with Logger(folder, link) as logger:
        wait_for("completion of the sidecar", lambda: sidecar(recorded)["ended"])
        assert logger.stop() == 0, logger.last_words()
    device.pull()
    content = sidecar(recorded)
    assert content["ended"] == "cut off" and not content["complete"], content
    assert content["bytes"] == content["counts"]["bytes"] == len(raw), content
    assert content["counts"]["marks"] == 1 and events(recorded)[0]["text"] == "before the end", content
    read = list(chunks(os.path.join(recorded, "seriallogger-dev")))
    assert b"".join(data for _, _, data in read) == raw and content["counts"]["chunks"] == len(read)
    assert read[-1][0] == content["end"], (read[-1], content["end"])
    lost_since = next((mono for size, mono in arrived if size > len(raw)), killed)
    return killed - lost_since, late


def main():
    for check in (check_replug, lambda folder: check_kill(folder, int(os.environ.get("HERMES_TRIALS", "5")))):
        with make_folder() as folder:
            check(folder)


if __name__ == "__main__":
    main()
