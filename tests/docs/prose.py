#!/usr/bin/env python3
"""Fails on sentences of more than 30 words in the manual and in the help texts of the programs. What must be longer has a line in
prose_allowed.txt: the beginning of the sentence, a tab, the reason. Fails also where a page has more than 500 lines, or says wrongly how
many a file has."""
import glob
import os
import re
import subprocess
import sys

import pages

MOST_WORDS = 30
MOST_LINES = 500  # a page that grows past this is two pages, or too long
GENERATED = {"docs/protocol-reference.md"}  # of the programs' own texts, where tests/layout and the descriptions are judged
BINARIES = os.environ.get("HERMES_BIN", os.path.join(pages.SOURCE, "build", "release", "bin"))


def help_sentences(program):
    """The prose of `PROGRAM --help`; each option or command, begun by an indentation, stands alone."""
    text = subprocess.run([program, "--help"], capture_output=True, text=True, timeout=30, check=True,
                          env={**os.environ, "QT_QPA_PLATFORM": "offscreen", "COLUMNS": "10000"}).stdout
    for entry in re.split(r"\n(?= {0,3}\S)|\n\n", text):
        words = re.sub(r"\s+", " ", re.sub(r"^ *\S.*?  +", "", entry))
        for sentence in re.split(r"(?<=[.!?:;]) (?=[A-Z])", words):
            yield 0, sentence


def miscounts(page, text):
    """Where the page has too many lines, or says "in N lines" behind a link to a file, or to a page whose longest block that is, and is
    wrong. "About" may be off by a fifth."""
    if page not in GENERATED and text.count("\n") > MOST_LINES:
        yield f"{page}: {text.count(chr(10))} lines, at most {MOST_LINES} are permitted"
    for link, kind, said in re.findall(r"\]\(([^)#:]+)\)(?:(?!\]\(|\.\s).){0,80}?\b((?:about|less\sthan)\s)?([\d,]+)\slines", text, re.S):
        path = os.path.normpath(os.path.join(os.path.dirname(page), link))
        if path.endswith(".md"):
            count = max(block.text.count("\n") for block in pages.blocks(path))
        else:
            count = pages.read(path).count("\n")
        said = int(said.replace(",", ""))
        if not (0.8 * count < said < 1.2 * count if kind[:1] == "a" else count < said if kind else count == said):
            yield f"{page}: {link} has {count} lines, not {kind}{said}"


def allowed():
    with open(os.path.join(os.path.dirname(__file__), "prose_allowed.txt"), encoding="utf-8") as file:
        return dict(line.rstrip("\n").split("\t", 1) for line in file if line.strip())


def main():
    reasons, used = allowed(), set()
    wanted = sys.argv[1:] or pages.names()
    texts = {page: pages.sentences(page) for page in wanted if page not in GENERATED}
    if not sys.argv[1:]:
        texts.update({os.path.basename(p): list(help_sentences(p)) for p in sorted(glob.glob(os.path.join(BINARIES, "hermes*")))})
    if all(len(s.split()) <= 5 for found in texts.values() for _, s in found):
        sys.exit("the check itself finds no sentences")
    if len(list(miscounts("README.md", "[a](LICENSE), in 3\nlines, [b](LICENSE) in about 21 lines. Then 5 lines" + MOST_LINES * "\n"))) != 2:
        sys.exit("the check itself counts no lines")
    count = wrong = 0
    for page in wanted:
        for complaint in miscounts(page, pages.read(page)):
            wrong += 1
            print(complaint)
    for page, found in texts.items():
        for line, sentence in found:
            count += 1
            if len(sentence.split()) <= MOST_WORDS:
                continue
            reason = next((start for start in reasons if sentence.startswith(start)), None)
            if reason:
                used.add(reason)
            else:
                wrong += 1
                print(f"{page}:{line}: {len(sentence.split())} words: {sentence}")
    if not sys.argv[1:]:
        for start in reasons.keys() - used:
            wrong += 1
            print(f"prose_allowed.txt: no such sentence any more: {start}")
    print(f"{count} sentences in {len(texts)} texts, {len(used)} longer than {MOST_WORDS} words with a reason, {wrong} without")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
