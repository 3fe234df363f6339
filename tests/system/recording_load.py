"""A logger under load: sends numbered packets, records them, and counts end to end what is in the files."""
import glob
import json
import os
import socket
import struct
import subprocess
import sys
import tempfile
import time

from support import BINARIES, BUILD, Process, free_port, wait_for, text_of

NOMINAL_HZ, BURST_HZ = 1810, 20000
RECORD, DATA, POSITION = struct.Struct("<IIII"), 1206, 512


class Logger:
    """A running logger with ports of its own."""

    def __init__(self, folder, log_folder=None, **settings):
        self.lidar_port = free_port(0, socket.SOCK_DGRAM)
        self.position_port = free_port(0, socket.SOCK_DGRAM)
        self.process = Process(BINARIES, "velodynelogger", free_port(0), log_folder or folder,
                               {"source.port": self.lidar_port, "source.position_port": self.position_port,
                                "source.address": "127.0.0.1", "record.folder": folder, **settings})
        self.daemon = self.process.connect()
        self.pid = self.process.process.pid

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.daemon.close()
        if self.process.process.poll() is None:
            self.process.process.kill()
            self.process.process.wait()

    def send(self, rate_hz, seconds, first):
        """Starts a sender."""
        return subprocess.Popen([os.path.join(BUILD, "tests", "system", "packet_sender"), str(self.lidar_port), str(rate_hz),
                                 str(seconds), str(first), str(self.position_port)], stdout=subprocess.PIPE, text=True)

    def cpu_s(self):
        fields = text_of(f"/proc/{self.pid}/stat").rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def peak_mb(self):
        with open(f"/proc/{self.pid}/status", encoding="utf-8") as status:
            return next(int(line.split()[1]) * 1024e-6 for line in status if line.startswith("VmHWM"))


def sent(sender):
    """(data packets, position packets, seconds) when the sender has ended."""
    out, _ = sender.communicate()
    assert sender.returncode == 0, "the sender failed"
    data, position, seconds = out.split()
    return int(data), int(position), float(seconds)


def records(path):
    """(stamp in ns, UDP payload) of each record; a file that does not end with a whole record is an error."""
    with open(path, "rb") as file:
        header = file.read(24)
        assert header[:4] == bytes.fromhex("4d3cb2a1"), (path, header)
        while True:
            head = file.read(16)
            if not head:
                return
            seconds, fraction, length, original = RECORD.unpack(head)
            frame = file.read(length)
            assert len(frame) == length == original, f"{path}: the last record is not whole"
            yield seconds * 1000000000 + fraction, frame[42:]


def captures(folder):
    return sorted(glob.glob(os.path.join(folder, "velodynelogger-*.pcap")))


def number_of(payload):
    """The number that the sender wrote into the intensities of the first eight returns."""
    return int.from_bytes(payload[6:28:3], "little")


def check_files(folder, first, data, position):
    """Every packet is there once and in order; gives the sidecar."""
    expected, positions = first, 0
    for path in captures(folder):
        for _, payload in records(path):
            if len(payload) == DATA:
                assert number_of(payload) == expected, f"{path}: packet {number_of(payload)} stands where {expected} should"
                expected += 1
            else:
                assert len(payload) == POSITION, (path, len(payload))
                positions += 1
    assert (expected - first, positions) == (data, position), (expected - first, data, positions, position)
    return json.loads(text_of(os.path.join(folder, "velodynelogger.json")))


def run(seconds, bursts, burst_s, folder=None):
    """Nominal traffic, then bursts; fails when a packet is lost. Gives the figures."""
    with tempfile.TemporaryDirectory(dir=folder) as root, Logger(root, **{"record.file_bytes": 200000000}) as logger:
        recorded = logger.daemon.call("record.start", name="load")["folder"]
        cpu, begin = logger.cpu_s(), time.monotonic()
        data, position, _ = sent(logger.send(NOMINAL_HZ, seconds, 0))
        figures = {"seconds": time.monotonic() - begin}
        figures["core_percent"] = 100 * (logger.cpu_s() - cpu) / figures["seconds"]
        figures["nominal_mb"] = logger.peak_mb()
        rates = []
        for _ in range(bursts):
            more, also, took = sent(logger.send(BURST_HZ, burst_s, data))
            data, position = data + more, position + also
            rates.append(more / took)
        wait_for("the last packets", lambda: logger.daemon.call("record.status")["counts"]["packets"] >= data + position)
        told = logger.daemon.call("record.stop")
        assert not any(told["losses"].values()), told
        assert told["counts"]["data"] == data and told["counts"]["position"] == position, (told, data, position)
        sidecar = check_files(recorded, 0, data, position)
        assert sidecar["complete"] and sidecar["counts"] == told["counts"], sidecar
        lidar = logger.daemon.call("source.status")
        return {**figures, "packets": data + position, "lost": data + position - sidecar["counts"]["packets"],
                "burst_hz": min(rates, default=0), "bursts": bursts, "burst_s": burst_s, "peak_mb": logger.peak_mb(),
                "files": len(sidecar["files"]), "decoder_drops": lidar["decoder_drops"],
                "receive_buffer_bytes": lidar["receive_buffer_bytes"]}


if __name__ == "__main__":
    print(json.dumps(run(*map(float, sys.argv[1:2]), *map(int, sys.argv[2:4]))))
