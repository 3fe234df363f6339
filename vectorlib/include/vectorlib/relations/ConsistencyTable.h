#pragma once

#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"

#include <cstdint>
#include <vector>

namespace vectorlib {

/// Algorithm 2 with an erratum: whether two lengths with their types of ends may be of one structure. As
/// printed only equal lengths of complete segments pass, which measured lengths never are, and 4.1.1 asks
/// that they be sufficiently close. Lengths that differ by no more than the window and the slack of the ends
/// that are edges count as equal.
inline bool lengthsMayMatch(const TypedSegment &a, const TypedSegment &b, double window) {
    const double la = a.segment.length(), lb = b.segment.length();
    const auto slack = [](const TypedSegment &s) {
        return (s.begin.isEdge() ? s.begin.slack : 0) + (s.end.isEdge() ? s.end.slack : 0);
    };
    if (std::abs(la - lb) <= window + slack(a) + slack(b))
        return true;
    return !(la < lb ? a : b).isComplete();
}

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
    void fill(const Segments &rows, const Segments &columns, const RelationSettings &settings) {
        columns_ = columns.size();
        cells_.resize(rows.size() * columns_);
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = 0; j < columns_; ++j)
                cells_[i * columns_ + j] = lengthsMayMatch(rows[i], columns[j], settings.distanceWindow) &&
                                           endsMayMatch(rows, i, columns, j, settings) &&
                                           beginsMayMatch(rows, i, columns, j, settings);
    }
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
                             const RelationSettings &settings) {
        const bool isA = a[i].joined && i + 1 < a.size(), isB = b[j].joined && j + 1 < b.size();
        if (isA && isB)
            return cornersMayMatch(a, i, b, j, settings);
        if (isA && b[j].end.type == EndType::Jump)
            return keepsBound(a, i, b[j].end, settings);
        if (isB && a[i].end.type == EndType::Jump)
            return keepsBound(b, j, a[i].end, settings);
        return true;
    }
    static bool beginsMayMatch(const Segments &a, std::size_t i, const Segments &b, std::size_t j,
                               const RelationSettings &settings) {
        const bool isA = i > 0 && a[i - 1].joined, isB = j > 0 && b[j - 1].joined;
        if (isA && isB)
            return lengthsMayMatch(a[i - 1], b[j - 1], settings.distanceWindow) &&
                   anglesMatch(relativeAngle(a[i - 1].segment, a[i].segment),
                               relativeAngle(b[j - 1].segment, b[j].segment), settings.angleWindow);
        if (isA && b[j].begin.type == EndType::Jump)
            return keepsBound(a, i - 1, b[j].begin, settings);
        if (isB && a[i].begin.type == EndType::Jump)
            return keepsBound(b, j - 1, a[i].begin, settings);
        return true;
    }
    static bool cornersMayMatch(const Segments &a, std::size_t i, const Segments &b, std::size_t j,
                                const RelationSettings &settings) {
        return lengthsMayMatch(a[i + 1], b[j + 1], settings.distanceWindow) &&
               anglesMatch(relativeAngle(a[i].segment, a[i + 1].segment),
                           relativeAngle(b[j].segment, b[j + 1].segment), settings.angleWindow);
    }
    // The corner between segment i and the next one, seen in the other scan as a jump: what is hidden there
    // lies in its shadow.
    static bool keepsBound(const Segments &a, std::size_t i, const SegmentEnd &jump,
                           const RelationSettings &settings) {
        const double angle = relativeAngle(a[i].segment, a[i + 1].segment);
        return angle >= pi - settings.angleWindow && angle <= jump.bound + settings.angleWindow;
    }

    std::size_t columns_ = 0;
    std::vector<std::uint8_t> cells_;
};

} // namespace vectorlib
