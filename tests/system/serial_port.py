"""The far end of a serial line for tests: a pseudo-terminal behind a link, as a device in /dev/serial/by-id is."""
import os
import pty
import tempfile
import tty

from support import BINARIES, Process, free_port, wait_for


class Device:
    """Plugged in from its making until pull()."""

    def __init__(self, link):
        self.link = link
        self.far, near = pty.openpty()
        tty.setraw(near)
        self.near = near
        os.symlink(os.ttyname(near), link + ".new")
        os.replace(link + ".new", link)

    def write(self, data):
        while data:
            data = data[os.write(self.far, data):]

    def pull(self):
        os.unlink(self.link)
        os.close(self.near)
        os.close(self.far)


class Logger(Process):
    """hermes-seriallogger with one port `dev` on a serial line."""

    def __init__(self, folder, link, **settings):
        ports = f'[{{"name":"dev","url":"serial://{link}?baud=921600"}}]'
        super().__init__(BINARIES, "seriallogger", free_port(0), folder,
                         {"ports": ports, "record.folder": os.path.join(folder, "recordings"), "record.free_floor_bytes": 0,
                          "record.free_warn_bytes": 0, **settings})
        self.daemon = self.connect()

    def line(self):
        return self.daemon.call("ports.list")[0]

    def wait_open(self, times=None):
        """Until the line is open, opened so many times since the start."""
        def opened():
            line = self.line()
            return line["state"] == "open" and times in (None, line["opened"]) and line
        try:
            return wait_for("opening of the line", opened)
        except AssertionError as error:
            raise AssertionError(f"{error}: {self.line()}") from error

    def wait_bytes(self, count):
        wait_for(f"arrival of byte {count}", lambda: self.line()["bytes"] >= count)


def make_folder(base=None):
    return tempfile.TemporaryDirectory(prefix="serial-", dir=base)
