#pragma once

#include <array>
#include <ostream>
#include <string>
#include <vector>

namespace hermes::vector {

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

/// A gnuplot script with its data inside that writes the plot as SVG to standard output.
void writeGnuplot(std::ostream &out, const SpacePlot &plot);
/// The picture alone, for a document with pgfplots.
void writeLatex(std::ostream &out, const SpacePlot &plot);

} // namespace hermes::vector
