#!/usr/bin/env python3
"""Fails when a test of this build is not of exactly one tier (CONTRIBUTING.md), has a mark that there is not, or is marked `exact` without
being a unit test; when a tier has no test; and when a list in a CMakeLists.txt names what is no test, or two name one test."""
import collections
import glob
import json
import os
import re
import subprocess
import sys

ROOT, BUILD = os.environ["HERMES_SOURCE"], os.environ["HERMES_BUILD"]
TIERS, MARKS = {"unit", "system", "window", "timing", "docs", "fuzz", "bench"}, {"long", "exact"}


def labels_of_tests():
    told = subprocess.run(["ctest", "--test-dir", BUILD, "--show-only=json-v1"], check=True, stdout=subprocess.PIPE).stdout
    return {test["name"]: [label for property in test.get("properties", []) if property["name"] == "LABELS" for label in property["value"]]
            for test in json.loads(told)["tests"]}


def complaints(labels):
    wrong = []
    for name, own in sorted(labels.items()):
        tiers = [label for label in own if label in TIERS]
        if len(tiers) != 1:
            wrong.append(f"{name} is of {len(tiers)} tiers: {' '.join(tiers)}")
        wrong += [f"{name} has the label {label}" for label in own if label not in TIERS | MARKS]
        if "exact" in own and tiers != ["unit"]:
            wrong.append(f"{name} is exact and no unit test")
    return wrong


def listed():
    """(list, folder/name) of what the lists in CMakeLists.txt name."""
    for path in glob.glob(os.path.join(ROOT, "tests", "**", "CMakeLists.txt"), recursive=True):
        folder = os.path.relpath(os.path.dirname(path), os.path.join(ROOT, "tests"))
        with open(path, encoding="utf-8") as file:
            for tier, names in re.findall(r"^set\(tests_of_(\w+) ([^)]*)\)", file.read(), re.M):
                yield from ((tier, f"{folder}/{name}") for name in names.split())


def main():
    broken = {"a/None": [], "a/Two": ["unit", "docs"], "a/Other": ["unit", "slow"], "a/Exact": ["system", "exact"], "a/Good": ["unit", "exact"]}
    assert len(complaints(broken)) == 4, complaints(broken)
    labels = labels_of_tests()
    wrong = complaints(labels)
    with open(os.path.join(BUILD, "CMakeCache.txt"), encoding="utf-8") as file:
        has_all = "CMAKE_BUILD_TYPE:STRING=Release" in file.read()  # others leave tests out
    lists = list(listed())
    assert len(lists) > 50, lists
    wrong += [f"tests_of_{tier} names {name}, which is no test" for tier, name in lists
              if tier not in TIERS | MARKS or has_all and name not in labels]
    named = collections.Counter(name for tier, name in lists if tier in TIERS)
    wrong += [f"{name} is in the lists of {count} tiers" for name, count in named.items() if count > 1]
    counts = collections.Counter(label for own in labels.values() for label in own)
    wrong += [f"no test is {label}" for label in sorted(TIERS | MARKS) if has_all and not counts[label]]
    print("\n".join(wrong) or ", ".join(f"{counts[label]} {label}" for label in sorted(TIERS | MARKS)))
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
