"""What the tables of several benchmarks are made with."""
import math


def markdown(header, rows):
    """A Markdown table whose columns are aligned, so that it reads well in a terminal too."""
    width = [max(len(r[c]) for r in [header, *rows]) for c in range(len(header))]
    line = lambda r: "| " + " | ".join(x.ljust(w) if i == 0 else x.rjust(w) for i, (x, w) in enumerate(zip(r, width))) + " |"
    rule = "|" + "|".join("-" * (w + 2) if i == 0 else "-" * (w + 1) + ":" for i, w in enumerate(width)) + "|"
    return "\n".join([line(header), rule, *map(line, rows)])


def slope(points):
    """Of log y over log x of the points (x, y), by least squares: 1 where y grows with x, 2 where it grows with its square."""
    x, y = [math.log(p) for p, _ in points], [math.log(q) for _, q in points]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((p - mx) * (q - my) for p, q in zip(x, y)) / sum((p - mx) ** 2 for p in x)


def verdict(is_good):
    return "reached" if is_good else "missed"
