#!/usr/bin/python3
"""plot.py of hermes-experiments: what it draws, and what it leaves alone."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

try:
    import numpy
    import matplotlib  # pylint: disable=unused-import
except ImportError:
    print("skipped: matplotlib is not installed")
    sys.exit(77)
FOLDER = os.path.join(os.environ["HERMES_SOURCE"], "vectorlib", "experiments")
sys.dont_write_bytecode = True
sys.path.insert(0, FOLDER)
import plot  # pylint: disable=wrong-import-position

NAN = float("nan")


def curve(points, label="a curve", band=()):
    return {"label": label, "colour": "#0072b2", "points": points, "band": list(band)}


def plot_of(curves, name="p", title="a title", **changes):
    return {"name": name, "title": title, "xAxis": "x [m]", "yAxis": "y [m^2]", "xLogarithmic": False, "yLogarithmic": False,
            "isDrawing": False, "curves": curves, **changes}


SURFACE = {"name": "s", "title": "t", "xAxis": "x", "yAxis": "y", "zAxis": "z", "x": [0, 1, 2], "y": [0, 1], "z": [0, 1, None, 3, 4, 5]}
SPACE = {"name": "l", "title": "t", "xAxis": "x", "yAxis": "y", "zAxis": "z", "curves": [curve([[0, 0, 0], [1, 1, 1], [None] * 3, [2, 0, 1], [0, 1, 2]])]}


class Pictures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        self.addCleanup(folder.cleanup)
        self.stem = os.path.join(folder.name, "e")

    def draw(self, *options, plots=(), surfaces=(), spaces=(), status=0):
        with open(self.stem + "-figures.json", "w", encoding="utf-8") as file:
            json.dump({"plots": plots, "surfaces": surfaces, "spaces": spaces}, file)
        done = subprocess.run([os.path.join(FOLDER, "plot.py"), *options, self.stem + "-figures.json"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (status, ""), done.stderr)
        return done.stderr

    def left(self):
        return {path.name: path.read_bytes() for path in pathlib.Path(self.stem).parent.iterdir() if path.suffix != ".json"}

    def test_what_cannot_be_written_is_told(self):
        os.mkdir(self.stem + "-p.svg.part")  # a file of this name cannot be opened
        told = self.draw(plots=[plot_of([curve([[1, 2], [2, 3]])])], status=1)
        self.assertRegex(told, r"^hermes-experiments: .*e-p\.svg cannot be written: Is a directory\n$")

    def test_every_kind_is_drawn_the_same_each_time(self):
        figures = {"plots": [plot_of([curve([[1, 2], [2, 3]], band=[[1, 3], [2, 4]])])], "surfaces": [SURFACE], "spaces": [SPACE]}
        self.assertEqual(self.draw(**figures), "")
        first = self.left()
        self.assertEqual(set(first), {f"e-{name}.{end}" for name in "psl" for end in ("svg", "pdf")})
        self.assertIn("--force", self.draw(**figures, status=1))
        self.draw("--force", **figures)
        self.assertEqual(self.left(), first)

    def test_figures_of_nothing_are_left_out(self):
        nothing = [plot_of([]), plot_of([curve([])]), plot_of([curve([[None, 1], [1e301, 1]])]), plot_of([curve([[0, 1]])], xLogarithmic=True)]
        self.draw(plots=nothing, surfaces=[dict(SURFACE, x=[], y=[], z=[])], spaces=[dict(SPACE, curves=[])])
        self.assertEqual(self.left(), {})

    def test_points_without_a_place(self):
        points = [[1, 2], [0, 9], [10, None], [100, 4]]
        numpy.testing.assert_equal(plot.columns(points, [True, False]).T, [[1, 2], [NAN, NAN], [100, 4]])
        numpy.testing.assert_equal(plot.columns(points, [True, False], is_band=True).T, [[1, 2], [NAN, NAN], [NAN, NAN], [100, 4]])

    def test_any_text_is_text(self):
        hostile = "it's <b> & $x$ \\input{a} % of_it"
        self.draw(plots=[plot_of([curve([[0, 0], [1, 1]], label=hostile)], title=hostile)])
        found = ["".join(text.itertext()) for text in xml.etree.ElementTree.fromstring(self.left()["e-p.svg"]).iter("{http://www.w3.org/2000/svg}text")]
        self.assertEqual(found.count(hostile), 2, found)

    def test_progress_as_json(self):
        lines = self.draw("--json", plots=[plot_of([curve([[0, 0], [1, 1]])], name=str(i)) for i in range(8)]).splitlines()
        told = [json.loads(line)["progress"] for line in lines]
        self.assertEqual([one["total"] for one in told], [8] * len(told))
        if told:  # else it was done at once
            self.assertEqual((told[-1]["done"], told[-1]["left_s"]), (8, 0))


if __name__ == "__main__":
    unittest.main()
