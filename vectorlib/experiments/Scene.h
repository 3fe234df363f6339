#pragma once

#include "vectorlib/geometry/LineSegment2D.h"

#include <string>
#include <vector>

namespace hermes::experiments {

/// A world of an experiment, with the scanner at its origin; metres, free space on the left.
struct Scene {
    std::string name;
    std::string title;
    std::vector<vectorlib::LineSegment2D<float>> edges;

    /// The parts of edges that the scanner sees: what an extractor should find.
    std::vector<vectorlib::LineSegment2D<float>> visible() const;
};

/// Four edges that touch nothing, as in thesis figure 6.8.
Scene solitaryEdges();
/// Five edges in a row with sharp corners, one large cluster, as in figure 6.9.
Scene sharpCorners();
/// A room with furniture of which 15 parts are seen, as in figure 6.10.
Scene furnishedRoom();
/// The same room with small things standing about, as in figure 5.7.
Scene roomWithSmallObjects();

/// The area between what is true and what was extracted, over all directions in which both are seen; m^2. By
/// rays at steps of 0.01 degree from the scanner at the origin. Where they are more than half a metre apart,
/// an end lies a little off and the ray meets another edge beyond it: that says nothing of how well edges
/// lie, and is left out.
double errorArea(const std::vector<vectorlib::LineSegment2D<float>> &truth,
                 const std::vector<vectorlib::LineSegment2D<float>> &extracted);

} // namespace hermes::experiments
