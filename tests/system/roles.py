#!/usr/bin/env python3
"""Who may do what: each command of each daemon, called by each kind of client, is refused exactly where the role is too small, and
a refused one changes nothing. Programs of other users (needs root) may read and stop, no more; they take nobody's place."""
import json
import os
import socket
import sys
import tempfile
import time

from support import BINARIES, WORLD, Daemon, Process, free_port, text_of, wait_for

ROLES = ("observer", "operator", "engineer")
NOT_AUTHORISED = -32001
OTHER_USER = 65534
# What the daemons do not give to others than engineers, whatever else is declared.
MUST = {"settings.set": "engineer", "settings.reset": "engineer", "settings.save": "engineer", "daemon.shutdown": "engineer",
        "process.add": "engineer", "process.remove": "engineer", "map.save": "engineer", "map.load": "engineer",
        "map.export": "engineer", "sim.load": "engineer", "trigger.define": "engineer", "motor.drive": "operator",
        "motor.reset_estop": "operator", "control.acquire": "operator", "motor.stop": "observer", "motor.estop": "observer"}
# Not called by those who may: they end it, or its processes.
ENDS = {"daemon.shutdown", "process.stop", "process.restart"}


def may_be_others():
    """Root, and allowed to act as another user."""
    try:
        os.seteuid(OTHER_USER)
        os.seteuid(0)
    except OSError:
        return False
    return True


MAY_BE_OTHERS = may_be_others()


class Raw:
    """A client that sees the lines; user: whose it is."""

    def __init__(self, port, own=False, user=None, source=None):
        before = os.geteuid()
        if user is not None:
            os.seteuid(user)  # a socket is of who makes it
        try:
            self.socket = socket.socket(socket.AF_UNIX if own else socket.AF_INET)
            self.socket.settimeout(30)
            if source:
                self.socket.bind((source, 0))
            self.socket.connect(f"\0hermes:127.0.0.1:{port}" if own else ("127.0.0.1", port))
        finally:
            os.seteuid(before)
        self.lines = self.socket.makefile("rb")

    def ask(self, method, **params):
        self.socket.sendall(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}).encode() + b"\n")
        return json.loads(self.lines.readline())

    def role_is_too_small(self, method, **params):
        """Whether it is refused for that; the refusal tells the role that is needed."""
        error = self.ask(method, **params).get("error", {})
        if error.get("code") == NOT_AUTHORISED:
            assert ROLES.index(error["data"]["role"]) < ROLES.index(error["data"]["needed"]), error
            assert error["data"]["needed"] in error["message"], error
        return error.get("code") == NOT_AUTHORISED


def declared(daemon):
    """The role of each method; parameters that have one of their own."""
    methods = daemon.call("rpc.discover")["methods"]
    restricted = [(method["name"], param["name"], param["schema"]["x-role"]) for method in methods for param in method["params"]
                  if "x-role" in param["schema"]]
    return {method["name"]: method["x-role"] for method in methods}, restricted


def check_every_method(name, process, clients):
    with process.connect() as daemon:
        roles, restricted = declared(daemon)
    for method, role in MUST.items():
        assert roles.get(method, role) == role, (name, method, roles[method])
    for role, client in clients:
        for method, needed in roles.items():
            may = ROLES.index(role) >= ROLES.index(needed)
            if may and method in ENDS:
                continue
            # Parameters that no command has: who may is told so, who may not is not told that much.
            refused = client.role_is_too_small(method, no_such_parameter=1)
            assert refused != may, f"{name} {method} as {role}: {'refused' if refused else 'not refused'}"
        for method, param, needed in restricted:
            if ROLES.index(roles[method]) <= ROLES.index(role) < ROLES.index(needed):
                value = True if method == "control.acquire" else "/tmp/x.pcap"
                assert client.role_is_too_small(method, **{param: value}), (name, method, param, role)
    assert process.process.poll() is None, process.last_words()


def clients_of(port):
    clients = [("operator", Raw(port)), ("engineer", Raw(port, own=True))]
    if MAY_BE_OTHERS:
        clients += [("observer", Raw(port, user=OTHER_USER)), ("observer", Raw(port, own=True, user=OTHER_USER))]
    return clients


def own_address():
    """Of this computer, not on loopback; nothing: it has none."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
            return probe.getsockname()[0]
        except OSError:
            return None


def check_disguises(process, folder):
    """Another user from another address of this computer; one who has gone when the daemon looks."""
    address = own_address()
    if address:
        assert Raw(process.port, user=OTHER_USER, source=address).ask("daemon.info")["result"]["role"] == "observer"
    os.seteuid(OTHER_USER)
    try:
        for _ in range(300):
            with socket.create_connection(("127.0.0.1", process.port)) as gone:
                gone.sendall(b'{"jsonrpc":"2.0","id":1,"method":"trigger.fire","params":{"id":"gone"}}\n')
    finally:
        os.seteuid(0)
    process.connect().call("daemon.status")

    def fired():
        lines = []
        for name in os.listdir(folder):
            if name.startswith("softwaretrigger") and name.endswith(".jsonl"):
                lines += [json.loads(line) for line in text_of(os.path.join(folder, name)).splitlines()]
        return [line for line in lines if "gone" in str(line.get("params"))]
    wait_for("lines of those who have gone", fired, 10)
    assert all(line["role"] == "observer" for line in fired()), fired()[:3]


def check_settings(process):
    """access.* have effect on those who are connected, at once."""
    with process.connect() as daemon:
        plain = Raw(process.port)
        assert plain.role_is_too_small("settings.reset", paths=["limits"])
        daemon.call("settings.set", values={"access": {"plain": "engineer"}})
        assert not plain.role_is_too_small("settings.reset", paths=["limits"])
        daemon.call("settings.set", values={"access": {"plain": "observer"}})
        assert plain.role_is_too_small("trigger.fire", id="x")
        daemon.call("settings.reset", paths=["access"])
        assert not plain.role_is_too_small("trigger.fire", id="x")


def check_own_socket(folder):
    """A name that somebody else holds: the daemon runs, its own user comes over TCP."""
    port = free_port(0)
    with socket.socket(socket.AF_UNIX) as squatter:
        before = os.geteuid()
        os.seteuid(OTHER_USER)
        squatter.bind(f"\0hermes:127.0.0.1:{port}")
        squatter.listen()
        os.seteuid(before)
        with Process(BINARIES, "softwaretrigger", port, folder, {}) as process:
            with process.connect() as daemon:
                assert daemon.socket.family == socket.AF_INET, "spoke to somebody else"
                daemon.call("daemon.status")
            assert "hermes:127.0.0.1" in text_of(process.log_name)


def check_killed(folder):
    """A daemon that was killed leaves no name behind."""
    port = free_port(0)
    for _ in range(2):
        process = Process(BINARIES, "softwaretrigger", port, folder, {})
        with process.connect() as daemon:
            wait_for("the own socket", lambda: Daemon(port=port).socket.family == socket.AF_UNIX, 10)
            assert daemon.call("daemon.info")["pid"] == process.process.pid
        process.process.kill()
        process.process.wait()


def check_other_user_moves_nothing(folder):
    """Row 2 of a day of attacks: the control, the emergency stop and the programs of others."""
    line = os.path.join(folder, "motors")
    with Process(BINARIES, "simulator", free_port(0), folder, {
            "motors.link": line, "world": WORLD, "lidar.port": free_port(0, socket.SOCK_DGRAM)}) as simulator, \
            Process(BINARIES, "motorcontrol", free_port(0), folder, {f"controllers.{i}.url": f"serial://{line}" for i in (1, 2)}) as motors, \
            Process(BINARIES, "supervisor", free_port(0), folder, {}) as supervisor:
        with simulator.connect(), motors.connect() as owner, supervisor.connect():
            wait_for("readiness", lambda: owner.call("motor.state")["ready"])
            owner.call("control.acquire", client="owner", timeout_s=30)
            stranger = Raw(motors.port, user=OTHER_USER)
            for method, params in (("control.acquire", {"take_over": True}), ("motor.drive", {"vx": 0.1}),
                                   ("motor.reset_estop", {}), ("control.release", {}), ("odometry.reset", {})):
                assert stranger.role_is_too_small(method, **params), method
            assert owner.call("control.state")["holder"] == "owner"
            assert "result" in stranger.ask("motor.estop"), "anyone may stop"
            assert stranger.role_is_too_small("motor.reset_estop")
            assert Raw(supervisor.port, user=OTHER_USER).role_is_too_small("process.add", name="x", program="/bin/sh")
            assert Raw(supervisor.port).role_is_too_small("process.add", name="x", program="/bin/sh"), "a web page may come so"


def main():
    with tempfile.TemporaryDirectory() as folder:
        for name in ("motorcontrol", "velodynelogger", "seriallogger", "softwaretrigger", "scanmatcher", "scanner", "supervisor", "simulator"):
            settings = {"velodynelogger": {"source.port": free_port(0, socket.SOCK_DGRAM), "source.position_port": 0},
                        "motorcontrol": {"controllers": json.dumps({n: {"url": "serial://" + os.path.join(folder, "line")} for n in ("1", "2")})}}.get(name, {})
            with Process(BINARIES, name, free_port(0), folder, {"audit.folder": folder, **settings}) as process:
                process.connect().close()
                check_every_method(name, process, clients_of(process.port))
                if name == "softwaretrigger":
                    check_settings(process)
                    if MAY_BE_OTHERS:
                        check_disguises(process, folder)
        check_killed(folder)
        if MAY_BE_OTHERS:
            check_own_socket(folder)
            check_other_user_moves_nothing(folder)
        else:
            print("may not act as other users: their programs are not tried")
    return 0


if __name__ == "__main__":
    sys.exit(main())
