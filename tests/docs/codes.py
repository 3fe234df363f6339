#!/usr/bin/env python3
"""Every error code that a program can send stands in the table of docs/protocol.md, and nothing else does."""
import os
import re
import sys

from pages import SOURCE

FOLDERS = ("common", "daemons", "deploy", "docs/examples", "gui", "protocol")
SUFFIXES = (".cpp", ".h", ".in", ".py", ".sh")
CODE = re.compile(r"(?<![\w.])-32(?:[06]\d\d|700)\b")


def codes_of(text):
    return set(CODE.findall(text))


def sources():
    for folder in FOLDERS:
        for root, _, names in os.walk(os.path.join(SOURCE, folder)):
            yield from (os.path.join(root, name) for name in names if name.endswith(SUFFIXES))


def main():
    assert codes_of("Refusal(-32008, x) { A = -32700, } 'x-32001' 1e-32600") == {"-32008", "-32700"}
    with open(os.path.join(SOURCE, "docs", "protocol.md"), encoding="utf-8") as page:
        table = set(re.findall(r"^\| (-32\d\d\d) \|", page.read(), re.MULTILINE))
    used = {}
    for path in sources():
        with open(path, encoding="utf-8") as file:
            for code in codes_of(file.read()):
                used.setdefault(code, os.path.relpath(path, SOURCE))
    with open(os.path.join(SOURCE, "protocol", "jsonrpc", "RpcError.h"), encoding="utf-8") as file:
        declared = codes_of(file.read())
    assert len(declared) > 10, declared
    faults = [f"{path}: {code} is not in the table of docs/protocol.md" for code, path in used.items() if code not in table]
    faults += [f"docs/protocol.md: no program knows {code}" for code in table - declared]
    print("\n".join(sorted(faults)) or f"{len(table)} codes, all in the table")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
