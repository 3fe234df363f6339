#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/Corner.h"
#include "vectorlib/relations/TypedSegment.h"
#include "vectorlib/segmentation/EarSegmenter.h"
#include "vectorlib/segmentation/ScanOrder.h"
#include "vectorlib/tls/TlsSums.h"
#include "vectorlib/vectorization/AftlsVectorizer.h"
#include "vectorlib/vectorization/VectorizedLine.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vectorlib {

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
