#pragma once

#include "vectorlib/experiments/Plot.h"
#include "vectorlib/geometry/LineSegment2D.h"

#include <nlohmann/json.hpp>

#include <ostream>
#include <string>
#include <vector>

namespace hermes::experiments {

/// Pairs of segments that show a property of registration.
struct RegistrationExample {
    std::string name; ///< in the table
    std::vector<vectorlib::SegmentPair> pairs;
};

/// Four walls of a room and the same ones measured 40 cm, -30 cm and 20 degrees away, a little wrong: their
/// lines of ideal transformations miss each other. Paper figure 2.
RegistrationExample roomExample();
/// Two walls that differ by 1.15 degrees, each measured 3 cm across its true place: together 3 m along.
/// Paper figure 3.
RegistrationExample collinearExample();
/// Walls most of which run in similar directions: a reliability of about one half. Paper figure 4.
RegistrationExample directionsExample();

/// The segments of all examples, as given and after registration.
void writeCsv(std::ostream &out, const std::vector<RegistrationExample> &examples);
/// Transformation, ambiguity, reliability, eigenvalues and the angle epsilon of each.
nlohmann::ordered_json summaryOf(const std::vector<RegistrationExample> &examples);

/// Paper figure 2: the space of transformations with the line of each pair and the optimum, whole and
/// magnified.
std::vector<SpacePlot> transformationSpace(const RegistrationExample &example);
/// Paper figure 3: segments before and after registration.
Plot collinearPlot(const RegistrationExample &example);
/// Paper figure 4: direction vectors with their opposites, the ellipse of their eigenvectors with half axes
/// of the roots of the eigenvalues, and the angle epsilon of the reliability sin(2 epsilon).
Plot reliabilityEllipse(const RegistrationExample &example);

} // namespace hermes::experiments
