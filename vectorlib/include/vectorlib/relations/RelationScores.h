#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/ConsistencyTable.h"
#include "vectorlib/relations/Corner.h"
#include "vectorlib/relations/MatchingTable.h"
#include "vectorlib/relations/RelationSet.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/Relations.h"
#include "vectorlib/relations/TypedSegment.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

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
    bool hasRoom(const MatchingTable &table, std::size_t more);
    bool mayCompare();
    static double scoreOf(int count, std::size_t matches) {
        return 1 / (double(std::max(1, count)) * double(matches));
    }
    void addAll(int count, MatchingTable &table);

    ConsistencyTable toReference_, toCurrent_;
    CornerTable cornersToReference_, cornersToCurrent_;
    std::vector<int> numbers_;
    std::vector<Cells> cells_;
    std::size_t compared_ = 0, mostScores_ = 0, mostCompared_ = 0;
    bool isCut_ = false;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/RelationScores.cpp")
