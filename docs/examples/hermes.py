"""A client for Hermes daemons in plain Python 3: call commands, follow topics.

    with Daemon(port=7450) as matcher:
        print(matcher.call("daemon.status")["state"])
        for message in matcher.subscribe("pose", max_rate_hz=5):
            print(message["stamp"], message["data"])

A daemon that cannot be reached, and a connection that breaks, raise OSError.
"""
import collections
import itertools
import json
import os
import pwd
import socket
import struct

MOST_CHARACTERS = 1 << 25  # of a message


class DaemonError(Exception):
    """The daemon refused a call: code, message, and data that name the reason."""

    def __init__(self, error):
        super().__init__(f"{error['message']} ({error['code']})")
        self.code, self.message, self.data = error["code"], error["message"], error.get("data")


def is_believed(listener):
    """Whether what listens as this user is a daemon of ours: of root, of the user, or of a service whose group the user is in."""
    if listener in (0, os.getuid()):
        return True
    try:
        group, user = pwd.getpwuid(listener).pw_gid, pwd.getpwuid(os.getuid())
    except KeyError:
        return False
    return listener < 1000 and (user.pw_uid == 0 or group in os.getgrouplist(user.pw_name, user.pw_gid))


def own_socket(host, port):
    """A connection to the Unix socket beside the TCP port of a daemon of this user, which gives all rights; None without one."""
    connection = socket.socket(socket.AF_UNIX)
    connection.settimeout(1)  # somebody else may have taken the name
    host = "127.0.0.1" if host == "localhost" else host
    try:
        connection.connect(f"\0hermes:{host}:{port}")
    except OSError:
        connection.close()
        return None
    credentials = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize("3i"))
    if is_believed(struct.unpack("3i", credentials)[1]):
        return connection
    connection.close()  # anyone may take the name while no daemon runs
    return None


class Daemon:
    """A connection to one daemon, which answers within `timeout` seconds. Not for use from several threads at once."""

    def __init__(self, host="127.0.0.1", port=7400, timeout=5.0):
        self.socket = self.connect(host, port, timeout)
        self.timeout = timeout
        self.socket.settimeout(timeout)
        self.lines = self.socket.makefile("r", encoding="utf-8")
        self.ids = itertools.count(1)
        self.topics = collections.defaultdict(collections.deque)  # messages not yet asked for, by subscription

    def connect(self, host, port, timeout):
        if own := own_socket(host, port):
            return own
        try:
            connection = socket.create_connection((host, port), timeout)
        except OSError as error:
            raise ConnectionError(f"no daemon answers at {host}:{port}: {error.strerror or error}") from error
        if own := own_socket(host, port):  # the daemon has begun to listen just now, there before here
            connection.close()
            return own
        return connection

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.lines.close()
        self.socket.close()

    def call(self, method, **params):
        """The result of a command, whose parameters are `params`; raises DaemonError when the daemon refuses it."""
        request = {"jsonrpc": "2.0", "id": next(self.ids), "method": method, "params": params}
        self.socket.sendall(json.dumps(request, allow_nan=False).encode() + b"\n")
        while True:
            message = self._receive()
            if message.get("id") == request["id"]:
                if "result" in message:
                    return message["result"]
                error = message.get("error")
                known = isinstance(error, dict) and {"code", "message"} <= error.keys()
                raise DaemonError(error if known else {"code": -32603, "message": f"{method}: the reply has no result: {message}"[:500]})

    def subscribe(self, topic, **options):
        """Yields the topic's messages as they come, without end: dictionaries with seq, stamp (seconds since the epoch), dropped
        and data. Options are those of topics.subscribe, such as max_rate_hz."""
        subscription = self.call("topics.subscribe", topic=topic, **options)["subscription"]
        return self._messages(self.topics[subscription])

    def _messages(self, queue):
        while True:
            self.socket.settimeout(None)  # a topic may be silent for long
            try:
                while not queue:
                    self._receive()
            finally:
                self.socket.settimeout(self.timeout)
            yield queue.popleft()

    def _receive(self):
        line = self.lines.readline(MOST_CHARACTERS)
        if len(line) == MOST_CHARACTERS:
            raise ConnectionError(f"the daemon sent a line of over {MOST_CHARACTERS} characters")
        if not line.endswith("\n"):  # nothing, or a message that was on its way
            raise ConnectionError("the daemon closed the connection")
        message = json.loads(line)
        if not isinstance(message, dict):
            raise ValueError(f"expected an object of JSON, found {line[:100]}")
        if message.get("method") == "topic":
            self.topics[message["params"]["subscription"]].append(message["params"])
        return message
