#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/MatchSigns.h"
#include "vectorlib/relations/MatchingTable.h"
#include "vectorlib/relations/PairConsensus.h"
#include "vectorlib/relations/PairSearch.h"
#include "vectorlib/relations/RelationMatch.h"
#include "vectorlib/relations/RelationScan.h"
#include "vectorlib/relations/RelationScores.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/SeenThrough.h"
#include "vectorlib/relations/TypedSegment.h"

#include <vector>

namespace vectorlib {

/// Matches two sets of line segments without any estimate of the pose, by what does not depend on it:
/// lengths, angles between segments, distances of parallel ones, distances of edges. Pose-free thesis,
/// chapters 3 to 5. Relations that are rare tell most.
///
/// The search of Algorithm 5 is repeated without the pairs that it found, and the place that brings most
/// length together is the match, if enough speaks for it (MatchSigns) and little against it (SeenThrough).
/// Where another place does nearly as well the match is ambiguous.
///
/// Never more than settings.maxSegments segments, maxVirtualEdges virtual edges of a scan and maxScores
/// scores take part, and about maxCompared comparisons are made, so that time and memory are bounded; the
/// result says what was left out. Keeps its
/// buffers: no allocation once they have grown.
class RelationMatcher {
public:
    using Segments = std::vector<TypedSegment>;

    RelationSettings settings;

    /// Segments of both scans in the order of the scan, each in its sensor's frame. The result is valid until
    /// the next call.
    const RelationMatch &operator()(const Segments &reference, const Segments &current);
    /// Matches with what was the current scan of the call before: its relations are known already,
    /// by the settings of that call. Where the windows or bounds changed since, call with both scans instead.
    const RelationMatch &next(const Segments &current);

private:
    using Pairs = std::vector<CorrespondencePair>;
    static constexpr int mostPairs = 48; ///< of the last search

    struct Place {
        Transformation2D pose;
        double evidence = 0; // metres
    };

    void clear();
    const RelationMatch &end(RelationOutcome outcome);
    const RelationMatch &match();
    static double lengthOf(const Segments &segments);
    // As published; also what is wrong where it leads nowhere.
    RelationOutcome searchFirst();
    // Without the pairs that were found before; false when nothing is left.
    bool searchAgain();
    const Pairs &search(MatchingTable &table, double threshold);
    // Where all that failed: any pairs that are consistent, the longest first.
    void searchAll();
    // The places of these pairs; false when there is none.
    bool place(const Pairs &found, int most);
    // Takes a place for the result if more speaks for it than for those before; keeps all as rivals.
    bool judge(const Transformation2D &pose);
    void take(const Transformation2D &pose, double evidence);
    double rivalEvidence() const;
    bool isFound(const Transformation2D &pose) const;

    RelationScan reference_, current_;
    RelationScores score_;
    MatchingTable table_, first_, again_;
    Pairs all_;
    PairSearch search_;
    PairConsensus consensus_;
    SeenThrough seenThrough_;
    MatchSigns signs_;
    std::vector<Place> places_;
    bool isUnspecific_ = false; // a place was found that too little tells
    double leastSeen_ = 0;      // length of all segments of the scan that has less; metres
    RelationMatch result_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/RelationMatcher.cpp")
