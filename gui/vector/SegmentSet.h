#pragma once

#include "gui/vector/Options.h"
#include "vectorlib/correspondence/SearchResult.h"

#include <string>

namespace hermes::vector {

/// How segments are made of points, and how sure segments are.
struct SegmentSetSettings {
    SegmentOptions segment;
    double sigma = 0.03; ///< largest standard deviation of points from their line; metres
    /// Standard deviation of the points, or of the ends of segments, metres. 0: of points their scatter about
    /// each line, of segments 1 cm.
    double noise = 0;

    /// For a scan of a full turn.
    vectorlib::EarSettings segmentation(std::size_t points) const {
        return segment.over(vectorlib::EarSettings::forScanner(2 * vectorlib::pi, points));
    }
};

/// The segments of a file, told by its columns: a scan of points (x,y, or PCD by extension), segments
/// (x1,y1,x2,y2), or a vector map as `hermes-vector map` writes it.
struct SegmentSet {
    enum class Kind { Points, Segments, Map };
    Kind kind = Kind::Segments;
    std::vector<vectorlib::Vector2D<float>> points; ///< of a scan; metres
    vectorlib::MeasuredSegments measured;

    const std::vector<vectorlib::LineSegment2D<double>> &segments() const { return measured.segments; }
};

/// Throws Failure.
SegmentSet loadSegmentSet(const std::string &path, const SegmentSetSettings &settings);

} // namespace hermes::vector
