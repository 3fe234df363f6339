#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/io/LatexPicture.h"
#include "vectorlib/io/LatexText.h"
#include "vectorlib/io/Picture.h"
#include "vectorlib/io/Plot.h"

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace vectorlib {

namespace latex {

/// Writes the points that the plot shows as coordinates of pgfplots, with a break where a point is not
/// finite.
void writeCoordinates(std::ostream &out, const Plot &plot,
                      const std::vector<std::pair<double, double>> &points);

/// A curve of more points than TeX has memory for: of each 1 / 400 of them, in order, the lowest and the
/// highest, and a break where there is one.
std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>> &points);

/// The box of all points that a plot shows; nothing when there is none.
std::optional<Picture::Box> boxOf(const Plot &plot);

/// Of a logarithmic axis over less than three powers of ten the places 1, 2 and 5: pgfplots would write
/// powers with fractions there. Nothing where pgfplots finds better ones.
std::string ticksOf(char axis, double low, double high);

/// Of any figure with a title and names of its axes; its legend will be below.
template <typename Figure>
void openAxis(std::ostream &out, const Figure &figure, const std::string &options) {
    out << "\\begin{tikzpicture}\n\\begin{axis}[" << options
        << "unbounded coords=jump, grid=major,\n  title={" << latexText(figure.title) << "}, xlabel={"
        << latexText(figure.xAxis) << "}, ylabel={" << latexText(figure.yAxis)
        << "},\n  legend columns=2, legend cell align=left,\n  legend style={at={(0.5,-0.18)}, anchor=north, "
           "draw=none, font=\\small, /tikz/every even column/.append style={column sep=1em}}]\n";
}

/// Writes a curve with its band and its line of the legend; one of many points thinned().
void writeCurve(std::ostream &out, const Plot &plot, const Curve &curve);

} // namespace latex

/// A plot as a tikzpicture of pgfplots, its legend below; one without a point to show says so.
void writeLatex(std::ostream &out, const Plot &plot);

/// A surface as a tikzpicture of pgfplots; one without a grid, or with other values than its grid has, says
/// so.
void writeLatex(std::ostream &out, const Surface &s);

/// Lines in space as a tikzpicture of pgfplots; without a point to show it says so.
void writeLatex(std::ostream &out, const SpacePlot &plot);

} // namespace vectorlib

#ifdef VECTORLIB_HEADER_ONLY
#include "vectorlib/src/io/LatexPlot.cpp"
#endif
