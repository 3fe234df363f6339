#!/usr/bin/env python3
"""Fails when sources of a target cannot be compiled together in another grouping: when two of them give one name to two things.

CMake compiles the sources of a target in groups, in the order of its list. Which ones meet depends on how many there are. So all of a
target that has several groups are compiled as one here, without making an object. A target with one group shows it when it is built.

With HERMES_ALONE each source is compiled alone: it fails when one lacks an include that its neighbour in the group has."""
import concurrent.futures
import glob
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = os.environ.get("HERMES_SOURCE") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
BUILD = os.environ.get("HERMES_BUILD") or os.path.join(ROOT, "build", "release")
SKIPPED = 77


def targets(compiled, names):
    """Of each target: the files of its groups that have such names. Some that are not compiled any more may lie in the folder too."""
    found = {}
    for group in sorted(glob.glob(os.path.join(glob.escape(BUILD), "**", "Unity", f"unity_{names}_cxx.cxx"), recursive=True)):
        if (path := os.path.realpath(group)) in compiled:
            found.setdefault(os.path.dirname(path), []).append(path)
    return list(found.values())


def sources_of(group):
    with open(group, encoding="utf-8") as file:
        return re.findall(r'#include "(.*)"', file.read())


def without_object(command):
    """The words of a compiler's command, but for what it compiles and writes."""
    words = shlex.split(command)
    for option in ("-o", "-c"):
        at = words.index(option)
        del words[at:at + 2]
    return words + ["-fsyntax-only"]


def complaint(words, folder, text):
    """What the compiler says of the text, or None."""
    with tempfile.NamedTemporaryFile("w", suffix=".cpp", encoding="utf-8") as unit:
        unit.write(text)
        unit.flush()
        done = subprocess.run([*words, unit.name], cwd=folder, env={**os.environ, "CCACHE_DISABLE": "1"}, capture_output=True,
                              text=True, check=False)
    return None if done.returncode == 0 else done.stderr


def together(commands):
    """What is wrong, and the number of sources. Groups with names of their own always stay as they are."""
    errors, count = [], 0
    for groups in targets(commands, "[0-9]*"):
        if len(groups) == 1:
            continue
        entry = commands[groups[0]]
        words, folder = without_object(entry["command"]), entry["directory"]
        if count == 0 and not complaint(words, folder, "namespace { const int twice = 1; }\nnamespace { const int twice = 2; }\n"):
            errors.append("not caught: a name that two sources have")
        sources = [source for group in groups for source in sources_of(group)]
        count += len(sources)
        if why := complaint(words, folder, "".join(f'#include "{source}"\n' for source in sources)):
            errors.append(f"sources of {os.path.basename(os.path.dirname(os.path.dirname(groups[0])))[:-4]} do not go together:\n{why}")
    return errors, count


def alone(commands):
    """What is wrong, and the number of sources."""
    def try_it(group, source):
        entry = commands[group]
        return complaint(without_object(entry["command"]), entry["directory"], f'#include "{source}"\n')
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        tries = {source: pool.submit(try_it, group, source)
                 for groups in targets(commands, "*") for group in groups for source in sources_of(group)}
        errors = [f"{source} does not compile alone:\n{why}" for source, one in tries.items() if (why := one.result())]
    return errors, len(tries)


def main():
    with open(os.path.join(BUILD, "compile_commands.json"), encoding="utf-8") as file:
        commands = {os.path.realpath(entry["file"]): entry for entry in json.load(file)}
    errors, count = alone(commands) if "HERMES_ALONE" in os.environ else together(commands)
    if count == 0:
        print("no target is compiled in several groups: CMAKE_UNITY_BUILD is off")
        return SKIPPED
    print("\n".join(errors) or f"{count} sources compile {'alone' if 'HERMES_ALONE' in os.environ else 'together, in any grouping'}")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
