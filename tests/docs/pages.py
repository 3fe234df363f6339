"""The pages of the manual as tests read them: their code blocks with the marks before them, and their sentences."""
import glob
import os
import re

SOURCE = os.environ.get("HERMES_SOURCE", os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..")))
MARKS = {"not run", "file", "until", "for", "fails", "part of", "output", "only in a fresh Debian"}


def names():
    """All pages, as paths from the root of the project."""
    pages = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"] + sorted(glob.glob("docs/*.md", root_dir=SOURCE))
    return [page for page in pages if os.path.exists(os.path.join(SOURCE, page))]


def read(page):
    with open(os.path.join(SOURCE, page), encoding="utf-8") as file:
        return file.read()


class Block:
    """A fenced block: its language, its text, its line in the page, and its marks: HTML comments <!-- mark: value --> above it."""

    def __init__(self, page, line, language, text, marks):
        self.page, self.line, self.language, self.text, self.marks = page, line, language, text, marks

    def __str__(self):
        return f"{self.page}:{self.line}"


def blocks(page):
    """The blocks of a page in order. Raises ValueError where one is not fenced, has no language, is not closed or has an unknown mark."""
    found, marks, opened, fence = [], {}, None, ""
    is_blank, is_list = True, False
    for number, line in enumerate(read(page).split("\n"), 1):
        if opened:
            if line.strip() == fence:
                found.append(opened)
                opened, marks = None, {}
            else:
                opened.text += line[opened.indent:] + "\n"
            continue
        mark = re.fullmatch(r"\s*<!-- ([A-Za-z ]+?)(?:: (.*))? -->", line)
        fenced = re.fullmatch(r"( *)(```+)(\w*)", line)
        if fenced:
            if not fenced[3]:
                raise ValueError(f"{page}:{number}: a block without a language")
            opened, fence = Block(page, number, fenced[3], "", marks), fenced[2]
            opened.indent = len(fenced[1])
        elif mark and mark[1] in MARKS:
            marks[mark[1]] = mark[2] or ""
        elif line.startswith("    ") and line.strip() and is_blank and not is_list:
            raise ValueError(f"{page}:{number}: a block that is not fenced")
        elif line.strip():
            if marks:
                raise ValueError(f"{page}:{number}: marks {', '.join(marks)} without a block below")
            is_list = bool(re.match(r"\s*([*-]|\d+\.) ", line)) or is_list and line.startswith(" ")
        is_blank = not line.strip()
    if opened:
        raise ValueError(f"{opened}: the block is not closed")
    return found


def sentences(page):
    """(line, sentence) of all prose of a page: paragraphs, list items and cells of tables; code in the text counts as one word,
    a comment (which names the result that a figure is of) as none."""
    found, paragraph, start, fence = [], [], 0, ""

    def flush():
        text = " ".join(paragraph)
        text = re.sub(r"<!--.*?-->", "", re.sub(r"`[^`]*`", "CODE", text))
        text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
        found.extend((start, sentence) for sentence in re.split(r"(?<=[.!?:;])\s+(?=[A-Z\"(*_0-9])|(?<=[.!?][)\"])\s", text) if sentence.strip())
        paragraph.clear()

    for number, line in enumerate(read(page).split("\n"), 1):
        fenced = re.match(r" *(```+)", line)
        if fence or fenced:
            flush()
            fence = "" if fence and line.strip() == fence else fence or fenced[1]
        elif not line.strip() or line.startswith("#") or line.lstrip().startswith("<!--"):
            flush()
        elif line.lstrip().startswith("|"):
            flush()
            for cell in re.split(r"(?<!\\)\|", line.strip().strip("|")):
                start = number
                paragraph.append(cell.strip())
                flush()
        else:
            if re.match(r"\s*([*-]|\d+\.)\s", line):
                flush()
            if not paragraph:
                start = number
            paragraph.append(line.strip())
    flush()
    return found
