#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/ConsistencyTable.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"

#include <cstdint>
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
bool crossing(const LineSegment2D<double> &a, const LineSegment2D<double> &b, double leastSine,
              Vector2D<double> &point);

/// Finds the corners of a set of segments: angle and jump edges in the order of the scan, then virtual ones
/// by their segments. Of virtual ones the lines must cross near enough to both segments to be known, and only
/// so many are kept, those that lie nearest in lengths of their segments. Keeps its buffers.
class CornerFinder {
public:
    /// Returns how many virtual edges were left out for the bound.
    std::size_t operator()(const std::vector<TypedSegment> &segments, const RelationSettings &settings,
                           std::vector<Corner> &corners);

private:
    struct Candidate {
        double far = 0; ///< in lengths of the segment that knows it worse
        Corner corner;
    };

    static void addReal(const std::vector<TypedSegment> &segments, std::size_t i, double window,
                        std::vector<Corner> &corners);
    std::size_t addVirtual(const std::vector<TypedSegment> &segments, const RelationSettings &settings,
                           std::vector<Corner> &corners);
    std::size_t keepNearest(std::size_t most, std::vector<Corner> &corners);
    // How far beyond the nearer end a point of the line lies, in lengths of the segment; 0 on it.
    static double lengthsTo(const LineSegment2D<double> &s, Vector2D<double> point);

    std::vector<Candidate> candidates_;
};

/// Which corners of one set may match which of another. Pose-free thesis 4.1.2: types, angles, and both
/// segments by the table of segments. Keeps its buffer.
class CornerTable {
public:
    /// Compares every corner of `rows` with every one of `columns`. `segments` is the table of their
    /// segments; `window` is that of angles, radians.
    void fill(const std::vector<Corner> &rows, const std::vector<Corner> &columns,
              const ConsistencyTable &segments, double window);
    /// Whether corner `row` of the first set may match corner `column` of the second.
    bool operator()(int row, int column) const {
        return cells_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)] != 0;
    }

private:
    static bool typesMatch(CornerType a, CornerType b);
    static bool segmentsMatch(const Corner &a, const Corner &b, const ConsistencyTable &segments);
    static bool anglesMayMatch(const Corner &a, const Corner &b, double window);

    std::size_t columns_ = 0;
    std::vector<std::uint8_t> cells_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/Corner.cpp")
