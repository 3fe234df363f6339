#!/usr/bin/env python3
"""tests/bench/run tells how far it is and how long the rest may take, is quick when asked, and gives medians."""
import json
import os
import re
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
from measure import Progress, clock, medians  # noqa: E402


class Terminal:
    """Collects what is written, as a terminal or not."""

    def __init__(self, is_one):
        self.text, self.is_one = "", is_one

    def isatty(self):
        return self.is_one

    def write(self, text):
        self.text += text

    def flush(self):
        pass


def told(is_terminal, passed, done, total):
    """What is shown when this much was done after that many seconds."""
    stream = Terminal(is_terminal)
    progress = Progress("name", total, stream)
    progress.begin -= passed
    progress.tell(done)
    return stream.text


def check(got, wanted):
    assert got == wanted, f"{got!r} instead of {wanted!r}"


def check_progress():
    check(told(False, 30, 0, 40), "name: 0 of 40, 30 s\n")
    check(told(False, 30, 10, 40), "name: 10 of 40, 30 s, about 90 s left\n")
    check(told(True, 300, 20, 40), "\rname: 20 of 40, 5 min, about 5 min left\033[K")
    check(told(True, 30, 40, 40), "\rname: 40 of 40, 30 s, about 0 s left\033[K\n")
    stream = Terminal(False)
    progress = Progress("name", 3, stream)
    progress.tell(0)
    progress.tell(1)  # no ten seconds later
    progress.tell(3)  # the end is told in any case, and once
    progress.tell(3)
    check(stream.text.count("\n"), 2)
    check(clock(99), "99 s")


def check_json():
    Progress.is_json = True
    try:
        lines = [json.loads(text)["progress"] for text in (told(True, 30, 0, 40), told(False, 30, 10, 40), told(False, 30, 40, 40))]
    finally:
        Progress.is_json = False
    check([p["left_s"] for p in lines], [None, 90, 0])
    check(lines[1], {"what": "name", "done": 10, "total": 40, "elapsed_s": 30, "left_s": 90})


def check_medians():
    run = lambda name, family, ns, lines: {"family_index": family, "per_family_instance_index": 0, "run_name": name,
                                           "time_unit": "us", "cpu_time": ns, "lines": lines}
    rows = medians({"benchmarks": [run("second/a b/2000", 1, 9, 1), run("first/7/8", 0, 4, 5), run("first/7/8", 0, 1, 1),
                                   run("first/7/8", 0, 2, 9), run("second/a b/2000", 1, 7, 1)]})
    check([(r.name, r.arguments, r.ns, r.counters["lines"]) for r in rows],
          [("first", ("7", "8"), 2000, 5), ("second/a b", ("2000",), 8000, 1)])


def run(*arguments):
    return subprocess.run([os.path.join(HERE, "run"), *arguments], capture_output=True, text=True, timeout=250, check=False)


def check_quick_run():
    begin = time.monotonic()
    shown = run("segment", "--quick")
    assert shown.returncode == 0, shown.stderr
    assert "| ftls" in shown.stdout, shown.stdout
    assert re.search(r"^segment: 0 of \d+, ", shown.stderr, re.MULTILINE), shown.stderr
    assert re.search(r"^segment: (\d+) of \1, \d+ s, about 0 s left$", shown.stderr, re.MULTILINE), shown.stderr
    print(f"segment --quick took {time.monotonic() - begin:.1f} s\n{shown.stderr}")


def check_json_run():
    shown = run("segment", "--quick", "--json")
    assert shown.returncode == 0, shown.stderr
    lines = [json.loads(line)["progress"] for line in shown.stderr.splitlines()]
    done = [p["done"] for p in lines]
    check(done, sorted(done))
    check(len({p["total"] for p in lines}), 1)
    check((lines[-1]["done"], lines[-1]["left_s"]), (lines[-1]["total"], 0))
    assert len(lines) <= 2 * lines[-1]["elapsed_s"] + 2, lines


def check_bad_options():
    for arguments, wanted in ((("segment", "--quick", "--write"), "not written"), (("segment", "--repetitions"), "a number"),
                              (("segment", "--repetitions", "0"), "a number"), (("unknown",), "there are")):
        shown = run(*arguments)
        assert shown.returncode == 2 and wanted in shown.stderr, (arguments, shown)


if __name__ == "__main__":
    check_progress()
    check_json()
    check_medians()
    check_bad_options()
    if not os.path.exists(os.path.join(os.environ["HERMES_BUILD"], "tests", "bench", "bench_segment")):
        print("skipped: Google Benchmark is not installed")
        sys.exit(77)
    check_quick_run()
    check_json_run()
