#!/usr/bin/env python3
"""Runs the code blocks of the manual as they are printed, each page in a folder and a network of its own:
blocks.py PAGE... (docs/hermesctl.md), without one the blocks of all pages are counted and those that are not run listed.

| language | what is done |
|---|---|
| sh | run by one bash for the whole page, in order; each command must succeed |
| console | lines after "$ " are run as sh; the output must have the other lines: numbers may differ, "..." stands for anything |
| python | run with docs/examples on PYTHONPATH |
| cpp | compiled with vectorlib of the build and run |
| json | must be JSON, one value or one a line |
| text, cmake, ini | shown only, unless a mark says more |

Marks above a block, as HTML comments:

| mark | meaning |
|---|---|
| not run: REASON | only shown |
| only in a fresh Debian: REASON | only shown here; tests/docs/fresh.py runs it |
| file: NAME | written to the file NAME in the folder of the page, not run |
| until: TEXT | programs that go on: in the background until the end of the page; the next block is run when TEXT is printed |
| for: SECONDS | each command is interrupted as by Ctrl-C after these seconds at the latest |
| fails | the last command must fail |
| output | what the block before prints, compared as that of console; of a program in C++ the numbers, too |
| part of: FILE | the lines stand in this file of the project, in this order |

tests/docs/before/PAGE.sh, when there is one, runs first: it makes the files and starts the daemons that the page takes for granted.
The folder has the project's own files, and build/release/bin is that of the tests and stands first on the PATH."""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile

import pages

BUILD = os.environ.get("HERMES_BUILD", os.path.join(pages.SOURCE, "build", "release"))
SHOWN = {"text", "cmake", "ini"}
FRESH = "only in a fresh Debian"
RUN = {"sh", "console", "python", "cpp", "json"}
ISOLATED = ["unshare", "--net", "--pid", "--fork", "--kill-child", "--mount-proc"] + ([] if os.geteuid() == 0 else ["--map-root-user"])
PRELUDE = """
set -u
export FOLDER=$PWD
background() {  # TEXT FILE: runs FILE until TEXT is printed, and lets it go on
    bash -e "$2" >"$2.out" 2>&1 &
    for _ in $(seq 600); do
        grep -qF -- "$1" "$2.out" && return 0
        kill -0 $! 2>/dev/null || { echo "ended before it printed \\"$1\\":"; cat "$2.out"; return 1; }
        sleep 0.1
    done
    echo "did not print \\"$1\\" within 60 s:"; cat "$2.out"; return 1
}
"""


def is_run(block):
    """Whether the page's script runs or writes it."""
    if block.marks.keys() & {"not run", "part of"}:
        return False
    return bool(block.marks.keys() & {"file", "output"}) or block.language in RUN - {"json"}


def is_json(text):
    """Whether this is JSON, or one value in each line."""
    for parts in ([text], text.strip().split("\n")):
        try:
            for part in parts:
                json.loads(part)
            return True
        except ValueError:
            pass
    return False


def judge(block):
    """A complaint about a block that needs no run, or None."""
    if block.language not in SHOWN | RUN:
        return f"language {block.language} is none of {', '.join(sorted(SHOWN | RUN))}"
    if any(len(block.marks[mark]) < 8 for mark in ("not run", FRESH) if mark in block.marks):
        return "a block that is not run needs a reason"
    if block.language == "json" and "not run" not in block.marks and not is_json(block.text):
        return "is no JSON, nor is each of its lines"
    if "part of" in block.marks:
        rest = iter(pages.read(block.marks["part of"]).split("\n"))
        for line in filter(str.strip, block.text.split("\n")):
            if line.strip() != "..." and not any(line.strip() == other.strip() for other in rest):
                return f"{block.marks['part of']} has no line {line.strip()!r} (in this order)"
    return None


def commands(console):
    """(command, output) of each command of a console block."""
    found = []
    for line in console.split("\n")[:-1]:
        if line.startswith("$ ") or found and found[-1][0].endswith("\\") and not found[-1][1]:
            if line.startswith("$ "):
                found.append([line[2:], ""])
            else:
                found[-1][0] += "\n" + line
        elif found:
            found[-1][1] += line + "\n"
    return found


def is_like(printed, actual, numbers=False):
    """Whether the actual output has the printed lines, in order, and anything where they say "...". numbers: whether they must agree."""
    def words(text):
        text = re.sub(r"\s+", " ", text).strip()
        return text if numbers else re.sub(r"-?\d+(\.\d+)?([eE][-+]?\d+)?", "#", text)
    pattern = ".*".join(re.escape(words(part)).replace(r"\ ", " ") for part in printed.split("..."))
    return re.search(pattern, words(actual), re.S) is not None


class Script:
    """The bash script of blocks, and what must be seen of each. It is run in the folder, whatever that is called there."""

    def __init__(self, folder):
        self.folder, self.text, self.outputs = folder, PRELUDE, []

    def write(self, name, text):
        """The path of the file in the script."""
        path = os.path.join(self.folder, name)
        if not os.path.realpath(os.path.dirname(path)).startswith(os.path.realpath(self.folder)) or os.path.islink(path):
            sys.exit(f"{name}: is the project's own, a block is not written there")
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return f'"$FOLDER/{name}"'

    def add_all(self, blocks):
        for number, block in enumerate(blocks):
            if "output" in block.marks and (number == 0 or blocks[number - 1].marks.keys() & {"file", "output"}):
                sys.exit(f"{block}: is the output of no block that is run")
            following = blocks[number + 1] if number + 1 < len(blocks) else None
            self.add(block, number, following if following and "output" in following.marks else None)

    def add(self, block, number, shown):
        """shown: the block that has the output of this one, or None."""
        if "output" in block.marks:
            return
        if "file" in block.marks:
            self.write(block.marks["file"], block.text)
            return
        self.text += f"echo '@@ {block}'\n"
        output = None
        if shown:
            output = f'"$FOLDER/.blocks/{number}.out"'
            self.outputs.append((shown, f"the block of line {block.line} in {block.language}", shown.text, os.path.join(self.folder, f".blocks/{number}.out")))
        if block.language == "python":
            self.shell(block, number, "python3 " + self.write(f".blocks/{number}.py", block.text), output)
        elif block.language == "cpp":
            source = self.write(f".blocks/{number}.cpp", block.text)
            self.shell(block, number, f"g++ -std=c++17 -Wall -Wextra -Werror -O1 -Ivectorlib/include $(pkg-config --cflags eigen3) "
                                      f"{source} build/release/vectorlib/libvectorlib.a -o .blocks/{number}.run\n.blocks/{number}.run", output)
        elif block.language == "console":
            for index, (command, output) in enumerate(commands(block.text)):
                name = f".blocks/{number}-{index}"
                self.shell(block, f"{number}-{index}", command, f'"$FOLDER/{name}.out"')
                self.outputs.append((block, command, output, os.path.join(self.folder, name + ".out")))
        elif block.language == "sh":
            self.shell(block, number, block.text, output)

    def shell(self, block, number, text, output=None):
        path = self.write(f".blocks/{number}.sh", text)
        if "until" in block.marks:
            self.text += f"background {quoted(block.marks['until'])} {path} || exit 1\n"
            return
        if "for" in block.marks:
            for index, line in enumerate(re.split(r"(?<!\\)\n", text.strip())):
                if line.strip() and not line.strip().startswith("#"):
                    one = self.write(f".blocks/{number}-{index}.one.sh", line + "\n")
                    self.text += (f"timeout -s INT {block.marks['for']} bash -e {one}; code=$?\n"
                                  f"[ $code = 0 ] || [ $code = 124 ] || {{ echo exit $code:; cat {one}; exit 1; }}\n")
            return
        redirect = f" >{output} 2>&1" if output else ""
        if "fails" in block.marks:
            self.text += f"set +e\n. {path}{redirect}\n[ $? != 0 ] || {{ echo 'did not fail'; exit 1; }}\n"
        else:
            self.text += f"set -e\n. {path}{redirect}\nset +e\n"

    def end(self):
        """Writes the script; its path in the folder."""
        self.write(".blocks/page.sh", self.text + "echo '@@ end'\n")
        return ".blocks/page.sh"

    def complaint(self, title, output):
        """What was wrong when the script printed this output, or None."""
        last = output.rfind("@@ ")
        if not output[last:].startswith("@@ end"):
            return f"{title}: failed in the block after this line:\n{output[last:][:6000]}"
        for block, command, printed, path in self.outputs:
            with open(path, encoding="utf-8", errors="replace") as file:
                actual = file.read()
            if not is_like(printed, actual, numbers=block.language == "text" and command.endswith("in cpp")):
                return f"{block}: {command}\n--- the page says\n{printed}--- it prints\n{actual[:6000]}"
        return None


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def prepare(folder):
    """The files of the project, so that what the page names is there."""
    for name in os.listdir(pages.SOURCE):
        if name not in ("build", ".git", "recordings"):
            os.symlink(os.path.join(pages.SOURCE, name), os.path.join(folder, name))
    os.makedirs(os.path.join(folder, "build"))
    os.symlink(BUILD, os.path.join(folder, "build", "release"))
    os.makedirs(os.path.join(folder, ".home"))


def run(page):
    """The number of blocks that were run. Exits with what was wrong."""
    found = pages.blocks(page)
    complaints = [f"{block}: {wrong}" for block in found for wrong in [judge(block)] if wrong]
    if complaints:
        sys.exit("\n".join(complaints))
    to_run = [block for block in found if is_run(block) and FRESH not in block.marks]
    if not to_run:
        print(f"{page}: nothing to run in {len(found)} blocks")
        return 0
    with tempfile.TemporaryDirectory(prefix="manual-") as folder:
        prepare(folder)
        script = Script(folder)
        before = os.path.join(os.path.dirname(__file__), "before", os.path.basename(page)[:-3] + ".sh")
        if os.path.exists(before):
            script.text += f"echo '@@ {os.path.basename(before)}'\nset -e\n. {before}\nset +e\n"
        script.add_all(to_run)
        path = script.end()
        environment = {**os.environ, "HOME": os.path.join(folder, ".home"), "XDG_RUNTIME_DIR": os.path.join(folder, ".home"),
                       "PATH": f"{BUILD}/bin:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
                       "PYTHONPATH": os.path.join(pages.SOURCE, "docs", "examples"), "QT_QPA_PLATFORM": "offscreen"}
        for name in ("XDG_STATE_HOME", "XDG_CONFIG_HOME", "HERMES_KEYS"):
            environment.pop(name, None)
        for name in ("HERMES_BIN", "HERMES_BUILD", "HERMES_SOURCE"):
            environment.setdefault(name, {"HERMES_BIN": f"{BUILD}/bin", "HERMES_BUILD": BUILD, "HERMES_SOURCE": pages.SOURCE}[name])
        # A network of its own: the default ports of the daemons are free there. Locks of serial lines of its own: they name
        # processes by number.  When bash ends, all that it started does.
        child = subprocess.Popen([*ISOLATED, "sh", "-c", f"mount -t tmpfs none /run/lock; ip link set lo up; exec bash {path}"], cwd=folder, env=environment, text=True,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
        try:
            output, _ = child.communicate(timeout=280)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            output, _ = child.communicate()
            output += "\ntook longer than 280 s\n"
        if os.environ.get("HERMES_SHOW"):
            print(output)
        complaint = script.complaint(page, output)
        if complaint:
            sys.exit(complaint)
    shown = len(found) - len(to_run)
    print(f"{page}: {len(to_run)} of {len(found)} blocks run, {shown} only shown")
    return len(to_run)


def count():
    total = shown = fresh = 0
    for page in pages.names():
        for block in pages.blocks(page):
            total += 1
            wrong, reason = judge(block), block.marks.get("not run")
            if wrong:
                sys.exit(f"{block}: {wrong}")
            fresh += FRESH in block.marks
            if reason:
                shown += 1
                print(f"{block}: not run: {reason}")
    print(f"{total} blocks in {len(pages.names())} pages, {shown} not run, {fresh} run only by tests/docs/fresh.py")


def check_itself():
    assert is_like("a: 1.5, ... c\n", "x\na: -7e3, b, c\n") and not is_like("a 1 b", "a b") and not is_like("abc", "abd")
    assert is_like("a 1 ...", "a 1 b", numbers=True) and not is_like("a 1", "a 2", numbers=True)
    assert commands("$ a \\\n b\nout\n$ c\n") == [["a \\\n b", "out\n"], ["c", ""]]


def main():
    check_itself()
    if not sys.argv[1:]:
        return count()
    if not shutil.which("ip") or subprocess.run([*ISOLATED, "true"], stderr=subprocess.DEVNULL, check=False).returncode:
        print("no network of its own may be made here")
        sys.exit(77)
    for page in sys.argv[1:]:
        run(page)
    return None


if __name__ == "__main__":
    main()
