#!/usr/bin/env python3
"""The figures of the manual are those of the result files in docs/results, each table stands in one place, each result file has a
command that writes it, and what two commands measure is the same. With --today, a few results are also what hermes-vector prints now
(docs/results/make --check); those of logs only where the logs are."""
import importlib.machinery
import importlib.util
import os
import subprocess
import sys

import pages

FOLDER = os.path.join(pages.SOURCE, "docs", "results")
sys.path[:0] = [FOLDER, os.path.join(pages.SOURCE, "tests", "bench")]
import results  # noqa: E402

TODAY = ("accuracy", "overview", "report", "pairs", "localized")  # quick ones, with logs and without


def module_of(path):
    """A program as a module."""
    loader = importlib.machinery.SourceFileLoader(os.path.basename(path), path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def check_marks():
    """What the check itself finds in good and in bad pages."""
    good = {"r": {"measured": "Today.", "tables": {"t": [["log", "error, m"], ["a", "0.5 m"], ["b", "3 to 5 of 9"]]}}}
    page = "\n".join(["<!-- t -->", results.markdown(good["r"]["tables"]["t"]), "<!-- end of t -->", "0.5<!-- t; a; error, m --> and",
                      "from 3 to 5<!-- t; b; error, m -->", "<!-- measured r -->", "Today.", "<!-- end of measured r -->"])

    def wrong(text):
        shown = results.Shown(good)
        filled = shown.filled("page", text)
        return shown.complaints() + ["differs"] * (filled != text)

    assert not wrong(page), wrong(page)
    for old, new, expected in (("0.5<!--", "0.6<!--", "differs"), ("0.5 m", "0.7 m", "differs"), ("3 to 5<!--", "3 to 6<!--", "differs"),
                               ("Today.", "Yesterday.", "differs"), ("<!-- t; a;", "<!-- t; c;", "no result has"),
                               ("0.5<!--", "half<!--", "no number"),
                               ("t; b; error, m -->", "t; b;\nerror, m -->", "in one line"),
                               ("<!-- t -->", "<!-- u -->", "is shown in 0 places"), (page, page + "\n" + page, "is shown in 2 places")):
        found = wrong(page.replace(old, new))
        assert any(expected in w for w in found), (old, new, found)
    assert results.Shown(good).filled("page", page.replace("0.5<!--", "0.6<!--")) == page
    assert len(results.differences("r", {"t": [["a"], ["1"]]}, {"t": [["a"], ["2"], ["3"]]})) == 2


def check_times():
    """Times stay as they are, all else is new."""
    make = module_of(os.path.join(FOLDER, "make"))
    old = {"t": [["log", "error", "time, us"], ["a", "1", "5"], ["time of all", "9", "9"]]}
    new = {"t": [["log", "error", "time, us"], ["a", "2", "6"], ["time of all", "8", "8"]], "time-of-x": [["n", "10"], ["1", "3"]]}
    assert make.with_times_of(old, new) == {"t": [["log", "error", "time, us"], ["a", "2", "5"], ["time of all", "9", "9"]],
                                            "time-of-x": [["n", "10"], ["1", "3"]]}
    return make


def twice(found):
    """Shares that two programs measure, the benchmark `match` beside its rivals and the experiment `pairs`: where they differ."""
    shares = lambda table, near, nearer: {row[0]: (row[table[0].index(near)], row[table[0].index(nearer)]) for row in table[1:]}
    bench = shares(found["match"]["tables"]["match"], "10 cm, 2 deg", "5 cm, 2 deg")
    of_logs = {", no guess": shares(found["blind"]["tables"]["blind"], "within 10 cm, 2 degrees", "5 cm, 2 degrees"),
               "": shares(found["pairs"]["tables"]["pairs"], "within 10 cm, 2 degrees", "within 5 cm, 2 degrees")}
    for row, both in bench.items():
        log, method = row.replace(", consecutive", "").replace("first 1000", "first 1,000").split(": ")
        if method.startswith("vectorlib") and of_logs[method.removeprefix("vectorlib")][log] != both:
            yield f"match, {row}: {both}, but {of_logs[method.removeprefix('vectorlib')][log]} by docs/results/make"


def check_twice():
    table = [["log", "within 10 cm, 2 degrees", "5 cm, 2 degrees", "within 5 cm, 2 degrees"], ["intel", "97 %", "88 %", "88 %"]]
    found = {"blind": {"tables": {"blind": table}}, "pairs": {"tables": {"pairs": table}},
             "match": {"tables": {"match": [["", "10 cm, 2 deg", "5 cm, 2 deg"], ["intel, consecutive: vectorlib", "97 %", "88 %"],
                                            ["intel, consecutive: vectorlib, no guess", "97 %", "87 %"],
                                            ["intel, consecutive: MRPT", "1 %", "1 %"]]}}}
    assert len(list(twice(found))) == 1, list(twice(found))


def main():
    if "--today" in sys.argv:
        if not os.path.exists(os.path.join(os.environ["HERMES_BUILD"], "bin", "hermes-vector")):
            print("skipped: hermes-vector is not built")
            sys.exit(77)
        sys.exit(subprocess.run([os.path.join(FOLDER, "make"), "--check", *TODAY], check=False).returncode)
    check_marks()
    check_twice()
    found = results.read_all()
    known = set(check_times().RESULTS) | set(module_of(os.path.join(pages.SOURCE, "tests", "bench", "run")).BENCHMARKS)
    wrong = results.fill_pages(is_written=False) + [f"no command writes docs/results/{name}.json" for name in set(found) - known]
    wrong += twice(found)
    print("\n".join(wrong) or f"{len(found)} result files, all figures are as the pages show them")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
