#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/MatchingTable.h"
#include "vectorlib/relations/RelationSet.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vectorlib {

/// How many measured things of matched segments agree. Three are needed to tell a place from its like: two
/// lines that cross at a right angle fit any corner of any room.
class MatchSigns {
public:
    double distance = 0.10;       ///< of equal lines and ends; metres
    double angle = 10 * pi / 180; ///< from parallel or square, within which it tells nothing; radians

    /// The number of different lines among the pairs, and of jumps at which a segment ends in both scans, and
    /// one if two lines are neither parallel nor square. A corner counts by its two lines. Quadratic in the
    /// pairs. The pose brings the current scan onto the reference.
    int operator()(const std::vector<CorrespondencePair> &pairs, const std::vector<TypedSegment> &reference,
                   const std::vector<TypedSegment> &current, const Transformation2D &pose) const;

private:
    bool isSameLine(const LineSegment2D<double> &a, const LineSegment2D<double> &b) const;
    bool isSquare(const LineSegment2D<double> &a, const LineSegment2D<double> &b) const {
        const double sine = std::abs(a.direction().cross(b.direction())),
                     cosine = std::abs(a.direction().dot(b.direction()));
        return std::min(sine, cosine) < std::sin(angle);
    }
    int commonJumps(const TypedSegment &r, const TypedSegment &c, const Transformation2D &pose) const {
        return isCommonJump(r.begin, r.segment.begin(), c.begin, pose * c.segment.begin()) +
               isCommonJump(r.end, r.segment.end(), c.end, pose * c.segment.end());
    }
    bool isCommonJump(const SegmentEnd &a, Vector2D<double> there, const SegmentEnd &b,
                      Vector2D<double> here) const {
        const bool isCorner = a.type == EndType::Angle && b.type == EndType::Angle;
        return a.isEdge() && b.isEdge() && !isCorner && a.slack <= distance && b.slack <= distance &&
               (there - here).norm() <= 1.5 * distance;
    }
};

/// Fills a matching table from the relations of two scans. Pose-free thesis 5.1, 5.2, Algorithms 3 and 4:
/// every relation of the current scan has the score 1 / (Count_c Count_r), by how many of its own and of the
/// reference scan match it (erratum 12), and it goes to all pairs of segments of every relation that matches.
/// Keeps its buffers.
class RelationScores {
public:
    using Segments = std::vector<TypedSegment>;

    /// Which segments may match; valid until the next call.
    const ConsistencyTable &referenceTable() const { return toReference_; }

    /// Whether a bound left out relations: kinds that are many times in both scans.
    bool isCut() const { return isCut_; }
    /// Relations that were compared with another.
    std::size_t compared() const { return compared_; }

    /// Adds the scores of all relations to the table, whose rows are the reference segments and whose columns
    /// the current ones.
    void operator()(const Segments &reference, const RelationSet &ofReference, const Segments &current,
                    const RelationSet &ofCurrent, const RelationSettings &settings, MatchingTable &table);

private:
    void scoreLengths(const RelationSet &ofReference, const Segments &current, const RelationSet &ofCurrent,
                      MatchingTable &table);
    /// Relations of two segments.
    template <typename Relation>
    void scorePairs(const std::vector<Relation> &relations, const RelationSet &ofReference,
                    const RelationSet &ofCurrent, MatchingTable &table);
    /// Relations of two corners, of up to four segments.
    void scoreCorners(const RelationSet &ofReference, const RelationSet &ofCurrent, MatchingTable &table);

    struct Cells {
        std::size_t cells[4];
        int count;
    };
    static Cells cellsOf(const CornerRelation &r, const std::vector<Corner> &reference,
                         const CornerRelation &c, const std::vector<Corner> &current,
                         const MatchingTable &table);
    bool hasRoom(const MatchingTable &table, std::size_t more) {
        isCut_ = isCut_ || table.scores() + more > maxScores_;
        return !isCut_;
    }
    bool mayCompare() {
        isCut_ = isCut_ || compared_ >= maxCompared_;
        return !isCut_;
    }
    static double scoreOf(int count, std::size_t matches) {
        return 1 / (double(std::max(1, count)) * double(matches));
    }
    void addAll(int count, MatchingTable &table) {
        const double score = scoreOf(count, cells_.size());
        for (const Cells &c : cells_)
            table.add(score, c.cells, c.count);
    }

    ConsistencyTable toReference_, toCurrent_;
    CornerTable cornersToReference_, cornersToCurrent_;
    std::vector<int> numbers_;
    std::vector<Cells> cells_;
    std::size_t compared_ = 0, maxScores_ = 0, maxCompared_ = 0;
    bool isCut_ = false;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/RelationScores.cpp")
