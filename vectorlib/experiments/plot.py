#!/usr/bin/python3
"""Draws the figures that hermes-experiments leaves: of NAME-figures.json NAME-FIGURE.svg and .pdf beside it, for each figure that has
something to show. Needs matplotlib."""
import argparse
import json
import logging
import os
import re
import sys
import time

logging.getLogger("matplotlib").setLevel(logging.ERROR)  # no word of its caches
try:
    import matplotlib
    from matplotlib import ticker
    from matplotlib.figure import Figure
    import numpy
except ImportError:
    print("hermes-experiments: matplotlib is not installed (Debian: python3-matplotlib): the plots are not drawn", file=sys.stderr)
    sys.exit(0)
matplotlib.rcParams.update({"axes.grid": True, "axes.axisbelow": True, "grid.color": "#dddddd", "svg.fonttype": "none",
                            "svg.hashsalt": "hermes", "pgf.texsystem": "pdflatex", "pgf.rcfonts": False})
# Of each format what makes the same figures the same files.
FORMATS = {"svg": {"metadata": {"Date": None}}, "pdf": {"metadata": {"CreationDate": None}}, "pgf": {}}
MEANING = {ord("$"): r"\$"}  # what is not itself in matplotlib's texts; for pgf also what LaTeX takes for its own


def words(text):
    """Powers as such, and no other mathematics."""
    return re.sub(r"\^(-?\d+)", r"$^{\1}$", text.translate(MEANING))


def columns(points, logarithmic, is_band=False):
    """The coordinates of points, each list for itself. One that is not finite, or beyond all axes, is NaN and interrupts a line; one
    without a place on a logarithmic axis is left out, and interrupts a band."""
    whole = numpy.array(points, dtype=float).reshape(-1, len(logarithmic))
    whole[~(abs(whole) < 1e300).all(axis=1)] = numpy.nan
    nowhere = (whole[:, logarithmic] <= 0).any(axis=1)
    if is_band:
        whole[nowhere] = numpy.nan
        return whole.T
    return whole[~nowhere].T


def count_plainly(axis):
    """1, 2, 5 and 10 along a logarithmic axis."""
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(ticker.NullFormatter())


def axes_of(figure, given, **options):
    names = {f"{axis}label": words(given[f"{axis}Axis"]) for axis in "xyz" if f"{axis}Axis" in given}
    return figure.add_subplot(title=words(given["title"]), **names, **options)


def draw_plot(figure, given):
    log_x, log_y = given["xLogarithmic"], given["yLogarithmic"]
    axes = axes_of(figure, given, xscale="log" if log_x else "linear", yscale="log" if log_y else "linear")
    for axis in [axes.xaxis] * log_x + [axes.yaxis] * log_y:
        count_plainly(axis)
    style = {"linewidth": 1} if given["isDrawing"] else {"marker": "o", "markersize": 3}
    if given["isDrawing"]:
        axes.set_aspect("equal", adjustable="datalim")
    for curve in given["curves"]:
        band = [(x, low, high) for (x, _), (low, high) in zip(curve["points"], curve["band"])]
        if band:
            axes.fill_between(*columns(band, [log_x, log_y, log_y], True), color=curve["colour"], alpha=0.25, linewidth=0)
        axes.plot(*columns(curve["points"], [log_x, log_y]), color=curve["colour"], label=words(curve["label"]) or None, **style)
    return axes


def draw_surface(figure, given):
    axes = axes_of(figure, given, projection="3d")
    x, y = numpy.meshgrid(given["x"], given["y"])
    axes.plot_surface(x, y, numpy.array(given["z"], dtype=float).reshape(x.shape), color="white", edgecolor="#0072b2", linewidth=0.4, shade=False)
    return axes


def draw_space(figure, given):
    axes = axes_of(figure, given, projection="3d")
    for curve in given["curves"]:
        axes.plot(*columns(curve["points"], [False] * 3), color=curve["colour"], label=words(curve["label"]) or None)
    return axes


def points_of(kind, given):
    if kind == "surfaces":
        return columns([[z] for z in given["z"]], [False])
    logarithmic = [given["xLogarithmic"], given["yLogarithmic"]] if kind == "plots" else [False] * 3
    return numpy.hstack([columns(curve["points"], logarithmic) for curve in given["curves"]] or [[]])


def drawings(path):
    """Of each figure with something to show the path of its pictures without an end, its kind and what is given."""
    with open(path, encoding="utf-8") as file:
        figures = json.load(file)
    stem = re.sub(r"-figures\.json$", "", path)
    return [(f"{stem}-{given['name']}", kind, given) for kind in ("plots", "surfaces", "spaces") for given in figures[kind]
            if numpy.isfinite(points_of(kind, given)).any()]


def draw(stem, kind, given, formats):
    figure = Figure(figsize=(8, 6))
    axes = {"plots": draw_plot, "surfaces": draw_surface, "spaces": draw_space}[kind](figure, given)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=2, frameon=False)
    for name in formats:
        part = f"{stem}.{name}.part"
        try:
            figure.savefig(part, format=name, bbox_inches="tight", pad_inches=0.3, **FORMATS[name])
            os.replace(part, f"{stem}.{name}")
        except OSError as error:
            if os.path.isfile(part):
                os.remove(part)
            sys.exit(f"hermes-experiments: {stem}.{name} cannot be written: {error.strerror}")


def told(all_of_them, as_json):
    """The same, one after the other; tells how far that is as the programs do."""
    begun = last = time.monotonic()
    for done, one in enumerate(all_of_them, 1):
        yield one
        now, left = time.monotonic(), len(all_of_them) - done
        if as_json and (now > last + 0.5 or (left == 0 and last > begun)):
            last = now
            print(json.dumps({"progress": {"what": "drawing, figure", "done": done, "total": len(all_of_them), "elapsed_s": round(now - begun, 1),
                                           "left_s": round((now - begun) / done * left, 1)}}, separators=(",", ":")), file=sys.stderr)
        elif not as_json and sys.stderr.isatty():
            print(f"\rdrawing, figure {done} of {len(all_of_them)}" if left else "\r\033[K", end="", file=sys.stderr, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", nargs="+", metavar="NAME-figures.json")
    parser.add_argument("--force", action="store_true", help="overwrite pictures that exist")
    parser.add_argument("--json", action="store_true", help="tell the progress as JSON, one object a line, on standard error")
    parser.add_argument("--pgf", action="store_true", help="draw LaTeX instead, which the document takes rather than PDF; needs pdflatex")
    options = parser.parse_args()
    formats = ["pgf"] if options.pgf else ["svg", "pdf"]
    if options.pgf:
        MEANING.update({ord(sign): "\\" + sign for sign in "&#_"})
    wanted = [one for path in options.file for one in drawings(path)]
    for stem, _, _ in wanted:
        for name in formats:
            if os.path.exists(f"{stem}.{name}") and not options.force:
                sys.exit(f"hermes-experiments: {stem}.{name} exists; --force overwrites it")
    for one in told(wanted, options.json):
        draw(*one, formats)


if __name__ == "__main__":
    main()
