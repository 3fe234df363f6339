#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// Algorithm 2 with an erratum: whether two lengths with their types of ends may be of one structure. As
/// printed only equal lengths of complete segments pass, which measured lengths never are, and 4.1.1 asks
/// that they be sufficiently close. Lengths that differ by no more than the window and the slack of the ends
/// that are edges count as equal.
bool lengthsMayMatch(const TypedSegment &a, const TypedSegment &b, double window);

/// Whether two relative angles are no farther apart than the window; radians.
inline bool anglesMatch(double a, double b, double window) {
    return std::abs(wrapAngle(a - b)) <= window;
}

/// Which segments of one set may match which of another: 1 or 0 by row and column. Pose-free thesis 4.1.3:
/// lengths and types of ends (4.1.1), and the edges at their ends (4.1.2): where both have an edge at the
/// same end the angles must be equal, or keep the bound of a jump, and the segments beyond must have lengths
/// that may match. Keeps its buffer.
class ConsistencyTable {
public:
    using Segments = std::vector<TypedSegment>;

    /// Compares every segment of `rows` with every one of `columns`, both in the order of their scans.
    void fill(const Segments &rows, const Segments &columns, const RelationSettings &settings);
    /// Whether segment `row` of the first set may match segment `column` of the second.
    bool operator()(std::size_t row, std::size_t column) const {
        return cells_[row * columns_ + column] != 0;
    }
    /// The same for numbers that are not below 0.
    bool operator()(int row, int column) const {
        return (*this)(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
    }

private:
    static bool endsMayMatch(const Segments &a, std::size_t i, const Segments &b, std::size_t j,
                             const RelationSettings &settings);
    static bool beginsMayMatch(const Segments &a, std::size_t i, const Segments &b, std::size_t j,
                               const RelationSettings &settings);
    static bool cornersMayMatch(const Segments &a, std::size_t i, const Segments &b, std::size_t j,
                                const RelationSettings &settings);
    // The corner between segment i and the next one, seen in the other scan as a jump: what is hidden there
    // lies in its shadow.
    static bool keepsBound(const Segments &a, std::size_t i, const SegmentEnd &jump,
                           const RelationSettings &settings);

    std::size_t columns_ = 0;
    std::vector<std::uint8_t> cells_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/ConsistencyTable.cpp")
