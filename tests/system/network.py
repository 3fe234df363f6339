#!/usr/bin/env python3
"""A daemon that the network can reach announces itself through Avahi, anew when Avahi or the bus starts again; without Avahi or D-Bus it
starts all the same. With a bus and an Avahi of this test's own."""
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time

from support import BINARIES, Process, free_port, wait_for, put

ROBOT = "11111111-2222-4333-8444-555555555555", "rover \u00e4"
BUS = """<busconfig><type>system</type><listen>unix:path={folder}/bus</listen><auth>EXTERNAL</auth><policy context="default">
<allow send_destination="*"/><allow receive_sender="*"/><allow own="*"/></policy></busconfig>"""


class Network:
    def __init__(self, folder):
        self.folder = folder
        self.environment = {"DBUS_SYSTEM_BUS_ADDRESS": f"unix:path={folder}/bus"}
        self.children = []

    def start(self, *command):
        log = open(os.path.join(self.folder, os.path.basename(command[0]) + ".log"), "w", encoding="utf-8")
        with log:
            child = subprocess.Popen(command, env={**os.environ, **self.environment}, stdin=subprocess.DEVNULL, stdout=log,
                                     stderr=subprocess.STDOUT)
        self.children.append(child)
        return child

    def start_bus(self):
        config = os.path.join(self.folder, "bus.conf")
        put(config, BUS.format(folder=self.folder))
        bus = self.start("dbus-daemon", "--nofork", f"--config-file={config}")
        wait_for("a bus", lambda: os.path.exists(os.path.join(self.folder, "bus")) or bus.poll() is not None)
        if bus.poll() is not None:
            skip("dbus-daemon may not run here")
        return bus

    def start_avahi(self):
        """On loopback only, so that the network hears nothing of it; its log tells when it is ready."""
        config = os.path.join(self.folder, "avahi.conf")
        put(config, f"[server]\nhost-name=test{os.getpid()}\nenable-dbus=yes\nallow-interfaces=lo\n[wide-area]\nenable-wide-area=no\n")
        avahi = self.start("avahi-daemon", "--no-drop-root", "--no-chroot", "--no-rlimits", "-f", config)
        log = os.path.join(self.folder, "avahi-daemon.log")

        def ready():
            with open(log, encoding="utf-8", errors="replace") as file:
                return "Server startup complete" in file.read() or avahi.poll() is not None

        wait_for("Avahi", ready)
        return avahi

    def stop(self, child):
        child.terminate()
        child.wait(20)
        self.children.remove(child)

    def listed(self):
        """Those of this test that hermesctl finds."""
        shown = subprocess.run([os.path.join(BINARIES, "hermesctl"), "list", "--network", "--json"], capture_output=True, text=True,
                               timeout=60, env={**os.environ, **self.environment})
        return [one for one in json.loads(shown.stdout or "[]") if one["port"] in self.ports]


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def start_daemon(folder, environment, listen):
    """hermes-softwaretrigger, which uses no device, at each (host, framing); and its ports there."""
    os.environ.update(environment, HERMES_ROBOT=" ".join(ROBOT))
    ports = [free_port(0) for _ in listen]
    urls = [word for port, (host, framing) in zip(ports, listen) for word in ("--listen", f"tcp://{host}:{port}?protocol={framing}")]
    return Process(BINARIES, "softwaretrigger", free_port(0), folder, {"insecure": "true"}, urls), ports


def network_lines(process):
    with open(process.log_name, encoding="utf-8") as log:
        return [line for line in log if " network: " in line]


def check_without_bus(folder):
    process, _ = start_daemon(folder, {"DBUS_SYSTEM_BUS_ADDRESS": f"unix:path={folder}/none"}, [("0.0.0.0", "json")])
    process.connect().close()
    wait_for("a line", lambda: network_lines(process))
    assert process.stop() == 0
    assert len(network_lines(process)) == 1 and "no system bus" in network_lines(process)[0], network_lines(process)


def check_silent_bus(folder):
    """One that takes connections and says nothing: nobody waits for it."""
    with socket.socket(socket.AF_UNIX) as bus:
        bus.bind(os.path.join(folder, "silent"))
        bus.listen()
        process, _ = start_daemon(folder, {"DBUS_SYSTEM_BUS_ADDRESS": f"unix:path={folder}/silent"}, [("0.0.0.0", "json")])
        process.connect().close()
        begun = time.monotonic()
        assert process.stop() == 0
        assert time.monotonic() - begun < 3, "the end waits for the bus"


def check_found(network, ports):
    found = wait_for("two announced ports", lambda: len(one := network.listed()) == 2 and one)
    assert {(one["port"], one["framing"]) for one in found} == {(ports[0], "json"), (ports[1], "cbor")}, found
    assert all((one["name"], one["tls"], one["protocol"]) == ("softwaretrigger", "no", "1.0") for one in found), found
    assert all((one["robot_id"], one["robot"]) == ROBOT for one in found), found
    assert all(one["host"] == f"test{os.getpid()}.local" and one["address"] for one in found), found


def check_with_avahi(network):
    bus = network.start_bus()
    process, ports = start_daemon(network.folder, network.environment,
                                  [("0.0.0.0", "json"), ("[::]", "cbor"), ("127.0.0.1", "json")])
    process.connect().close()
    wait_for("a line", lambda: network_lines(process))
    assert "as soon as Avahi can" in network_lines(process)[0], network_lines(process)
    network.ports = {*ports, process.port}
    avahi = network.start_avahi()
    if avahi.poll() is not None:
        skip("avahi-daemon may not run here")
    check_found(network, ports)
    network.stop(avahi)
    avahi = network.start_avahi()
    check_found(network, ports)
    network.stop(avahi)
    network.stop(bus)
    if os.path.exists(os.path.join(network.folder, "bus")):
        os.remove(os.path.join(network.folder, "bus"))
    network.start_bus()
    network.start_avahi()
    check_found(network, ports)
    assert process.stop() == 0
    assert len(network_lines(process)) == 1, network_lines(process)
    wait_for("the end of the announcement", lambda: not network.listed())


def main():
    with tempfile.TemporaryDirectory() as folder:
        check_without_bus(folder)
        check_silent_bus(folder)
        if not shutil.which("dbus-daemon") or not shutil.which("avahi-daemon"):
            skip("the rest needs dbus-daemon and avahi-daemon; without a bus a daemon starts")
        network = Network(folder)
        try:
            check_with_avahi(network)
        finally:
            for child in list(network.children):
                network.stop(child)
    print("announced, found, announced anew, and gone")


if __name__ == "__main__":
    main()
