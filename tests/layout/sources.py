#!/usr/bin/env python3
"""Fails when docs/sources.md names a file, an experiment, an option of reports or a picture that is not there, or a table that
docs/pictures/make-sources has not filled."""
import os
import re
import sys

ROOT = os.environ.get("HERMES_SOURCE") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def complaints(page, experiments, exists):
    """What is wrong with the page; exists tells whether there is a file."""
    wrong = []
    for code in re.findall(r"`([^`\n]+)`", page):
        for path in re.findall(r"[\w./-]+/[\w.-]+\.(?:h|cpp|py|json)\b|^[\w./-]+/$", code):
            if not exists(path) and not exists("vectorlib/include/vectorlib/" + path):
                wrong.append(f"no file {path}")
        named = re.match(r"experiment ([\w-]+)", code)
        if named and named[1] not in experiments:
            wrong.append(f"no experiment {named[1]}")
    for link in re.findall(r"\]\(([^)#]+)[^)]*\)", page):
        if not exists("docs/" + link):
            wrong.append(f"no file docs/{link}")
    for name, table in re.findall(r"<!-- ([\w-]+) -->\n(.*?)<!-- end of \1 -->", page, re.S):
        if "|---" not in table:
            wrong.append(f"the table {name} is empty: docs/pictures/make-sources LOGS {name}")
    return wrong


def main():
    experiments = set(re.findall(r'^    \{"([\w-]+)",', read("gui/vector/ExperimentCommand.cpp"), re.M))
    page = read("docs/sources.md")
    broken = "`a/None.h` `experiment none` [x](pictures/none.png)\n<!-- t -->\n<!-- end of t -->"
    if len(complaints(broken, experiments, lambda path: False)) != 4:
        sys.exit("the check itself finds nothing")
    wrong = complaints(page, experiments, lambda path: os.path.exists(os.path.join(ROOT, path)))
    print("\n".join("docs/sources.md: " + w for w in wrong) or f"{len(experiments)} experiments, all that docs/sources.md names is there")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
