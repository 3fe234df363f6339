#!/usr/bin/env python3
"""The pages of the tuned figures and the code say the same: each row names constants of its file, with their values, and each numeric
constexpr of those folders has a row, or is left out here for a reason."""
import collections
import math
import os
import re
import sys

import pages

PAGES = {"docs/constants-matching.md": ("vectorlib/include", "vectorlib/src", "daemons/scanmatcher"),
         "docs/constants-motors.md": ("daemons/motorcontrol",)}
PREFIXES = ("vectorlib/include/vectorlib/", "vectorlib/src/", "daemons/")
HEADER = ["constant", "value", "where", "what it is, and what changes with it", "how it was found"]
# File as the pages name it (any, where it is empty), pattern of names, and why no page has them.
LEFT_OUT = (
    ("geometry/Angle.h", "pi", "exact"),
    ("", r"rounding\w*", "only bounds errors of rounding"),
    ("geometry/PackedPoints.h", "least", "only bounds errors of rounding"),
    ("observation/Observer.h", "leastTurn", "only bounds errors of rounding"),
    ("similarity/CriterionMinimizer.cpp", "flat|small", "only bounds errors of rounding"),
    ("graph/PoseGraph.cpp", "fixed|loose", "only keeps equations solvable"),
    ("relations/MatchingTable.h", "unit", "steps of numbers that are kept as integers"),
    ("segmentation/PolarScan.h", "turn|direction", "steps of numbers that are kept as integers"),
    ("places/PlaceSearch.cpp", "most", "follows from farthestSlide and slideStep"),
    ("observation/Observer.h", "unseen", "marks what is not there"),
    ("places/WallTiles.h", "unknown|none", "marks what is not there"),
    ("mapping/GlobalPairMatcher.h", "allPoints", "more than a scan has"),
    ("registration/ScanIndex.h", "far", "farther than any point"),
    ("io/Pgm.h", r"\w+Cell", "of the format of map_server"),
    ("io/Tum.cpp", "columns", "of the format"),
    ("scanmatcher/JournalBlock.h", "version|cbor", "of the format"),
    ("io/Svg.h", r"\w+", "how a picture looks"),
    ("io/LatexPicture.h", r"\w+", "how a picture looks"),
    ("segmentation/Nearness.h", "bits", "of a word"),
    ("segmentation/PolarScan.h", "spare", "room for SIMD"),
    ("vectorization/SumTable.h", "margin", "room for SIMD"),
    ("correspondence/Votes.h", "block", "width of SIMD"),
    ("vectorization/BlockSearchAvx2.h", "lanes", "width of SIMD"),
    ("places/PlaceIndex.h", "lengthBins", "size of an index"),
    ("relations/RelationSet.h", "most|distanceBins", "size of an index"),
    ("motorcontrol/DeviceModels.h", "controllerCount", "how many there are"),
    ("motorcontrol/MotorController.h", "taskCount", "how many there are"),
    ("motorcontrol/LatchFile.cpp", r"longest\w+", "lengths of texts"),
)
NUMBER = r"(?:std::)?(?:double|float|int|unsigned char|q?u?int(?:8|16|32|64)(?:_t)?|size_t|ptrdiff_t)"
NUMERIC = rf"{NUMBER}|std::chrono::\w+|std::array<{NUMBER}, *\w+>"
VARIABLE = rf"({NUMERIC}|[\w:<>, ]+?(?: ?\*)?)\s*\b(?=\w+\s*(?:\[\w*\])?\s*[={{(])"
NO_FIGURES = {"bool", "char", "char32_t"}
UNITS = {"std::chrono::milliseconds": "ms", "std::chrono::seconds": "s", "_rad_per_m": "rad/m", "_radps": "rad/s", "_mps": "m/s",
         "_rad": "rad", "_m": "m", "_s": "s", "_Hz": "Hz", "_v": "V"}  # of a type, or of the end of a name
SCALES = {"pi": math.pi, "degrees": math.pi / 180, "MiB": 2 ** 20, "million": 1e6, "h": 3600}
Constant = collections.namedtuple("Constant", "file name values unit")


def bare(text):
    """C++ without its comments, texts, and the marks within numbers."""
    text = re.sub(r"'(?:\\.|[^'\\\n])'", "0", text)
    text = re.sub(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', " ", text, flags=re.DOTALL)
    return re.sub(r"(?<=\d)'(?=\d)", "", text)


def split(text):
    """At the commas that are in no brackets."""
    parts, depth = [""], 0
    for c in text:
        depth += (c in "([{") - (c in ")]}")
        if c == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    return [part.strip() for part in parts if part.strip()]


def numbers(initializer, known):
    """What an initializer gives; known: the values of names. Raises ValueError where that are no numbers."""
    text = re.sub(r"std::size_t(?=\()", "", initializer.strip())
    text = re.sub(r"(?<![\w.])(\d[\d.]*(?:[eE][-+]?\d+)?)[fFuUlL]*\b", r"\1", text)
    if text.startswith("{"):
        return tuple(v for part in split(text[1:-1]) for v in numbers(part, known))
    try:
        return (float(eval(text, {"__builtins__": {}, "pi": math.pi}, known)),)  # pylint: disable=eval-used
    except Exception as error:
        raise ValueError(initializer) from error


def declared(text):
    """(type, name, initializer) of each constexpr variable."""
    for found in re.finditer(r"(?<!if )\bconstexpr\s+([^;]*)", bare(text)):
        kind = re.match(VARIABLE, found[1])
        if not kind or re.match(r"\w+\s*\(\s*(?:\)|\w+ \w)", found[1][kind.end():]):
            continue  # a function or a constructor
        for part in split(found[1][kind.end():]):
            name, value = re.match(r"(\w+)\s*(?:\[\w*\])?\s*=?\s*(.*)", part, re.DOTALL).groups()
            yield kind[1], name, value


def constants_of(file, text, known):
    """The constants of a file that have a figure of their own: by another one alone none is chosen. Adds to the values of names; values
    is None where they cannot be told. Raises ValueError for a number of a type that is not known here."""
    for kind, name, initializer in declared(text):
        try:
            values = numbers(re.sub(r"^\((.*)\)$", r"\1", initializer, flags=re.DOTALL), known)
        except ValueError:
            values = None
        if not re.fullmatch(NUMERIC, kind):
            if values and len(values) == 1 and kind not in NO_FIGURES:
                raise ValueError(f"{file}: {name} is a number of a type that this test does not know: {kind}")
            continue
        if values and len(values) == 1:
            known[name] = values[0]
        if re.search(r"(?<![\w.])\d", initializer):
            end = next((end for end in UNITS if name.endswith(end)), None)
            yield Constant(file, name, values, UNITS.get(kind) or UNITS.get(end))


def figures(cell):
    """(value, unit) of each figure of a cell, as of "0.3 m, 2 degrees"."""
    for figure in re.split(r",\s+", cell):
        parts = re.fullmatch(r"(-?[\d,]*\.?\d+(?:e-?\d+)?|2\^\d+)((?: [^\s,]+)*)", figure)
        if not parts:
            raise ValueError(f"{figure!r} is no figure with its unit")
        value = 2.0 ** int(parts[1][2:]) if "^" in parts[1] else float(parts[1].replace(",", ""))
        units = parts[2].split()
        for unit in units:
            value *= SCALES.get(unit, 1)
        yield value, " ".join({"h": "s", "degrees": "rad"}.get(unit, unit) for unit in units if unit != "pi")


def rows(text):
    """(line, cells) of the tables of a page."""
    for number, line in enumerate(text.split("\n"), 1):
        if line.startswith("|") and not re.fullmatch(r"[|\s:-]+", line):
            yield number, [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]


def told_by(text):
    """What the rows of a page tell: (line, file, names, figures). Raises ValueError for a row that is not of the form."""
    for line, cells in rows(text):
        if cells == HEADER:
            continue
        if len(cells) != len(HEADER) or not all(cells):
            raise ValueError(f"line {line}: found {len(cells)} cells, expected {len(HEADER)}, none of them empty")
        try:
            yield line, cells[2].strip("`"), re.findall(r"`(\w+)`", cells[0]), list(figures(cells[1]))
        except ValueError as error:
            raise ValueError(f"line {line}: {error}") from error


def complaints(page, text, code):
    """What is wrong with a page; code: the constants that it has to tell of."""
    rest = list(code)
    for line, file, names, told in told_by(text):
        for name in names:
            found = next((c for c in rest if (c.file, c.name) == (file, name)), None)
            if not found:
                yield f"{page}:{line}: {file} has no constexpr {name} that has to be told here"
                told = told[1:]
                continue
            rest.remove(found)
            own = found.values or ()
            mine, told = told[:len(own)], told[len(own):]
            is_same = len(mine) == len(own) > 0 and all(math.isclose(a, b) for (a, _), b in zip(mine, own))
            if not is_same:
                yield f"{page}:{line}: {name} is {found.values} in {file}, the page tells {[v for v, _ in mine]}"
            elif found.unit and any(unit.split()[:1] != [found.unit] for _, unit in mine):
                yield f"{page}:{line}: {name} is in {found.unit}, the page tells {[unit for _, unit in mine]}"
        if told:
            yield f"{page}:{line}: {len(told)} more figures than names"
    for constant in rest:
        yield f"{page}: no row tells of {constant.name} in {constant.file}, which is {constant.values}: add it, or leave it out in {__file__}"


def short(path):
    """A file as the pages name it."""
    return next(path[len(prefix):] for prefix in PREFIXES if path.startswith(prefix))


def code_of(folders):
    """All constants of the files in some folders, those of a header before those of its source."""
    paths = [os.path.relpath(os.path.join(root, name), pages.SOURCE) for folder in folders
             for root, _, names in os.walk(os.path.join(pages.SOURCE, folder)) for name in names if name.endswith((".h", ".cpp"))]
    known = collections.defaultdict(dict)
    for path in sorted(paths, key=lambda p: (p.endswith(".cpp"), p)):
        yield from constants_of(short(path), pages.read(path), known[os.path.splitext(short(path))[0]])


def kept(constants, used):
    """Without those that are left out; adds the reasons that count to used."""
    for constant in constants:
        by = next((row for row in LEFT_OUT if row[0] in ("", constant.file) and re.fullmatch(row[1], constant.name)), None)
        if by:
            used.add(by)
        else:
            yield constant


def check_itself():
    """What the check finds in good and bad pages, for code that it has to read."""
    code = """// constexpr int no = 1;
    static constexpr double leap_m = 0.1, turn = pi / 90; // constexpr int no = 2;
    constexpr std::chrono::milliseconds pause(500), rest{250};
    constexpr std::array<float, 2> spread{1, 2.5F};
    static constexpr std::size_t few = std::size_t(1) << 4,
                                 more = 3 * few;
    constexpr int same = few; constexpr const char *text = "constexpr int no = 3;"; constexpr bool is = few > 1;
    constexpr qint64 largest = 1'000; static constexpr std::size_t stride() { return 1; }
    constexpr explicit Vector(const Other &other) { if constexpr (few > 1) } constexpr Vector(double x, double y);"""
    table = ["a page", "", "|" + "|".join(HEADER) + "|", "|---|---|---|---|---|",
             "| `leap_m`, `turn` | 0.1 m, 2 degrees | `a/A.h` | w | h |", "| `pause`, `rest` | 500 ms, 250 ms | `a/A.h` | w | h |",
             "| `spread` | 1, 2.5 | `a/A.h` | w | h |", "| `few`, `more` | 2^4 points, 48 | `a/A.h` | w | h |",
             "| `largest` | 1,000 | `a/A.h` | w | h |"]
    found = list(constants_of("a/A.h", code, {}))
    assert [c.name for c in found] == ["leap_m", "turn", "pause", "rest", "spread", "few", "more", "largest"], found

    def wrong(page, constants=tuple(found)):
        return list(complaints("page", "\n".join(page), constants))

    assert not wrong(table), wrong(table)
    for old, new in (("0.1 m", "0.2 m"), ("0.1 m", "0.1 rad"), ("2 degrees", "2"), ("250 ms", "250 s"), ("1, 2.5", "1, 2.6"), ("1,000", "1,000, 2"),
                     ("`few`, ", ""), ("`largest`", "`gone`"), ("a/A.h` | w | h |", "a/B.h` | w | h |")):
        assert wrong([line.replace(old, new) for line in table]), (old, new)
    assert len(wrong(table[:-1])) == 1 and len(wrong(table, found[:-1])) == 1
    for bad in (lambda: wrong(["| `few` | 16 | `a/A.h` | w | |"]), lambda: wrong(["| `few` | some | `a/A.h` | w | h |"]),
                lambda: list(constants_of("a/A.h", "constexpr Metres far = 3;", {}))):
        try:
            bad()
        except ValueError:
            continue
        raise AssertionError("a row or a type that cannot be read is no fault")


def main():
    check_itself()
    wrong, used, count = [], set(), 0
    for page, folders in PAGES.items():
        try:
            constants = list(kept(code_of(folders), used))
            count += len(constants)
            wrong += complaints(page, pages.read(page), constants)
        except ValueError as error:
            wrong.append(f"{page}: {error}")
    wrong = wrong or [f"{__file__}: {file} has no constexpr {name} that would have to be left out ({reason})"
                      for file, name, reason in LEFT_OUT if (file, name, reason) not in used]
    print("\n".join(wrong) or f"{count} constants, all on their page with their value")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
