#!/usr/bin/env python3
"""Help fits the terminal: no line of any program's --help is wider, whatever the width, and no word is lost."""
import fcntl
import glob
import os
import pty
import re
import struct
import subprocess
import termios
import unittest

from support import BINARIES, SLOWNESS, vector_commands

PROGRAMS = sorted(glob.glob(os.path.join(BINARIES, "hermes*")))
QUIET = {"QT_QPA_PLATFORM": "offscreen", "LC_ALL": "C.UTF-8"}
WITHOUT = {key: value for key, value in os.environ.items() if key != "COLUMNS"} | {"QT_LOGGING_RULES": "*=false"}  # no notes of Qt


def help_of(command, width=None):
    columns = {"COLUMNS": str(width)} if width else {}
    return subprocess.run([*command, "--help"], env={**WITHOUT, **QUIET, **columns}, capture_output=True, text=True,
                          timeout=60 * SLOWNESS, check=True).stdout


def help_at_terminal(command, width):
    child, terminal = pty.fork()
    if child == 0:
        fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
        os.execve(command[0], [*command, "--help"], {**WITHOUT, **QUIET})
    text = b""
    try:
        while block := os.read(terminal, 65536):
            text += block
    except OSError:  # the program has ended
        pass
    os.close(terminal)
    assert os.waitpid(child, 0)[1] == 0, command
    return text.decode().replace("\r\n", "\n")


def words(text):
    """Without the places where lists were broken."""
    return re.sub(r",\s+", ",", text).split()


def commands():
    for program in PROGRAMS:
        yield [program]
        if program.endswith("hermes-vector"):
            for name in vector_commands(help_of([program], 10000)):
                yield [program, name]


class HelpWidth(unittest.TestCase):
    def check(self, shown, width, whole, command):
        copied = False  # below "Example:" stand commands to be copied
        for line in shown.splitlines():
            copied = bool(line) and (copied or line in ("Example:", "Examples:"))
            if not copied:
                self.assertLessEqual(len(line), width, f"{command}: {line}")
        self.assertEqual(words(shown), words(whole), command)

    def test_widths(self):
        found = list(commands())
        self.assertGreater(len(found), 18)
        for command in found:
            whole = help_of(command, 10000)
            for width in (60, 80, 200):
                self.check(help_of(command, width), width, whole, command)
            self.assertEqual(help_of(command), help_of(command, 80))  # no terminal
            self.check(help_at_terminal(command, 60), 60, whole, command)
            if max(map(len, whole.splitlines())) > 120:  # uses what there is
                self.assertGreater(max(map(len, help_of(command, 120).splitlines())), 80, command)


if __name__ == "__main__":
    unittest.main()
