#!/usr/bin/env python3
"""A serial line that is pulled, a logger that is killed, a disk that is full: what was recorded is there and is right."""
import json
import os
import random
import subprocess
import time

from lateness import Lateness
from support import DaemonError, wait_for
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


def check_full_disk(folder):
    """A disk of 1 MiB: the recording ends with an error that names the file, what is written is right, the daemon lives."""
    disk = os.path.join(folder, "disk")
    os.mkdir(disk)
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", disk], capture_output=True, check=False)
    if mounted.returncode != 0:
        print("skipped the full disk: no right to mount")
        return
    device = Device(os.path.join(folder, "device"))
    try:
        with Logger(folder, device.link, **{"record.folder": disk}) as logger:
            logger.wait_open()
            recorded = logger.daemon.call("record.start", name="full")["folder"]
            sent, source = b"", random.Random(2)
            while logger.daemon.call("record.status")["recording"]:
                piece = source.randbytes(4096)
                device.write(piece)
                sent += piece
            try:
                logger.daemon.call("record.stop")
                raise AssertionError("record.stop told of no error")
            except DaemonError as error:
                assert error.code == -32008 and error.data["path"].startswith(recorded), (error, error.data)
                print(error)
            status = logger.daemon.call("record.status")
            raw = load(os.path.join(recorded, "seriallogger-dev.raw"))
            assert len(raw) > 300000 and sent.startswith(raw), len(raw)
            assert status["counts"]["bytes"] == len(raw) and status["losses"]["disk_bytes"] > 0, status
            assert b"".join(data for _, _, data in chunks(os.path.join(recorded, "seriallogger-dev"))) == raw
            assert sidecar(recorded)["ended"] == "failed" and sidecar(recorded)["bytes"] == len(raw)
            health = {item["name"]: item["level"] for item in logger.daemon.call("daemon.status")["health"]}
            assert health["recording"] == "error" and health["port dev"] in ("ok", "warn"), health
            os.unlink(os.path.join(recorded, "seriallogger-dev.raw"))  # room again
            logger.daemon.call("record.start", name="again")
            logger.daemon.call("record.stop")
            assert logger.stop() == 0, logger.last_words()
    finally:
        device.pull()
        subprocess.run(["umount", disk], check=True)
    print(f"full after {len(raw)} bytes, all of them right")


def main():
    for check in (check_replug, lambda folder: check_kill(folder, int(os.environ.get("HERMES_TRIALS", "5"))), check_full_disk):
        with make_folder() as folder:
            check(folder)


if __name__ == "__main__":
    main()
