#pragma once

#include "vectorlib/io/LatexExport.h"

#include <nlohmann/json.hpp>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace hermes::experiments {

using vectorlib::Table;

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

/// What an experiment shows.
struct Figures {
    std::vector<Plot> plots;
    std::vector<Surface> surfaces;
    std::vector<Table> tables;
    std::vector<SpacePlot> spaces{};
};

// As plot.py reads them; a number that is not finite is null. Tables stand in documents alone.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Curve, label, colour, points, band)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Plot, name, title, xAxis, yAxis, xLogarithmic, yLogarithmic, curves,
                                   isDrawing)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Surface, name, title, xAxis, yAxis, zAxis, x, y, z)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SpaceCurve, label, colour, points)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SpacePlot, name, title, xAxis, yAxis, zAxis, curves)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Figures, plots, surfaces, spaces)

} // namespace hermes::experiments
