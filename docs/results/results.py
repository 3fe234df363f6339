"""Result files, and the pages that show them.

A result file, docs/results/NAME.json, has tables: lists of rows of cells, as they are shown; the first row is the header. Pages show

| in the page | what stands there |
|---|---|
| `<!-- TABLE -->` to `<!-- end of TABLE -->` | the table |
| `<!-- measured NAME -->` to `<!-- end of measured NAME -->` | when and where the times of this result were measured |
| `3.5<!-- TABLE; ROW; COLUMN -->` | the first number of one cell, or its first "3 to 5": the row that begins with ROW, the column of this heading |
"""
import glob
import json
import os
import re

SOURCE = os.environ.get("HERMES_SOURCE") or os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
FOLDER = os.path.join(SOURCE, "docs", "results")
NUMBER = re.compile(r"[-+]?\d[\d,]*(?:\.\d+)?(?: to [-+]?\d[\d,]*(?:\.\d+)?)?")  # or from one to another
BLOCK = re.compile(r"^<!-- ([^;:\n]+?) -->\n(.*?)^<!-- end of \1 -->$", re.M | re.S)
FIGURE = re.compile(r"(" + NUMBER.pattern + r")?<!-- ([^;\n]+?); ([^;\n]*?); ([^;\n]+?) -->")


def path_of(name):
    return os.path.join(FOLDER, name + ".json")


def read(name):
    """One result: its commands, its tables and, where it has times, when and where they were measured."""
    with open(path_of(name), encoding="utf-8") as file:
        return json.load(file)


def write(name, result):
    """With one line for each row, so that a change of a figure is a change of one line."""
    tables = ",\n".join(f"  {json.dumps(table, ensure_ascii=False)}: [\n" +
                        ",\n".join("   " + json.dumps(row, ensure_ascii=False) for row in rows) + "\n  ]"
                        for table, rows in result["tables"].items())
    head = "".join(f' "{key}": {json.dumps(value, ensure_ascii=False)},\n' for key, value in result.items() if key != "tables")
    with open(path_of(name), "w", encoding="utf-8", newline="\n") as file:
        file.write(f'{{\n{head} "tables": {{\n{tables}\n }}\n}}\n')


def read_all():
    return {os.path.basename(path)[:-5]: read(os.path.basename(path)[:-5]) for path in sorted(glob.glob(os.path.join(FOLDER, "*.json")))}


def pages():
    return [os.path.join(SOURCE, "README.md"), *sorted(glob.glob(os.path.join(SOURCE, "docs", "*.md")))]


def markdown(rows):
    """A Markdown table whose columns are aligned, so that it reads well in a terminal too."""
    header, *body = rows
    width = [max(3, *(len(r[c]) for r in rows)) for c in range(len(header))]
    line = lambda r: "| " + " | ".join(x.ljust(w) if i == 0 else x.rjust(w) for i, (x, w) in enumerate(zip(r, width))) + " |"
    rule = "|" + "|".join("-" * (w + 2) if i == 0 else "-" * (w + 1) + ":" for i, w in enumerate(width)) + "|"
    return "\n".join([line(header), rule, *map(line, body)])


def differences(name, old, new):
    """What differs between two sets of tables, as texts."""
    found = []
    for table in dict.fromkeys([*old, *new]):
        rows = [tables.get(table, []) for tables in (old, new)]
        for r in range(max(map(len, rows))):
            was, now = (of[r] if r < len(of) else None for of in rows)
            if was != now:
                found.append(f"{name}, {table}: has\n  {was}\nthe program prints\n  {now}")
    return found


class Shown:
    """What pages may show of these results, and what is wrong with the marks that were asked for."""

    def __init__(self, results):
        self.blocks, self.tables, self.wrong, self.used = {}, {}, [], []
        for name, result in results.items():
            for table, rows in result["tables"].items():
                if table in self.tables:
                    self.wrong.append(f"two results have a table {table}")
                self.tables[table] = rows
                self.blocks[table] = markdown(rows)
            if "measured" in result:
                self.blocks[f"measured {name}"] = result["measured"]

    def block(self, page, mark):
        """The page's text between the marks, or what stands there where no result has it."""
        if mark[1] not in self.blocks:
            self.wrong.append(f"{page}: no result has {mark[1]}")
            return mark[0]
        self.used.append(mark[1])
        return f"<!-- {mark[1]} -->\n{self.blocks[mark[1]]}\n<!-- end of {mark[1]} -->"

    def figure(self, page, mark):
        """The same of one figure in the text."""
        shown, table, row, column = mark.groups()
        header, *rows = self.tables.get(table, [[]])
        found = [r for r in rows if r[0] == row]
        number = NUMBER.search(found[0][header.index(column)]) if len(found) == 1 and column in header else None
        if shown is None or not number:
            self.wrong.append(f"{page}: {'no number stands before' if shown is None else 'no result has'} {table}; {row}; {column}")
            return mark[0]
        return number[0] + mark[0][len(shown):]

    def filled(self, page, text):
        text = BLOCK.sub(lambda mark: self.block(page, mark), text)
        broken = len(re.findall(r"<!--[^>;]*;[^>;]*;[^>]*-->", text)) - len(FIGURE.findall(text))
        if broken:
            self.wrong.append(f"{page}: {broken} marks of figures are not `<!-- TABLE; ROW; COLUMN -->` in one line")
        return FIGURE.sub(lambda mark: self.figure(page, mark), text)

    def complaints(self):
        """What is wrong once all pages are filled: each table stands in one place, so that no two pages differ."""
        counts = {name: self.used.count(name) for name in self.blocks}
        return self.wrong + [f"{name} is shown in {count} places, not in one" for name, count in counts.items()
                             if count == 0 or count > 1 and name in self.tables]


def fill_pages(is_written):
    """Puts the results into the pages. Complaints: figures that differ (where nothing is written), and marks that are wrong."""
    shown = Shown(read_all())
    for path in pages():
        page = os.path.relpath(path, SOURCE)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        filled = shown.filled(page, text)
        if filled != text and is_written:
            with open(path, "w", encoding="utf-8", newline="\n") as file:
                file.write(filled)
        elif filled != text:
            old, new = text.split("\n"), filled.split("\n")
            line = next((i for i, (a, b) in enumerate(zip(old, new)) if a != b), min(len(old), len(new)))
            shown.wrong.append(f"{page}:{line + 1}: has\n  {old[line]}\nthe results have\n  {new[line]}")
    return shown.complaints()
