#!/usr/bin/env python3
"""What bash and zsh make of the scripts of `hermesctl completion`, with a daemon that runs: the keys of a person, and what stands
in the command line then."""
import os
import pty
import re
import select
import shutil
import socket
import subprocess
import tempfile
import time
import unittest

from ctl_support import BUILD, PROGRAM, SOURCE, MadeUpDaemon, ThermometerCase, ctl

BEGIN_ZSH = "autoload -U compinit; compinit -u; "
# How each is started, and what makes it complete: the script that is printed, or the file that is installed.
SHELLS = {"bash": (["bash", "--norc", "--noprofile", "-i"], f"source <({PROGRAM} completion bash)"),
          "zsh": (["zsh", "-f", "-i"], f"{BEGIN_ZSH}source <({PROGRAM} completion zsh)"),
          "zsh, installed": (["zsh", "-f", "-i"], f"fpath=({SOURCE}/deploy/completion $fpath); {BEGIN_ZSH}true")}


def candidates(line):
    shown = ctl("complete", "hermesctl " + line)
    assert (shown.returncode, shown.stderr) == (0, ""), shown
    return [one.split("\t")[0] for one in shown.stdout.splitlines()]


def own_address():
    """By which others reach this computer; where it is alone, loopback."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # sends nothing
            return probe.getsockname()[0]
        except OSError:
            return "127.0.0.1"


class Shell:
    """A shell at a terminal. `hermesctl` in it writes its arguments down, but for the questions of the script."""

    def __init__(self, name, folder):
        command, first = SHELLS[name]
        self.file = os.path.join(folder, "said")
        wrapper = os.path.join(folder, "hermesctl")
        with open(wrapper, "w", encoding="utf-8") as script:
            script.write(f'#!/bin/sh\n[ "$1" = complete ] && exec "{PROGRAM}" "$@"\nprintf "%s\\n" "$*" >"{self.file}.new"\n'
                         f'mv "{self.file}.new" "{self.file}"\n')
        os.chmod(wrapper, 0o755)
        self.child, self.terminal = pty.fork()
        if self.child == 0:
            os.environ.update(PATH=f"{folder}:{BUILD}/bin:{os.environ['PATH']}", HOME=folder, TERM="dumb", PS1="$ ")
            os.execvp(command[0], command)
        # Only a shell that has read the script writes this down.
        self.said(first + "; hermesctl begun")

    def said(self, keys):
        """What hermesctl was called with after these keys and Return."""
        if os.path.exists(self.file):
            os.remove(self.file)
        os.write(self.terminal, keys.encode() + b"\r")
        deadline = time.monotonic() + 30
        shown = b""
        while not os.path.exists(self.file):
            assert time.monotonic() < deadline, f"{keys!r}: {shown.decode(errors='replace')}"
            if select.select([self.terminal], [], [], 0.05)[0]:
                shown += os.read(self.terminal, 4096)
        with open(self.file, encoding="utf-8") as file:
            return re.sub(" +", " ", file.read().strip())

    def end(self):
        os.close(self.terminal)
        os.waitpid(self.child, 0)


class Completion(ThermometerCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        cls.addClassCleanup(folder.cleanup)
        os.environ.update(XDG_CACHE_HOME=os.path.join(folder.name, "cache"), HERMES_KEYS=os.path.join(folder.name, "keys"))
        super().setUpClass()

    def test_candidates(self):
        self.assertEqual(candidates("re"), ["record", "replay"])
        self.assertEqual(candidates("record st"), ["start", "stop", "status"])
        self.assertEqual(candidates("call scanm"), ["scanmatcher"])
        self.assertIn("127.0.0.1:7450", candidates("call 127"))
        self.assertIn("10.0.0.7:7450", candidates("--host 10.0.0.7 call 10"))
        self.assertIn("thermometer.read", candidates(f"call {self.address} "))
        self.assertEqual(candidates(f"call {self.address} thermometer.calibrate settle_ms=1 "), ["offset_k="])
        self.assertEqual(candidates(f"call {self.address} thermometer.read unit="), ["unit=C", "unit=K"])
        self.assertEqual(candidates(f"call {self.address} settings.get changes="), ["changes=true", "changes=false"])
        self.assertIn("limits.clients", candidates(f"get {self.address} lim"))
        self.assertIn("limits.clients=", candidates(f"set {self.address} lim"))
        self.assertEqual(candidates(f"watch --rate 5 {self.address} temp"), ["temperature"])
        self.assertEqual(candidates(f"watch {self.address} x --c"), ["--count", "--csv"])
        self.assertEqual(candidates("completion "), ["bash", "zsh"])
        self.assertEqual(candidates("watch --rate "), [])
        self.assertEqual(candidates("drive motorcontrol vx=1 "), ["vy=", "omega="])
        self.assertEqual(candidates("setup --l"), ["--list"])
        self.assertEqual(candidates("conform "), ["motor", "scanner"])
        self.assertEqual(candidates("conform motor motorc"), ["motorcontrol"])
        self.assertEqual(candidates("conform scanner scanner --base motorc"), ["motorcontrol"])
        self.assertEqual(candidates("conform scanner scanner --b"), ["--base"])
        self.assertEqual(candidates("simulate --base vesc --kinematics a"), ["ackermann"])
        self.assertEqual(candidates("simulate --kinematics a"), [])
        self.assertEqual(candidates("drive motorcontrol --f"), ["--force", "--for"])
        self.assertEqual(candidates("record start --daemons supervisor,scanm"), ["supervisor,scanmatcher"])

    def test_hosts(self):
        """Those of earlier connections, the last one first, and robots that keys were issued for."""
        self.assertEqual(candidates("list --host "), [])
        here = own_address()
        with socket.create_server(("0.0.0.0", 0)) as somebody:
            for host in ("127.0.0.1", here):
                ctl("call", f"{host}:{somebody.getsockname()[1]}", "daemon.info", "--timeout", "0.2")
        self.assertEqual(candidates("list --host "), [] if here.startswith("127.") else [here])
        self.assertEqual(ctl("keys", "init").returncode, 0)
        for name, role in (("rover", "daemon"), ("anna", "operator")):
            self.assertEqual(ctl("keys", "issue", name, "--role", role).returncode, 0)
        self.assertEqual(candidates("list --host r"), ["rover"])
        self.assertEqual(candidates("list --host=r"), ["--host=rover"])
        self.assertEqual(candidates("list --host a"), [])

    def test_names_are_words(self):
        """Whoever has chosen a name: it does not become a command of the shell, nor a command to the terminal."""
        names = ["run1;cd;touch pwned", "$(touch pwned)", "`x`", "a|b&c", "it's \"so\"", "über", "esc\x1b[2J", "line\nbreak", "\u202eevil"]
        daemon = MadeUpDaemon({"topics.list": [{"name": name, "summary": "s\x1b[2J", "schema": {}} for name in names]})
        self.addCleanup(daemon.stop)
        self.assertEqual(candidates(f"watch {daemon.address} "),
                         [r"run1\;cd\;touch\ pwned", r"\$\(touch\ pwned\)", r"\`x\`", r"a\|b\&c", r"it\'s\ \"so\"", "über"])
        self.assertNotIn("\x1b", ctl("complete", f"hermesctl watch {daemon.address} ").stdout)
        for name in SHELLS:
            if shutil.which(SHELLS[name][0][0]):
                with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                    shell = Shell(name, folder)
                    self.assertEqual(shell.said(f"cd {folder}; hermesctl watch {daemon.address} run\t"),
                                     f"watch {daemon.address} run1;cd;touch pwned")
                    shell.end()
                    self.assertFalse(os.path.exists(os.path.join(folder, "pwned")))

    def test_silent_without_a_daemon(self):
        begun = time.monotonic()
        self.assertEqual(candidates("call 127.0.0.1:1 "), [])
        self.assertEqual(candidates("call nobody "), [])
        self.assertLess(time.monotonic() - begun, 10)

    def test_comp_words(self):
        """As bash calls the function: words cut at "=" and ":"."""
        line = f"hermesctl call {self.address} thermometer.read unit="
        words = line.replace(":", " : ").replace("=", " =").split()
        script = (f'PATH={BUILD}/bin:$PATH; source <(hermesctl completion bash); COMP_WORDS=({" ".join(words)}); '
                  f'COMP_CWORD={len(words) - 1}; COMP_LINE="{line}"; COMP_POINT={len(line)}; '
                  '_hermesctl hermesctl "" =; printf "%s|" "${COMPREPLY[@]}"')
        self.assertEqual(subprocess.run(["bash", "-c", script], capture_output=True, text=True, timeout=30).stdout, "C |K |")

    def test_shells(self):
        hosts = os.path.join(os.environ["XDG_CACHE_HOME"], "hermes", "hosts")
        os.makedirs(os.path.dirname(hosts), exist_ok=True)
        with open(hosts, "w", encoding="utf-8") as file:
            file.write("192.0.2.200\n10.0.0.7")
        for name in SHELLS:
            if not shutil.which(SHELLS[name][0][0]):
                print(f"skipped: {name} is not installed")
                continue
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                shell = Shell(name, folder)
                try:
                    for keys, said in ((f"hermesctl cal\t{self.address} thermometer.re\tun\tK", f"call {self.address} thermometer.read unit=K"),
                                       (f"hermesctl wat\t{self.address} tempe\t--cs\t", f"watch {self.address} temperature --csv"),
                                       (f"hermesctl set {self.address} limits.cl\t7", f"set {self.address} limits.clients=7"),
                                       ("hermesctl get 127.0.0.1:745\t", "get 127.0.0.1:7450"),
                                       ("hermesctl list --host 192.0.2.2\t", "list --host 192.0.2.200")):
                        self.assertEqual(shell.said(keys), said)
                finally:
                    shell.end()


if __name__ == "__main__":
    unittest.main()
