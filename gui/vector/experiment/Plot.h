#pragma once

#include "gui/vector/experiment/SpacePlot.h"

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace hermes::vector {

/// One curve of a plot: named, in a colour (#rrggbb), through its points. A point that is not finite
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

/// A table; its cells are LaTeX.
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

/// A gnuplot script with its data inside that writes the plot as SVG to standard output.
void writeGnuplot(std::ostream &out, const Plot &plot);
void writeGnuplot(std::ostream &out, const Surface &surface);
/// A LaTeX document with all figures that pdflatex compiles (pgfplots).
void writeLatex(std::ostream &out, const std::string &title, const Figures &figures);

} // namespace hermes::vector
