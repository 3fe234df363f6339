"""Runs hermes-vector for the result files."""
import csv
import json
import math
import os
import shutil
import subprocess
import tempfile

import results

BUILD = os.environ.get("HERMES_BUILD") or os.path.join(results.SOURCE, "build", "release")
FIVE = ("intel", "freiburg-079", "fhw", "belgioioso", "orebro")


class Missing(Exception):
    """A log or a program that is not there."""


class Runs:
    """The runs of one result, in a folder of their own that is gone at the end, and the commands for its file."""

    def __init__(self, logs):
        self.logs, self.commands = logs, []

    def __enter__(self):
        self.folder = tempfile.mkdtemp()
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def log(self, name):
        """A file of the folder of logs, or the corrected log of this name."""
        path = os.path.join(self.logs or "", name if "." in name else name + "-corrected.log.gz")
        if not self.logs or not os.path.exists(path):
            raise Missing(path)
        return path

    def vector(self, command):
        """What a command prints. {NAME} is a log, @NAME a file of this folder."""
        words = []
        for word in command.split():
            named = word.startswith("{")
            words.append(self.log(word[1:-1]) if named else self.path(word[1:]) if word.startswith("@") else word)
        shown = "hermes-vector " + " ".join("LOG" if w.startswith("{") else w.lstrip("@") for w in command.split())
        if shown not in self.commands:
            self.commands.append(shown)
        if words[0] in ("experiment", "report") and not os.path.exists(program := os.path.join(BUILD, "bin", "hermes-experiments")):
            raise Missing(program)
        ran = subprocess.run([os.path.join(BUILD, "bin", "hermes-vector"), *words], capture_output=True, text=True, check=False)
        if ran.returncode:
            raise SystemExit(f"hermes-vector {command}: {ran.stderr}")
        return ran.stdout

    def test(self, name):
        """What a test program prints."""
        program = os.path.join(BUILD, "tests", name)
        if not os.path.exists(program):
            raise Missing(program)
        self.commands.append(name)
        return subprocess.run([program], capture_output=True, text=True, check=True).stdout

    def told(self, command):
        """The JSON that a command prints."""
        return json.loads(self.vector(command))

    def experiment(self, command):
        """The folder of what an experiment leaves; its JSON, where it prints one, is out.json."""
        folder = tempfile.mkdtemp(dir=self.folder)
        printed = self.vector(f"experiment {command} --out @{os.path.basename(folder)} --force")
        self.commands[-1] = self.commands[-1].split(" --out")[0]
        self.commands[:] = dict.fromkeys(self.commands)
        with open(os.path.join(folder, "out.json"), "w", encoding="utf-8") as file:
            file.write(printed)
        return folder


def rows_of(*path):
    """The rows of a CSV, by the names of the columns."""
    with open(os.path.join(*path), newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def json_of(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return json.load(file)


def percent(share, digits=1):
    return f"{100 * share:.{digits}f} %"


def number(value, digits):
    """With so many digits that count, and never with an exponent."""
    rounded = float(f"{float(value):.{digits}g}")
    if rounded == 0 or abs(rounded) >= 10 ** digits:
        return f"{rounded:,.0f}"
    text = f"{rounded:,.{digits - 1 - math.floor(math.log10(abs(rounded)))}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text
