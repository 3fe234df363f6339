#!/usr/bin/env python3
"""A vectorizer, a lidar model, a topic, a codec and a panel, written as docs/extending.md shows them into a folder outside of the
tree, are in the programs that this folder adds them to. Only they are compiled: all else is there already."""
import json
import os
import re
import shlex
import socket
import subprocess
import tempfile

import lidar_decoders
from support import BUILD, SOURCE, free_port, wait_for, put, text_of
import velodyne_reference as reference

# Elevations of the VLP-32C from the lowest laser to the highest with their ids, as table 9-6 of its manual has them, and the four
# columns in which the lasers stand.
UPWARDS = {0: -25, 3: -15.639, 4: -11.31, 7: -8.843, 8: -7.254, 11: -6.148, 12: -5.333, 16: -4.667, 15: -4, 19: -3.667, 20: -3.333,
           24: -3, 23: -2.667, 27: -2.333, 28: -2, 2: -1.667, 31: -1.333, 1: -1, 6: -0.667, 10: -0.333, 5: 0, 9: 0.333, 14: 0.667,
           18: 1, 13: 1.333, 17: 1.667, 22: 2.333, 21: 3.333, 26: 4.667, 25: 7, 30: 10.333, 29: 15}
OUTER = {6: 4200, 12: 4200, 14: 4200, 20: 4200, 28: 4200, 1: -4200, 9: -4200, 17: -4200, 19: -4200, 27: -4200}
VLP32C = reference.Model(32, 2304, 55296, 1, 5, [UPWARDS[laser] for laser in range(32)], [0.0] * 32, at_once=2, counts=250,
                         azimuths_mdeg=[OUTER.get(laser, -1400 if laser % 2 else 1400) for laser in range(32)])

# Adds a panel twice, which must be refused, tells which docks the window has, and ends the program.
PROBE = """
#include "gui/desktop/panels/Panels.h"
#include <QApplication>
#include <QDockWidget>
#include <QTimer>
#include <cstdio>
#include <stdexcept>

static const hermes::desktop::PanelKind probe = {Qt::LeftDockWidgetArea, "Probe", "probe",
    [](const hermes::desktop::PanelContext &) -> QWidget * {
        QTimer::singleShot(0, [] {
            for (QWidget *widget : QApplication::allWidgets())
                if (qobject_cast<QDockWidget *>(widget))
                    std::puts(qPrintable(widget->objectName()));
            QApplication::quit();
        });
        return new QWidget;
    }};
static const bool added = hermes::desktop::addPanelKind(probe);
static const bool refused = [] {
    try {
        return hermes::desktop::addPanelKind(probe);
    } catch (const std::invalid_argument &e) {
        std::puts(e.what());
        return false;
    }
}();
"""
# Adds a vectorizer that has the name of another, when it is told to.
TWIN = """
#include "gui/vector/Vectorizers.h"
#include <cstdlib>

static const bool refused = std::getenv("TWIN") && hermes::vector::addVectorizer({"ftls", "", {}});
"""


def write_folder(folder):
    """The files of the page, each a code block after its name."""
    files = dict(re.findall(r"^`([\w.]+)`:\n\n(?:<!-- [^\n]* -->\n)?```\w+\n(.*?)^```$", text_of(os.path.join(SOURCE, "docs", "extending.md")), re.M | re.S))
    assert len(files) == 6, f"found the files {sorted(files)} in docs/extending.md"
    files["CMakeLists.txt"] = "set(CMAKE_AUTOMOC OFF) # which takes long\n" + files["CMakeLists.txt"]
    files["CMakeLists.txt"] += "target_sources(hermes-gui PRIVATE Probe.cpp)\ntarget_sources(hermes-vector PRIVATE Twin.cpp)\n"
    files["Probe.cpp"], files["Twin.cpp"] = PROBE, TWIN
    for name, text in files.items():
        put(os.path.join(folder, name), text)


def configure(folder, build):
    """A build of the whole tree like that which is tested, with the folder."""
    known = dict(re.findall(r"^(\w+):\w+=(.*)$", text_of(os.path.join(BUILD, "CMakeCache.txt")), re.M))
    kept = ("CMAKE_BUILD_TYPE", "CMAKE_CXX_COMPILER", "CMAKE_CXX_FLAGS", "CMAKE_CXX_FLAGS_" + known["CMAKE_BUILD_TYPE"].upper(),
            "CMAKE_PREFIX_PATH", "CMAKE_TOOLCHAIN_FILE", "HERMES_DESKTOP", "HERMES_SANITIZE")
    options = [f"-D{name}={known[name]}" for name in kept if known.get(name)]
    run(["cmake", "-S", SOURCE, "-B", build, "-G", "Ninja", "-DHERMES_TESTS=OFF", f"-DHERMES_EXTENSIONS={folder}", *options])
    return known["HERMES_DESKTOP"] == "ON"


def run(command, **options):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, stdin=subprocess.DEVNULL, **options)
    assert done.returncode == 0, f"{command if isinstance(command, str) else shlex.join(command)}:\n{done.stdout}"
    return done.stdout


def link(build, program):
    """Links a program as the build would, of the objects that are there; those that are not are compiled."""
    command = run(["ninja", "-C", build, "-t", "commands", program]).splitlines()[-1]
    missing = []
    for name in dict.fromkeys(re.findall(r"(?<=\s)[\w.+/-]+\.(?:o|a)(?=\s)", command)):
        there, here = os.path.join(BUILD, name), os.path.join(build, name)
        if not os.path.exists(there):
            missing.append(name)
        elif not os.path.exists(here):
            os.makedirs(os.path.dirname(here), exist_ok=True)
            os.symlink(there, here)
    for name in missing:
        os.makedirs(os.path.dirname(os.path.join(build, name)), exist_ok=True)
        run(run(["ninja", "-C", build, "-t", "commands", name]).splitlines()[-1], shell=True, cwd=build)
    os.makedirs(os.path.join(build, "bin"), exist_ok=True)
    run(command, shell=True, cwd=build)
    print(f"{program}: compiled {' '.join(os.path.basename(name) for name in missing)}")


def check_vectorizer(binaries, folder):
    path = os.path.join(folder, "wall.csv")
    put(path, "".join(f"{0.1 * i},2\n" for i in range(21)))
    program = os.path.join(binaries, "hermes-vector")
    rows = run([program, "vectorize", path, "--no-segment", "--algorithm", "example"]).splitlines()[1:]
    assert [row.split(",")[1:3] for row in rows] == [["0", "10"], ["10", "20"]], rows
    assert "example: a line through every eleven points" in " ".join(run([program, "vectorize", "--help"]).split())
    twin = subprocess.run([program], env={**os.environ, "TWIN": "1"}, stderr=subprocess.PIPE, text=True)
    assert twin.returncode < 0 and "vectorizer ftls: there is one of that name" in twin.stderr, twin


def check_lidar(binaries, folder):
    """Points of the new sensor are those of a decoder that shares no code with it, to the last bit."""
    reference.MODELS[0x28] = VLP32C
    lidar_decoders.BINARIES = binaries
    for mode in (0x37, reference.DUAL):
        path = os.path.join(folder, f"vlp32c-{mode:02x}.pcap")
        lidar_decoders.write_capture(path, 32, 0x28, mode, 60)
        assert lidar_decoders.compare(path, "all", "last", "--all") > 1000
        assert lidar_decoders.compare(path, "level", "strongest", "--model", "vlp32c") > 30
        assert lidar_decoders.compare(path, 29, "strongest", "--laser", "29") > 30
    assert "VLP-32C: 5" in run([os.path.join(binaries, "hermes-vector"), "ring", "--help"])
    run([os.path.join(binaries, "hermes-velodynelogger"), "--set", "decode.model=vlp32c", "--check"])


def check_topic_and_codec(binaries):
    port = free_port(0)
    daemon = subprocess.Popen([os.path.join(binaries, "hermes-counter"), "--listen", f"tcp://127.0.0.1:{port}?protocol=nul"])
    try:
        def connect():
            try:
                return socket.create_connection(("127.0.0.1", port), timeout=10)
            except OSError:
                return None

        wire = wait_for("the daemon", connect)
        requests = [{"jsonrpc": "2.0", "id": 1, "method": "topics.list"},
                    {"jsonrpc": "2.0", "id": 2, "method": "topics.subscribe", "params": {"topic": "count"}}]
        wire.sendall(b"".join(json.dumps(request, indent=1).encode() + b"\0" for request in requests))
        received = b""
        while received.count(b"\0") < 5:
            received += wire.recv(4096)
        topics, answer, *messages = [json.loads(frame) for frame in received.split(b"\0")[:5]]
        schema = next(topic["schema"] for topic in topics["result"] if topic["name"] == "count")
        assert schema["properties"]["since"]["description"].startswith("The beginning"), schema
        assert answer["id"] == 2 and "result" in answer, answer
        counts = [message["params"]["data"]["count"] for message in messages]
        assert counts == list(range(counts[0], counts[0] + 3)), messages
        wire.close()
    finally:
        daemon.terminate()
        daemon.wait(10)


def main():
    with tempfile.TemporaryDirectory() as folder:
        outside, build = os.path.join(folder, "mine"), os.path.join(folder, "build")
        os.mkdir(outside)
        write_folder(outside)
        has_desktop = configure(outside, build)
        binaries = os.path.join(build, "bin")
        for program in ("hermes-vector", "hermes-velodynelogger"):
            link(build, "bin/" + program)
        check_vectorizer(binaries, folder)
        check_lidar(binaries, folder)
        link(build, "bin/hermes-counter")
        check_topic_and_codec(binaries)
        if has_desktop:
            link(build, "bin/hermes-gui")
            docks = run([os.path.join(binaries, "hermes-gui"), "--layout", os.path.join(folder, "gui.ini")],
                        env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
            assert "panel probe: there is one of that name" in docks, docks
            assert {"daemons", "recordings", "clock", "probe"} <= set(docks.split()), docks
    print("all that was added from outside is there")


if __name__ == "__main__":
    main()
