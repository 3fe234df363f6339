#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace hermes {

/// One curve of a plot: named, in a colour (#rrggbb), through its points.
struct Curve {
    std::string label;
    std::string colour;
    std::vector<std::pair<double, double>> points;
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
};

/// A gnuplot script with its data inside that writes the plot as SVG to standard output.
void writeGnuplot(std::ostream &out, const Plot &plot);
/// A LaTeX document with all plots that pdflatex compiles (pgfplots).
void writeLatex(std::ostream &out, const std::string &title, const std::vector<Plot> &plots);

} // namespace hermes
