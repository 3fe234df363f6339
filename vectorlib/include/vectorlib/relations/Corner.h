#pragma once

#include "vectorlib/relations/ConsistencyTable.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// The kinds of edges of pose-free thesis 3.3; a jump is at the begin or at the end of its segment.
enum class CornerType : std::uint8_t {
    Angle,     ///< two segments meet there
    JumpBegin, ///< a segment begins there, in front of what lies behind
    JumpEnd,   ///< a segment ends there, in front of what lies behind
    Virtual    ///< the lines of two segments cross there
};

/// An edge in the sense of pose-free thesis 3.3: a point where two segments meet or would meet, or where one
/// ends in front of what lies behind. Called corner here, as edges are segments in this library.
struct Corner {
    CornerType type = CornerType::Virtual;
    int first = -1;         ///< number of the segment before it; -1 at JumpBegin
    int second = -1;        ///< number of the segment after it; -1 at JumpEnd
    Vector2D<double> point; ///< sensor frame; metres
    /// Relative angle of the two segments; of a jump the largest that the hidden one can have. Radians.
    double angle = 0;
};

/// Where the lines of two segments cross; metres. False when they are nearer to parallel than the least
/// angle.
inline bool crossing(const LineSegment2D<double> &a, const LineSegment2D<double> &b, double leastSine,
                     Vector2D<double> &point) {
    const double sine = a.direction().cross(b.direction());
    if (!(std::abs(sine) > leastSine))
        return false;
    point = a.begin() + a.direction() * ((b.begin() - a.begin()).cross(b.direction()) / sine);
    return true;
}

/// Finds the corners of a set of segments: angle and jump edges in the order of the scan, then virtual ones
/// by their segments. Of virtual ones the lines must cross near enough to both segments to be known, and only
/// so many are kept, those that lie nearest in lengths of their segments. Keeps its buffers.
class CornerFinder {
public:
    /// Returns how many virtual edges were left out for the bound.
    std::size_t operator()(const std::vector<TypedSegment> &segments, const RelationSettings &settings,
                           std::vector<Corner> &corners) {
        corners.clear();
        for (std::size_t i = 0; i < segments.size(); ++i)
            addReal(segments, i, settings.distanceWindow, corners);
        return addVirtual(segments, settings, corners);
    }

private:
    struct Candidate {
        double far = 0; ///< in lengths of the segment that knows it worse
        Corner corner;
    };

    static void addReal(const std::vector<TypedSegment> &segments, std::size_t i, double window,
                        std::vector<Corner> &corners) {
        const TypedSegment &s = segments[i];
        const int number = static_cast<int>(i);
        if (s.begin.type == EndType::Jump && s.begin.slack <= window)
            corners.push_back({CornerType::JumpBegin, -1, number, s.segment.begin(), s.begin.bound});
        if (s.end.type == EndType::Jump && s.end.slack <= window)
            corners.push_back({CornerType::JumpEnd, number, -1, s.segment.end(), s.end.bound});
        if (s.joined && i + 1 < segments.size())
            corners.push_back({CornerType::Angle, number, number + 1, s.segment.end(),
                               relativeAngle(s.segment, segments[i + 1].segment)});
    }
    std::size_t addVirtual(const std::vector<TypedSegment> &segments, const RelationSettings &settings,
                           std::vector<Corner> &corners) {
        candidates_.clear();
        const double sine = std::sin(settings.virtualAngle);
        for (std::size_t i = 0; i < segments.size(); ++i)
            for (std::size_t j = i + 1; j < segments.size(); ++j) {
                const LineSegment2D<double> &a = segments[i].segment, &b = segments[j].segment;
                Vector2D<double> point;
                if ((segments[i].joined && j == i + 1) || !crossing(a, b, sine, point))
                    continue;
                const double far = std::max(lengthsTo(a, point), lengthsTo(b, point));
                if (far <= settings.virtualReach)
                    candidates_.push_back({far,
                                           {CornerType::Virtual, static_cast<int>(i), static_cast<int>(j),
                                            point, relativeAngle(a, b)}});
            }
        return keepNearest(settings.maxVirtualEdges, corners);
    }
    std::size_t keepNearest(std::size_t most, std::vector<Corner> &corners) {
        const std::size_t found = candidates_.size(), kept = std::min(found, most);
        const auto order = [](const Corner &c) { return (c.first << 8) + c.second; };
        if (kept < found)
            std::nth_element(candidates_.begin(), candidates_.begin() + std::ptrdiff_t(kept),
                             candidates_.end(), [&](const Candidate &a, const Candidate &b) {
                                 return a.far != b.far ? a.far < b.far : order(a.corner) < order(b.corner);
                             });
        candidates_.resize(kept);
        std::sort(candidates_.begin(), candidates_.end(),
                  [&](const Candidate &a, const Candidate &b) { return order(a.corner) < order(b.corner); });
        for (const Candidate &c : candidates_)
            corners.push_back(c.corner);
        return found - kept;
    }
    // How far beyond the nearer end a point of the line lies, in lengths of the segment; 0 on it.
    static double lengthsTo(const LineSegment2D<double> &s, Vector2D<double> point) {
        const double t = s.along(point), length = s.length();
        return std::max({-t, t - length, 0.0}) / length;
    }

    std::vector<Candidate> candidates_;
};

/// Which corners of one set may match which of another. Pose-free thesis 4.1.2: types, angles, and both
/// segments by the table of segments. Keeps its buffer.
class CornerTable {
public:
    /// Compares every corner of `rows` with every one of `columns`. `segments` is the table of their
    /// segments; `window` is that of angles, radians.
    void fill(const std::vector<Corner> &rows, const std::vector<Corner> &columns,
              const ConsistencyTable &segments, double window) {
        columns_ = columns.size();
        cells_.resize(rows.size() * columns_);
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = 0; j < columns_; ++j)
                cells_[i * columns_ + j] = typesMatch(rows[i].type, columns[j].type) &&
                                           segmentsMatch(rows[i], columns[j], segments) &&
                                           anglesMayMatch(rows[i], columns[j], window);
    }
    /// Whether corner `row` of the first set may match corner `column` of the second.
    bool operator()(int row, int column) const {
        return cells_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)] != 0;
    }

private:
    static bool typesMatch(CornerType a, CornerType b) {
        if (a == CornerType::Virtual || b == CornerType::Virtual)
            return a == b;
        return a == b || a == CornerType::Angle || b == CornerType::Angle;
    }
    static bool segmentsMatch(const Corner &a, const Corner &b, const ConsistencyTable &segments) {
        return (a.first < 0 || b.first < 0 || segments(a.first, b.first)) &&
               (a.second < 0 || b.second < 0 || segments(a.second, b.second));
    }
    static bool anglesMayMatch(const Corner &a, const Corner &b, double window) {
        const bool isJumpA = a.first < 0 || a.second < 0, isJumpB = b.first < 0 || b.second < 0;
        if (isJumpA && isJumpB)
            return true; // bounds of two hidden segments never contradict each other
        if (isJumpA || isJumpB) {
            const Corner &jump = isJumpA ? a : b, &seen = isJumpA ? b : a;
            return seen.angle >= pi - window && seen.angle <= jump.angle + window;
        }
        return anglesMatch(a.angle, b.angle, window);
    }

    std::size_t columns_ = 0;
    std::vector<std::uint8_t> cells_;
};

} // namespace vectorlib
