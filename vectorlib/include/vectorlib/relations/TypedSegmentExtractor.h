#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/MatchingTable.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"
#include "vectorlib/segmentation/EarSegmenter.h"
#include "vectorlib/segmentation/ScanOrder.h"
#include "vectorlib/tls/TlsSums.h"
#include "vectorlib/vectorization/AftlsVectorizer.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <algorithm>
#include <cmath>
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
              const ConsistencyTable &segments, double window);
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
    static bool segmentsMatch(const Corner &a, const Corner &b, const ConsistencyTable &segments);
    static bool anglesMayMatch(const Corner &a, const Corner &b, double window);

    std::size_t columns_ = 0;
    std::vector<std::uint8_t> cells_;
};

/// Turns a scan into segments with typed ends, numbered counter-clockwise as they are seen. Pose-free thesis
/// chapter 3; lines by AFTLS instead of split and merge, whose corners are overrun. Keeps its buffers.
class TypedSegmentExtractor {
public:
    EarSegmenter<float> segment;
    AftlsVectorizer<float> vectorize;
    std::size_t minPoints = 4;           ///< lines through fewer points are left out
    double minLength = 0.12;             ///< shorter ones too; metres
    double maxAngleError = 4 * pi / 180; ///< and those whose standard deviation is larger; radians
    double noise = 0.015;                ///< standard deviation of a range; metres
    double jump = 0.12;                  ///< a neighbour this far beyond the line makes a jump edge; metres
    double beamSlack = 1.0; ///< an angle edge may lie this many rays outside the two beams beside it

    /// For a scanner of `rays` rays over `fieldOfView` radians, both limits included unless a full turn.
    void setScanner(double fieldOfView, std::size_t rays);
    /// The points of a scan in the sensor's frame, in the order of ScanOrder. Valid until the next call.
    const std::vector<TypedSegment> &operator()(PointSpan<float> given);

private:
    using Point = Vector2D<double>;
    struct ScanLine {
        std::size_t first = 0, last = 0; // points of the scan
        VectorizedLine line;
        TlsSums inner; // of its points without the outermost
        bool isKept = false;
    };

    void takeLines(PointSpan<float> scan);
    // Of all its points but the outermost, which may belong to the neighbour: a point beyond a corner keeps
    // its beam when the sensor turns and would hold the motion back.
    TlsSums innerSums(const VectorizedLine &line) const;
    bool isKnown(const VectorizedLine &line) const;
    TypedSegment typed(PointSpan<float> scan, std::size_t i) const;
    // An angle edge: consecutive lines and points, the intersection between the two beams.
    bool isCorner(PointSpan<float> scan, const ScanLine &a, const ScanLine &b) const;
    static SegmentEnd corner(const ScanLine &a, const ScanLine &b, Point &at);
    // No ray without return between two points.
    bool isNext(Point p, Point q) const {
        return p.cross(q) <= std::sin(std::min(1.6 * step_, pi / 2)) * p.norm() * q.norm() && p.dot(q) > 0;
    }
    // side 1: beyond the end, -1: before the begin. The structure ends between the two beams: halfway.
    SegmentEnd jumpOrInterior(const ScanLine &l, Vector2D<float> own, Vector2D<float> neighbour, int side,
                              Point &at) const;

    static constexpr std::size_t leastTrimmed = 7; // points of a line whose outermost are left out

    ScanOrder order_;
    double step_ = pi / 180;
    std::vector<Vector2D<float>> cluster_;
    std::vector<ScanLine> lines_;
    std::vector<TypedSegment> segments_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/TypedSegmentExtractor.cpp")
