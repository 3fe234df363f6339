#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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
inline PlotPlace placeOf(const Plot &plot, std::pair<double, double> point) {
    constexpr double most = 1e300; // beyond which an axis around it is none
    if (!(std::abs(point.first) < most) || !(std::abs(point.second) < most))
        return PlotPlace::Break;
    return (!plot.xLogarithmic || point.first > 0) && (!plot.yLogarithmic || point.second > 0)
               ? PlotPlace::Shown
               : PlotPlace::LeftOut;
}

/// Where the band of a curve is shown: closed outlines, there and back again, one for each part without a
/// gap.
inline std::vector<std::vector<std::pair<double, double>>> outlinesOf(const Curve &curve, const Plot &plot) {
    std::vector<std::vector<std::pair<double, double>>> outlines;
    std::vector<std::pair<double, double>> low, high;
    const auto close = [&] {
        high.insert(high.end(), low.rbegin(), low.rend());
        if (low.size() > 1)
            outlines.push_back(high);
        low.clear();
        high.clear();
    };
    for (std::size_t i = 0; i < std::min(curve.points.size(), curve.band.size()); ++i) {
        const double x = curve.points[i].first;
        const std::pair<double, double> below(x, curve.band[i].first), above(x, curve.band[i].second);
        if (placeOf(plot, below) == PlotPlace::Shown && placeOf(plot, above) == PlotPlace::Shown) {
            low.push_back(below);
            high.push_back(above);
        } else {
            close();
        }
    }
    close();
    return outlines;
}

} // namespace vectorlib
