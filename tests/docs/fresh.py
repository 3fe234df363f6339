#!/usr/bin/env python3
"""Follows docs/getting-started.md in a fresh Debian, as somebody who has read nothing: builds Hermes there, then takes each path
in a terminal of its own, block by block as printed, and tells how long each took.

fresh.py [--debian FOLDER] [--keep] [PATH ...]   (numbers of paths; all of them without one)

Needs root, debootstrap, systemd-nspawn and a mirror of Debian; exit status 77 where these cannot be had."""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

import blocks
import pages

sys.path.insert(0, os.path.join(pages.SOURCE, "tests", "support"))
import fresh_debian  # noqa: E402

PAGE = "docs/getting-started.md"
HOME = "home/student"
LIMITS_S = {1: 120, 2: 180, 3: 180, 4: 600, 5: 300}  # at most, after the build


def sections():
    """(number of the path, or 0 before the first one; its blocks that are run)."""
    starts = [(number, int(found[1])) for number, line in enumerate(pages.read(PAGE).split("\n"), 1)
              for found in [re.match(r"## Path (\d)", line)] if found]
    found = {}
    for block in filter(blocks.is_run, pages.blocks(PAGE)):
        path = max((path for line, path in starts if line < block.line), default=0)
        found.setdefault(path, []).append(block)
    return found


class Student:
    """A user of a fresh Debian who has copied the project and may use sudo."""

    def __init__(self, root):
        self.root, self.folder = root, os.path.join(root, HOME, "hermes")

    def prepare(self):
        self.as_root("useradd --create-home --shell /bin/bash student && echo 'student ALL=(ALL) NOPASSWD: ALL' >/etc/sudoers.d/student")
        os.makedirs(self.folder)
        files = subprocess.run(["tar", "--exclude=./build", "--exclude=./demo-out", "-C", pages.SOURCE, "-c", "."], stdout=subprocess.PIPE, check=True)
        subprocess.run(["tar", "-x", "-C", self.folder], input=files.stdout, check=True)

    def within(self, command, *options):
        return subprocess.run(["systemd-nspawn", "--quiet", "--register=no", "--keep-unit", "--console=pipe", "-D", self.root, *options, *command],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", check=False)

    def as_root(self, command):
        done = self.within(["sh", "-ec", command])
        if done.returncode:
            sys.exit(f"{command}: status {done.returncode}\n{done.stdout[-3000:]}")

    def follow(self, title, section, *options):
        """Seconds that the blocks took, in a new terminal."""
        shutil.rmtree(os.path.join(self.folder, ".blocks"), ignore_errors=True)
        script = blocks.Script(self.folder)
        script.add_all(section)
        page = script.end()
        self.as_root(f"chown -R student: /{HOME}")
        since = time.monotonic()
        done = self.within(["bash", page], "--user=student", f"--chdir=/{HOME}/hermes", "--setenv=QT_QPA_PLATFORM=offscreen", *options)
        took = time.monotonic() - since
        complaint = script.complaint(title, done.stdout)
        if complaint:
            sys.exit(complaint)
        return took


def run(arguments):
    fresh_debian.need("systemd-nspawn")
    found = sections()
    terminal = [block for block in found[0] if "export PATH=" in block.text]  # what the page asks for in each new terminal
    if len(terminal) != 1:
        sys.exit(f"{PAGE}: expected one block with \"export PATH=\" before the first path, found {len(terminal)}")
    work = tempfile.mkdtemp(prefix="hermes-fresh-")
    try:
        root = os.path.join(work, "debian")
        since = time.monotonic()
        fresh_debian.make(root, arguments.debian, ["sudo"])
        student = Student(root)
        student.prepare()
        print(f"{time.monotonic() - since:6.1f} s  a fresh Debian", flush=True)
        print(f"{student.follow('build', found[0]):6.1f} s  the build, {len(found[0])} blocks", flush=True)
        late = []
        for path in arguments.paths or sorted(set(found) - {0}):
            # A network of its own, as a computer has that runs no other Hermes.
            took = student.follow(f"path {path}", terminal + found[path], "--private-network")
            print(f"{took:6.1f} s  path {path}, {len(found[path])} blocks; at most {LIMITS_S[path]} s", flush=True)
            if took > LIMITS_S[path]:
                late.append(path)
        if late:
            sys.exit(f"took too long: path {', '.join(map(str, late))}")
    finally:
        if arguments.keep:
            print(f"kept: {work}")
        else:
            shutil.rmtree(work, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--debian", metavar="FOLDER", help="copy the Debian in this folder instead of making one")
    parser.add_argument("--keep", action="store_true", help="leave the Debian there")
    parser.add_argument("paths", metavar="PATH", nargs="*", type=int, help="a path's number")
    try:
        arguments = parser.parse_args()
        if not set(arguments.paths) <= set(LIMITS_S):
            parser.error(f"expected paths of {sorted(LIMITS_S)}, found {arguments.paths}")
        run(arguments)
    except fresh_debian.Missing as error:
        print(f"cannot be tried here: {error}")
        sys.exit(77)


if __name__ == "__main__":
    main()
