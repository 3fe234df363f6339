#!/usr/bin/env python3
"""Fails when docs/sources.md or docs/sources-papers.md names what is not there: a file, a header without its folder, an experiment or
an option that it does not take, another command of hermes-vector or an option that no source declares (of `report`: that its own
source does not), a test, a picture, a place of a page, or an erratum that the table does not have; or when a table that
docs/results/make fills is empty or has an exponent. Which figures stand there tests/docs/figures.py checks. The commands of
docs/pictures/make-sources are checked alike."""
import os
import re
import sys

ROOT = os.environ.get("HERMES_SOURCE") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
HEADERS = "vectorlib/include/vectorlib"
ALWAYS = {"--out", "--force", "--help", "--json"}  # what every experiment takes
OPTION = r"(?<![\w-])--[a-z][\w-]*"


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def files_below(folder, end):
    """Paths from the root of all files of a folder with this end."""
    found = []
    for where, _, names in os.walk(os.path.join(ROOT, folder)):
        found += [os.path.relpath(os.path.join(where, name), ROOT).replace(os.sep, "/") for name in names if name.endswith(end)]
    return found


def experiments_of(source):
    """Of each experiment the options it takes, from the table in ExperimentCommand.cpp."""
    constants = {name: set(re.findall(OPTION, text)) for name, text in re.findall(r'const char \*(\w+) = "([^"]*)"', source)}
    table = re.search(r"^constexpr Experiment experiments\[\] = \{(.*?)\};", source, re.M | re.S)[1]
    found = {}
    for name, takes in re.findall(r'\{"([\w-]+)",.*?&ExperimentCommand::[\w<>:]+,\s*("[^"]*"|\w+)', table, re.S):
        found[name] = constants.get(takes, set(re.findall(OPTION, takes)))
    return found


class Known:
    """What there is to be named."""

    def __init__(self):
        self.experiments = experiments_of(read("vectorlib/experiments/ExperimentCommand.cpp"))
        self.reports = set(re.findall(r'"(--[\w-]+)"', read("vectorlib/experiments/report/ReportCommand.cpp")))
        sources = "".join(read(path) for folder in ("gui/vector", "vectorlib/experiments") for path in files_below(folder, ".cpp"))
        self.options = set(re.findall(OPTION, sources))
        self.commands = set(re.findall(r'(?:add_subcommand\(|addCommand<\w+>\(\s*app,)\s*"([\w-]+)"', sources))
        self.headers = {os.path.basename(path) for path in files_below(HEADERS, ".h")}
        self.tests = set()
        for path in files_below("tests", ".cpp"):
            text = read(path)
            functions = re.findall(r"^(?:    void |void Test\w+::)(\w+)\(", text, re.M)
            self.tests.update(f"{name}::{function}" for name in re.findall(r"^class (Test\w+)", text, re.M) for function in functions)

    def exists(self, path):
        return os.path.exists(os.path.join(ROOT, path))

    def anchors(self, path):
        """The places of a page, as GitHub makes them from its headings."""
        return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
                for heading in re.findall(r"^#+ (.*)$", read(path), re.M)}


def of_command(code, known):
    """What is wrong with a command of hermes-vector."""
    options = set(re.findall(OPTION, code)) - ALWAYS
    named = re.match(r"experiment ([\w-]+)", code)
    if named:
        if named[1] not in known.experiments:
            return [f"no experiment {named[1]}"]
        return [f"experiment {named[1]} takes no {option}" for option in sorted(options - known.experiments[named[1]])]
    if code.startswith("report "):
        return [f"report takes no {option}" for option in sorted(options - known.reports)]
    if re.match(r"[a-z]+ ", code) and options and not re.match(r"(ctest|hermesctl|docs/)", code):
        command = code.split()[0]
        return [] if command in known.commands and options <= known.options else [f"no command {code}"]
    if re.fullmatch(r"--[a-z][\w-]*(?: \S+)?", code) and not options - ALWAYS <= known.options:
        return [f"no option {code}"]
    return []


def of_table(page):
    """Tables that are filled; errata that are cited and have no row."""
    wrong = []
    for name, table in re.findall(r"<!-- ([\w-]+) -->\n(.*?)<!-- end of \1 -->", page, re.S):
        if "|---" not in table:
            wrong.append(f"the table {name} is empty: docs/results/make LOGS")
        if re.search(r"\d[eE][+-]?\d", table):
            wrong.append(f"the table {name} has a number with an exponent")
    errata = read("docs/sources.md").partition("\n## Errata\n")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| (\d+) \|", errata, re.M)
    if rows != [str(i + 1) for i in range(len(rows))]:
        wrong.append("the errata are not numbered from 1 on")
    for cited in re.findall(r"\b(?:erratum|errata) (\d+(?:, \d+)*)", page):
        wrong += [f"no erratum {number}" for number in cited.split(", ") if number not in rows]
    return wrong


def complaints(page, known, name="sources.md"):
    """What is wrong with the text of the page of this name."""
    wrong = of_table(page)
    for code in re.findall(r"`([^`\n]+)`", page):
        for path in re.findall(r"[\w./-]+/[\w.-]+\.(?:h|cpp|py|json)\b|^[\w./-]+/$", code):
            if not known.exists(path) and not known.exists(f"{HEADERS}/{path}"):
                wrong.append(f"no file {path}")
        if re.fullmatch(r"\w+\.h", code) and code not in known.headers:
            wrong.append(f"no header {code}")
        if re.fullmatch(r"Test\w+::\w+", code) and code not in known.tests:
            wrong.append(f"no test {code}")
        wrong += of_command(code, known)
    for link, place in re.findall(r"\]\(([^)#]*)#?([^)]*)\)", page):
        path = "docs/" + (link or name)
        if not known.exists(path):
            wrong.append(f"no file {path}")
        elif place and place not in known.anchors(path):
            wrong.append(f"no place {place} in {path}")
    return wrong


def main():
    known = Known()
    broken = ("`a/None.h` `None.h` `experiment none` `experiment edges --log X` `report pillars --al-combinations` `vectorize A --nonsense` "
              "`--all-combination` `TestTls::nothing` erratum 99 [x](pictures/none.png) [y](#nowhere)\n"
              "<!-- t -->\n<!-- end of t -->\n<!-- u -->\n|---|\n| 4e+02 |\n<!-- end of u -->")
    found = complaints(broken, known)
    if len(found) != 13:
        sys.exit(f"the check itself finds {len(found)} of 13 faults: {found}")
    wrong = [f"docs/{name}: {w}" for name in ("sources.md", "sources-papers.md") for w in complaints(read("docs/" + name), known, name)]
    for code in re.findall(r'"((?:experiment|report) [^"]*)"', read("docs/pictures/make-sources")):
        wrong += [f"docs/pictures/make-sources: {w}" for w in of_command(code, known)]
    print("\n".join(wrong) or f"{len(known.experiments)} experiments, all that docs/sources.md and docs/sources-papers.md name is there")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
