"""What tests of whole systems share: where the programs are, the modules that start and ask them, waiting, a serial port."""
import os
import sys
import time
import tty

SOURCE, BINARIES = os.environ["HERMES_SOURCE"], os.environ["HERMES_BIN"]
sys.path.insert(0, os.path.join(SOURCE, "deploy", "demo"))
from processes import Daemon, DaemonError, Process, free_port  # noqa: E402, F401


def wait_for(what, condition, limit_s=60):
    """The first value of condition() that counts as true."""
    deadline = time.monotonic() + limit_s
    while True:
        value = condition()
        if value:
            return value
        assert time.monotonic() < deadline, f"{what} did not happen within {limit_s} s"
        time.sleep(0.01)


class SerialPort:
    """The near end of a serial line, as a program opens it that knows nothing of pseudo-terminals."""

    def __init__(self, path):
        self.port = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.port)

    def close(self):
        os.close(self.port)
