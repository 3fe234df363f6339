#pragma once

#include "vectorlib/io/Plot.h"

#include <ostream>

namespace hermes::experiments {

using vectorlib::Curve;
using vectorlib::Figures;
using vectorlib::Plot;
using vectorlib::SpaceCurve;
using vectorlib::SpacePlot;
using vectorlib::Surface;
using vectorlib::Table;

/// A gnuplot script with its data inside that writes the plot as SVG to standard output.
void writeGnuplot(std::ostream &out, const Plot &plot);
void writeGnuplot(std::ostream &out, const Surface &surface);
void writeGnuplot(std::ostream &out, const SpacePlot &plot);

} // namespace hermes::experiments
