#!/usr/bin/env python3
"""The logger replays both sensors: clouds are thinned and numbered as the scans, a subscriber that does not read them costs
nobody else a message, turns are written as CSV, PCD and PLY, and a replay seeks, pauses and ends as asked."""
import math
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading

from support import BINARIES, Daemon, Listener, Process, free_port, refusal, wait_for
import velodyne_reference as reference
from lidar_decoders import write_capture

PACKETS = 1200


def dropped_messages(logger):
    """By all clients together."""
    items = logger.call("daemon.status")["health"]
    return next(item for item in items if item["name"] == "channel")["values"]["dropped_topic_messages"]


def check_slow_reader(logger, port, capture):
    """One reads clouds, one scans, and one subscribes to clouds and reads nothing meanwhile: only that one loses messages."""
    before = dropped_messages(logger)
    slow = Daemon(port=port, timeout=60)
    unread = slow.subscribe("cloud", queue=1000)
    first = threading.Thread(target=lambda: next(unread))  # makes the subscription
    first.start()
    clouds, scans = Listener(port, "cloud"), Listener(port, "scan2d")
    logger.call("source.open", pcap=capture, speed=1, loop=True)
    first.join()
    wait_for("a loss of the one who does not read", lambda: dropped_messages(logger) > before)
    clouds.wait(30)
    scans.wait(30)
    passed_over = 0
    for reader in (clouds, scans):
        messages = list(reader.messages)
        assert not any(message["dropped"] for message in messages), "messages were lost by one who reads"
        assert all(b["seq"] == a["seq"] + 1 for a, b in zip(messages, messages[1:]))
        passed_over += messages[-1]["data"]["turn"] - messages[0]["data"]["turn"] + 1 - len(messages)
    wait_for("word of that loss", lambda: next(unread)["dropped"] > 0)
    slow.close()
    status = logger.call("source.status")
    check_losses(status)
    # On a busy machine the daemon itself may be late; it says so, and nothing else is missing.
    assert passed_over <= status["turns_dropped"] + status["clouds_dropped"], (passed_over, status)


def check_losses(status):
    for name in ("lost", "out_of_order", "wrong_size"):
        assert status[name] == 0, status


def check_clouds(logger, port, capture, name):
    model = {"hdl32e": reference.HDL32E, "vlp16": reference.VLP16}[name]
    clouds = Listener(port, "cloud")
    opened = logger.call("source.open", pcap=capture, speed=1, loop=True)
    assert opened["state"] == "replay" and not opened["paused"], opened
    clouds.wait(10)
    cloud = clouds.messages[-1]["data"]
    count = len(cloud["x"])
    assert 0 < count <= 2000 and all(len(cloud[name]) == count for name in ("y", "z", "laser", "intensity")), count
    status = logger.call("source.status")
    assert cloud["model"] == status["model"] and cloud["frame"] == "lidar", (cloud["model"], status)
    for x, y, z, laser in zip(*(cloud[name] for name in ("x", "y", "z", "laser"))):
        z -= model.offsets[laser] / 1000
        far = math.hypot(x, y, z)
        assert far < 0.1 or abs(math.asin(z / far) - math.radians(model.elevations[laser])) < 0.002 / far, (x, y, z, laser)
    # Settings apply at once.
    logger.call("settings.set", values={"cloud": {"turn_step": 3}})
    turns = lambda: [message["data"]["turn"] for message in clouds.messages[-3:]]  # noqa: E731
    wait_for("every third turn only", lambda: turns() == list(range(turns()[0], turns()[0] + 7, 3)))
    logger.call("settings.set", values={"cloud": {"turn_step": 1}})
    check_losses(logger.call("source.status"))


def single(value):
    """As a float of 32 bits has it."""
    return struct.unpack("f", struct.pack("f", value))[0]


def read_rows(path, end):
    """Header and rows of numbers of an ascii PCD or PLY file."""
    with open(path, encoding="ascii") as file:
        header, rows = file.read().split(end + "\n")
    return header.splitlines(), [[float(value) for value in row.split()] for row in rows.splitlines()]


def check_csv(path, turns):
    with open(path, encoding="ascii") as file:
        header, *rows = file.read().splitlines()
    assert header == "turn,stamp,laser,azimuth,range,intensity,x,y,z"
    first = int(rows[0].split(",")[1].replace(".", ""))
    turn = next(turn for turn in turns if turn and turn[0].stamp_ns == first)
    assert len(rows) == len(turn), (len(rows), len(turn))
    for row, point in zip(rows, turn):
        _, stamp, laser, azimuth, metres, intensity, x, y, z = row.split(",")
        assert (int(stamp.replace(".", "")), int(laser), float(azimuth), float(metres), int(intensity), float(x), float(y),
                float(z)) == point, (row, point)


def check_floats(rows, turns, model):
    rings = sorted(model.elevations)
    turn = next(turn for turn in turns if len(turn) == len(rows) and single(turn[0].x) == single(rows[0][0]))
    for (x, y, z, intensity, ring, t), point in zip(rows, turn):
        assert [single(value) for value in (x, y, z)] == [single(value) for value in (point.x, point.y, point.z)], point
        assert intensity == point.intensity and rings[int(ring)] == model.elevations[point.laser]
        assert abs((t - rows[0][5]) - (point.stamp_ns - turn[0].stamp_ns) * 1e-9) < 1e-7


def check_captures(logger, folder, capture, model):
    turns = reference.turns(capture, "all")
    paths = {}
    for kind in ("csv", "pcd", "ply"):
        result = logger.call("capture.turn", name=model, format=kind)
        paths[kind] = result["path"]
        assert result["path"] == os.path.join(folder, f"{model}.{kind}") and result["points"] > 1000, result
        refusal(logger, "capture.turn", -32008, name=model, format=kind)  # it exists
    sensor = {"hdl32e": reference.HDL32E, "vlp16": reference.VLP16}[model]
    check_csv(paths["csv"], turns)
    header, rows = read_rows(paths["pcd"], "DATA ascii")
    assert header[3] == "FIELDS x y z intensity ring t" and header[-1] == f"POINTS {len(rows)}", header
    check_floats(rows, turns, sensor)
    subprocess.run([os.path.join(BINARIES, "hermes-vector"), "segment", paths["pcd"], "--out", os.devnull, "--force"],
                   check=True, stdin=subprocess.DEVNULL)
    header, rows = read_rows(paths["ply"], "end_header")
    assert header[0] == "ply" and f"element vertex {len(rows)}" in header, header
    check_floats(rows, turns, sensor)
    assert not [name for name in os.listdir(folder) if ".part-" in name]
    refusal(logger, "capture.turn", -32602, name="x", format="xyz")
    refusal(logger, "capture.turn", -32602, name="../x")


def check_replay(logger, port, capture):
    first_s = next(reference.datagrams(capture))[0] * 1e-9
    stream = Daemon(port=port, timeout=60).subscribe("scan2d", queue=1000)
    threading.Thread(target=next, args=(stream,)).start()  # makes the subscription
    opened = logger.call("source.open", pcap=capture, speed=0.2, paused=True)  # slow, so that it does not end meanwhile
    assert opened["state"] == "replay" and opened["paused"], opened
    status = lambda: logger.call("source.status")["source"]  # noqa: E731
    wait_for("the duration", lambda: status()["duration_s"] is not None)
    duration_s = status()["duration_s"]
    last_s = max(stamp for stamp, _ in reference.datagrams(capture)) * 1e-9
    assert abs(duration_s - (last_s - first_s)) < 1e-3, (duration_s, last_s - first_s)
    assert not logger.call("source.pause", paused=False)["paused"]
    assert logger.call("source.pause")["paused"]
    target_s = 0.3 * duration_s
    assert abs(logger.call("source.seek", t_s=target_s)["position_s"] - target_s) < 1e-6
    assert not logger.call("source.pause", paused=False)["paused"]
    assert next(message for message in stream if message["data"]["stamp"] >= first_s + target_s - 0.01)
    logger.call("source.seek", t_s=2 * duration_s)
    wait_for("the end", lambda: status()["state"] == "ended")
    refusal(logger, "source.seek", -32005, t_s=0)
    refusal(logger, "source.pause", -32005)
    refusal(logger, "capture.turn", -32005, name="late")


def check_sensors(logger, capture):
    """Packets are found whatever port they went to, and of a port that is asked for only."""
    port = next(reference.ports(capture))
    status = lambda: logger.call("source.status")  # noqa: E731
    logger.call("source.open", pcap=capture, speed=0)
    wait_for("the end", lambda: status()["source"]["state"] == "ended")
    assert status()["packets"] == PACKETS and status()["sensor"].endswith(f" to port {port}"), status()
    logger.call("source.open", pcap=capture, speed=0, port=1)
    wait_for("the end", lambda: status()["source"]["state"] == "ended")
    assert (status()["packets"], status()["other_sensors"], status()["sensor"]) == (0, PACKETS, None), status()
    logger.call("source.open", pcap=capture, speed=1, loop=True, port=1)
    health = lambda: next(item for item in logger.call("daemon.status")["health"] if item["name"] == "lidar")  # noqa: E731
    wait_for("word of packets that nobody asked for", lambda: health()["level"] == "warn")
    told = rf"no data packet is decoded, those that came are of [\d.:]+ to port {port}"
    assert re.fullmatch(told, health()["message"]), health()
    refusal(logger, "source.open", -32602, live=True, port=1)


def check_overload(logger, port, capture):
    """Turns come faster than messages can be made of them, as on a slow machine: the logger still answers, and tells the loss."""
    clouds = Listener(port, "cloud")
    logger.call("source.open", pcap=capture, speed=1000, loop=True)
    wait_for("turns that were passed over", lambda: logger.call("source.status")["clouds_dropped"] > 100)
    clouds.wait(20)
    logger.call("source.close")


def start_logger(folder, **settings):
    return Process(BINARIES, "velodynelogger", free_port(0), folder,
                   {"source.port": free_port(0, socket.SOCK_DGRAM), "source.address": "127.0.0.1", "record.folder": folder,
                    "decode.clock": "gps", **settings})  # an independent decoder knows no other


def check_without_offsets(folder, capture):
    """decode.vertical_offsets: false leaves all lasers in the sensor's origin."""
    with start_logger(folder, **{"decode.vertical_offsets": "false"}) as process:
        logger = process.connect()
        logger.call("source.open", pcap=capture, speed=1, loop=True)
        check_csv(logger.call("capture.turn", name="no-offsets")["path"], reference.turns(capture, "all", offsets=False))
        assert process.stop() == 0, process.last_words()


def main():
    with tempfile.TemporaryDirectory() as folder:
        # So that a busy machine costs a reader nothing.
        with start_logger(folder, **{"cloud.max_points": 2000, "limits.topic_bytes": 2 << 20}) as process:
            logger = process.connect()
            for model, product in (("hdl32e", 0x21), ("vlp16", 0x22)):
                capture = os.path.join(folder, f"made-{model}.pcap")
                write_capture(capture, product, product, 0x37, PACKETS)
                check_clouds(logger, process.port, capture, model)
                check_captures(logger, folder, capture, model)
                check_replay(logger, process.port, capture)
                check_sensors(logger, capture)
            check_slow_reader(logger, process.port, os.path.join(folder, "made-hdl32e.pcap"))
            check_overload(logger, process.port, os.path.join(folder, "made-hdl32e.pcap"))
            assert process.stop() == 0, process.last_words()
        check_without_offsets(folder, os.path.join(folder, "made-vlp16.pcap"))
    print("clouds, captured turns and replays of both sensors are as they should be")
    return 0


if __name__ == "__main__":
    sys.exit(main())
