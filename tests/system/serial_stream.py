#!/usr/bin/env python3
"""A serial line at 921,600 baud with random pauses, recorded: not a byte is lost or altered, and the index tells when each came.
HERMES_SECONDS says for how long (10)."""
import os
import random
import statistics
import time

from serial_port import Device, Logger, make_folder
from seriallog import chunks  # of docs/examples, which serial_port makes known

BYTES_PER_S = 92160  # 10 bits a byte
SECONDS = float(os.environ.get("HERMES_SECONDS", "10"))


def send(device, seconds, source):
    """Bytes of all values at the pace of the line; gives what was sent and when (offset, mono) of each piece."""
    sent, times = bytearray(), []
    begin = line = time.monotonic()
    while time.monotonic() < begin + seconds:
        piece = source.randbytes(source.choice((1, 7, 64, 512, 4096)))
        line = max(line, time.monotonic())
        times.append((len(sent), time.monotonic()))
        device.write(piece)
        sent += piece
        line += len(piece) / BYTES_PER_S
        if source.random() < 0.01:
            line += source.uniform(0, 0.2)  # a pause
        time.sleep(max(0.0, line - time.monotonic()))
    return bytes(sent), times


def check_times(base, sent, times):
    """Of each byte sent the index knows an arrival after its sending; gives the delays in seconds."""
    delays, position, last = [], 0, 0.0
    arrivals = []
    for stamp, mono, data in chunks(base):
        assert data and mono >= last, f"byte {position}: came at {mono}, the one before at {last}"
        assert abs(stamp - mono - (time.time() - time.monotonic())) < 0.5
        arrivals.append((position, mono))
        position, last = position + len(data), mono
    assert position == len(sent)
    at = 0
    for offset, mono in times:
        while at + 1 < len(arrivals) and arrivals[at + 1][0] <= offset:
            at += 1
        delays.append(arrivals[at][1] - mono)
    assert min(delays) > 0, f"a byte came {-min(delays)} s before it was sent"
    return delays


def main():
    seed = int(os.environ.get("HERMES_SEED", time.time_ns() % 1000000))
    print(f"seed {seed}")
    with make_folder() as folder:
        device = Device(os.path.join(folder, "device"))
        with Logger(folder, device.link) as logger:
            logger.wait_open()
            logger.daemon.call("record.start", name="stream")
            sent, times = send(device, SECONDS, random.Random(seed))
            logger.wait_bytes(len(sent))
            with open(f"/proc/{logger.process.pid}/stat", encoding="ascii") as stat:
                ticks = sum(map(int, stat.read().rsplit(")", 1)[1].split()[11:13]))
            result = logger.daemon.call("record.stop")
            assert logger.stop() == 0, logger.last_words()
        assert result["counts"]["bytes"] == len(sent) and not any(result["losses"].values()), result
        base = os.path.join(result["folder"], "seriallogger-dev")
        with open(base + ".raw", "rb") as raw:
            assert raw.read() == sent, "the bytes recorded are not those sent"
        delays = check_times(base, sent, times)
        print(f"{len(sent)} bytes in {SECONDS:.0f} s, none lost, none altered; {result['counts']['chunks']:.0f} chunks; "
              f"stamped {statistics.median(delays) * 1e3:.2f} ms after they were sent (median, "
              f"{max(delays) * 1e3:.1f} ms at most); {ticks / os.sysconf('SC_CLK_TCK') / SECONDS * 100:.1f} % of a core")


if __name__ == "__main__":
    main()
