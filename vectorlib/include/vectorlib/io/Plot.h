#pragma once

#include "vectorlib/Body.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace vectorlib {

/// One curve of a plot: named, in a colour (`#rrggbb`), through its points. A point that is not finite
/// interrupts it.
struct Curve {
    std::string label; ///< none in the legend when empty
    std::string colour;
    std::vector<std::pair<double, double>> points;
    std::vector<std::pair<double, double>> band = {}; ///< lowest and highest y at each point; empty: none
};

/// A plot of several curves.
struct Plot {
    std::string name; ///< in file names
    std::string title;
    std::string xAxis; ///< with unit
    std::string yAxis;
    bool xLogarithmic = false; ///< points without a place on a logarithmic axis are left out
    bool yLogarithmic = false;
    std::vector<Curve> curves;
    bool isDrawing = false; ///< both axes to the same scale, lines without marks
};

/// A function of two quantities on a grid.
struct Surface {
    std::string name; ///< in file names
    std::string title;
    std::string xAxis; ///< with unit
    std::string yAxis;
    std::string zAxis;
    std::vector<double> x, y;
    std::vector<double> z; ///< row by row: all x of the first y first
};

/// Lines in space; a point that is not finite parts them.
struct SpaceCurve {
    std::string label; ///< none in the legend when empty
    std::string colour;
    std::vector<std::array<double, 3>> points;
};

/// A picture of lines and points in a space of three quantities.
struct SpacePlot {
    std::string name; ///< in file names
    std::string title;
    std::string xAxis; ///< with unit
    std::string yAxis;
    std::string zAxis;
    std::vector<SpaceCurve> curves;
};

/// A table; its cells are LaTeX, which latexText() makes of text; its title is text.
struct Table {
    std::string title;
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
};

/// What an experiment shows.
struct Figures {
    std::vector<Plot> plots;
    std::vector<Surface> surfaces;
    std::vector<Table> tables;
    std::vector<SpacePlot> spaces{};
};

/// What becomes of a point of a plot: not finite it interrupts its curve, without a place on a logarithmic
/// axis it is left out.
enum class PlotPlace {
    Shown,   ///< it is drawn
    LeftOut, ///< its curve goes on without it
    Break    ///< its curve is interrupted
};

/// What becomes of a point (x, y) of the plot.
PlotPlace placeOf(const Plot &plot, std::pair<double, double> point);

/// Where the band of a curve is shown: closed outlines, there and back again, one for each part without a
/// gap.
std::vector<std::vector<std::pair<double, double>>> outlinesOf(const Curve &curve, const Plot &plot);

} // namespace vectorlib

#ifdef VECTORLIB_HEADER_ONLY
#include "vectorlib/src/io/Plot.cpp"
#endif
