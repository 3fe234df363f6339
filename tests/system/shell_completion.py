#!/usr/bin/env python3
"""The completion of hermes-vector, the daemons and hermes-gui in bash and zsh, by the files that are installed: it offers every
option that --help tells, and nothing else."""
import os
import pty
import re
import select
import shutil
import subprocess
import tempfile
import time
import unittest

from support import BINARIES, BUILD, EXPERIMENTS, SLOWNESS, vector_commands, put, text_of

DAEMONS = [f"hermes-{name}" for name in ("supervisor", "motorcontrol", "velodynelogger", "seriallogger", "softwaretrigger",
                                         "scanmatcher", "scanner", "simulator")]
WINDOW = ["hermes-gui"] if os.path.exists(os.path.join(BINARIES, "hermes-gui")) else []  # not every build has it
ENVIRONMENT = {**os.environ, "PATH": f"{BINARIES}:{os.environ['PATH']}", "QT_QPA_PLATFORM": "offscreen", "LC_ALL": "C.UTF-8"}
# As bash calls the function of a program; the words follow as arguments.
CALL = r"""compopt() { :; } # works at a prompt only
source "$1/share/bash-completion/completions/$2"; shift 2
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMP_LINE="$*"; COMP_POINT=${#COMP_LINE}
call=$(complete -p "$1"); call=${call##*-F }
"${call%% *}" "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\n' "${COMPREPLY[@]}" """


def help_of(*command):
    return subprocess.run([*command, "--help"], env={**ENVIRONMENT, "COLUMNS": "10000"}, capture_output=True, text=True,
                          timeout=60 * SLOWNESS, check=True).stdout


def options_of(help_text):
    """The long options, in the order of the help: all names that stand at the begin of a line."""
    names = re.findall(r"^ {2}(?! )((?:-{1,2}[\w-]+(?:, ?)?)+)", help_text, re.MULTILINE)
    return [option for line in names for option in re.split(", ?", line) if option.startswith("--")]


def choices_of(help_text):
    """{option: [value, ...]} of the options that take one of some values."""
    return {option: values.split(",")
            for option, values in re.findall(r"^ {2}(--[\w-]+) \S+:(?:.*\bOR )?\{([^}]*)\}", help_text, re.MULTILINE)}


COMMANDS = vector_commands(help_of("hermes-vector"))


class Completion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        cls.addClassCleanup(folder.cleanup)
        cls.prefix, cls.folder = os.path.join(folder.name, "prefix"), os.path.join(folder.name, "work")
        subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.prefix, "--component", "completion"],
                       stdout=subprocess.DEVNULL, check=True)
        os.makedirs(os.path.join(cls.folder, "scans"))
        for name in ("scan of today.csv", "settings.json"):
            with open(os.path.join(cls.folder, name), "w", encoding="utf-8"):
                pass


class Bash(Completion):
    def offered(self, *words):
        """What is offered for the last of these words."""
        shown = subprocess.run(["bash", "--norc", "-c", CALL, "bash", self.prefix, words[0], *words], env=ENVIRONMENT, cwd=self.folder,
                               capture_output=True, text=True, timeout=60 * SLOWNESS, check=False)
        self.assertEqual(shown.stderr, "", words)
        return sorted(shown.stdout.split("\n")[:-1] if shown.stdout != "\n" else [])

    def test_commands(self):
        self.assertGreater(len(COMMANDS), 8)
        self.assertEqual(self.offered("hermes-vector", ""), sorted({*COMMANDS, "experiment", "report", "--help", "--version"}))
        self.assertEqual(self.offered("hermes-vector", "reg"), ["register"])

    def test_options(self):
        for command in ([f"hermes-vector {name}" for name in COMMANDS] + DAEMONS + WINDOW):
            with self.subTest(command):
                options = options_of(help_of(*command.split()))
                self.assertIn("--help", options)
                self.assertEqual(self.offered(*command.split(), "--"), sorted(options))

    def test_an_option_of_another_command_is_not_offered(self):
        self.assertIn("--scan", help_of("hermes-vector", "relocalize"))
        self.assertEqual(self.offered("hermes-vector", "relocalize", "--sc"), [])

    def test_values(self):
        found = 0
        for command in COMMANDS:
            for option, values in choices_of(help_of("hermes-vector", command)).items():
                found += 1
                with self.subTest(f"{command} {option}"):
                    self.assertEqual(self.offered("hermes-vector", command, option, ""), sorted(values))
                    self.assertEqual(self.offered("hermes-vector", command, option, "="), sorted(values))
                    self.assertIn(values[-1], self.offered("hermes-vector", command, option, "=", values[-1][:1]))
        self.assertGreater(found, 8)
        self.assertEqual(self.offered("hermes-vector", "match", "--method", ""), ["finder", "global", "relations"])

    @unittest.skipUnless(EXPERIMENTS, "hermes-experiments is not built")
    def test_names_of_experiments_and_worlds(self):
        names = re.search(r"NAME TEXT:\{([^}]*)\}", help_of("hermes-vector", "experiment"))[1].split(",")
        self.assertEqual(self.offered("hermes-vector", "experiment", ""), sorted(names))
        told = help_of("hermes-vector", "report")
        worlds = [w for w in self.offered("hermes-vector", "report", "") if w not in os.listdir(self.folder)]
        self.assertEqual(len(worlds), 4)
        for world in worlds:
            self.assertIn(world, told)

    def test_files(self):
        everything = sorted(os.listdir(self.folder))
        for words in (["match", ""], ["match", "--map", ""], ["match", "one.csv", ""], ["match", "--svg", ""], ["map", "--out", ""],
                      *([["experiment", "--log", ""], ["experiment", "--out", ""]] if EXPERIMENTS else [])):
            self.assertEqual(self.offered("hermes-vector", *words), everything, words)
        self.assertEqual(self.offered("hermes-vector", "match", "--svg", "=", "sc"), ["scan of today.csv", "scans"])
        self.assertEqual(self.offered("hermes-motorcontrol", "--config", "se"), ["settings.json"])
        self.assertEqual(self.offered("hermes-gui", "--layout", "se"), ["settings.json"])  # asks no program

    def test_nothing_where_a_number_is_wanted(self):
        for words in (["match", "--sigma", ""], ["ring", "--port", ""], ["observe", "--pose", ""], ["ring", "--sender", ""]):
            self.assertEqual(self.offered("hermes-vector", *words), [], words)
        self.assertEqual(self.offered("hermes-motorcontrol", "--listen", ""), [])

    def test_settings(self):
        for daemon in DAEMONS:
            with self.subTest(daemon):
                told = re.findall(r"^ {2}([\w.]+) = ", help_of(daemon), re.MULTILINE)
                self.assertEqual(self.offered(daemon, "--set", ""), sorted(f"{path}=" for path in told))


class Zsh(Completion):
    """Keys of a person at a terminal: what the program is called with then."""

    @classmethod
    def setUpClass(cls):
        if not shutil.which("zsh"):
            raise unittest.SkipTest("zsh is not installed")
        super().setUpClass()

    def setUp(self):
        self.said, programs = os.path.join(self.prefix, "said"), os.path.join(self.prefix, "bin")
        os.makedirs(programs, exist_ok=True)
        for name in ["hermes-vector", *DAEMONS, *WINDOW, "begun"]:
            path = os.path.join(programs, name)
            put(path, f'#!/bin/sh\n[ -t 1 ] || exec "{BINARIES}/{name}" "$@"\n'  # the completion asks
                             f'printf "%s|" "$@" >"{self.said}.new"\nmv "{self.said}.new" "{self.said}"\n')
            os.chmod(path, 0o755)
        self.child, self.terminal = pty.fork()
        if self.child == 0:
            os.chdir(self.folder)
            os.environ.update(ENVIRONMENT, PATH=f"{programs}:{os.environ['PATH']}", HOME=self.folder, TERM="dumb", PS1="$ ")
            os.execvp("zsh", ["zsh", "-f", "-i"])
        self.typed(f"fpath=({self.prefix}/share/zsh/site-functions $fpath); autoload -U compinit; compinit -u -D; begun")

    def tearDown(self):
        os.close(self.terminal)
        os.waitpid(self.child, 0)

    def typed(self, keys):
        """The arguments of the program that these keys and Return call."""
        if os.path.exists(self.said):
            os.remove(self.said)
        os.write(self.terminal, keys.encode() + b"\r")
        deadline, shown = time.monotonic() + 30 * SLOWNESS, b""
        while not os.path.exists(self.said):
            self.assertLess(time.monotonic(), deadline, f"{keys!r}: {shown.decode(errors='replace')}")
            if select.select([self.terminal], [], [], 0.01)[0]:
                shown += os.read(self.terminal, 4096)
        return text_of(self.said).split("|")[:-1]

    def test_options(self):
        for command in ([f"hermes-vector {name}" for name in COMMANDS] + DAEMONS + WINDOW):
            options = options_of(help_of(*command.split()))
            for option in options:
                keys = next((option[:n] for n in range(3, len(option)) if [o for o in options if o.startswith(option[:n])] == [option]),
                            option)
                with self.subTest(f"{command} {option}"):
                    self.assertEqual(self.typed(f"{command} {keys}\t"), [*command.split()[1:], option])

    def test_a_program_before_hermesctl(self):
        """The first completion of a shell reads the file, whatever the program."""
        self.assertEqual(self.typed("hermes-simulator --pri\t"), ["--print-settings"])

    def test_commands_values_and_files(self):
        for keys, said in (("hermes-vector rel\tscan\\ \t", ["relocalize", "scan of today.csv"]),
                           ("hermes-vector match --method fi\t", ["match", "--method", "finder"]),
                           ("hermes-vector match --method=fi\t", ["match", "--method=finder"]),
                           ("hermes-vector match --svg=sett\t", ["match", "--svg=settings.json"]),
                           ("hermes-vector ring --model vl\t--lase\t", ["ring", "--model", "vlp16", "--laser"]),
                           ("hermes-vector map-m\t--he\t", ["map-merge", "--help"]),
                           ("hermes-vector match --sigma sett\t", ["match", "--sigma", "sett"]),
                           *(EXPERIMENTS and (("hermes-vector experiment free-h\t", ["experiment", "free-home"]),
                                              ("hermes-vector experiment --out sca\t", ["experiment", "--out", "scans"]),
                                              ("hermes-vector report quad\t", ["report", "quadratic"])) or ())):
            with self.subTest(keys):
                self.assertEqual(self.typed(keys), said)


class Parsing(unittest.TestCase):
    def test_the_help_is_read_as_it_is_written(self):
        shown = ("  -h,--help                   Print\n  --out FILE  Write\n  --summary,--out FILE   --not\n"
                 "  --half 1|2:value in {1->1,2->2} OR {1,2}\n  --set PATH=VALUE   change\n  -v, --version   x\n"
                 "     --no-option  x\n  --how TEXT:{a,b}=a\n")
        self.assertEqual(options_of(shown), ["--help", "--out", "--summary", "--out", "--half", "--set", "--version", "--how"])
        self.assertEqual(choices_of(shown), {"--half": ["1", "2"], "--how": ["a", "b"]})


del Completion  # has no tests of its own
if __name__ == "__main__":
    unittest.main()
