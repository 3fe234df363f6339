#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/MatchingTable.h"
#include "vectorlib/relations/PairConsensus.h"
#include "vectorlib/relations/RelationScan.h"
#include "vectorlib/relations/RelationScores.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"

#include <cstddef>
#include <vector>

namespace vectorlib {

/// The square of the length of the shorter: how precisely two segments tell an angle; m^2. Pose-free thesis
/// 5.6.1.
double precisionValue(const LineSegment2D<double> &a, const LineSegment2D<double> &b);

/// The rotation of matched segments, current onto reference; radians. Algorithm 8 with erratum 12: a circular
/// mean weighted by precision values, divided by their sum.
double rotationalDifference(const std::vector<CorrespondencePair> &pairs,
                            const std::vector<TypedSegment> &reference,
                            const std::vector<TypedSegment> &current);

/// The pose difference of two scans from matched segments: moves the current scan onto the reference.
/// Algorithms 8 and 9 with erratum 12: after the rotation the mean translation of the edges that both scans
/// have, each by the smaller precision value of the segments that form it. Without any such edge, of parallel
/// lines, the translation is 0 and the answer false.
bool poseDifference(const std::vector<CorrespondencePair> &pairs, const std::vector<TypedSegment> &reference,
                    const std::vector<TypedSegment> &current, double leastAngle, Transformation2D &pose);

/// How a match by relations ended.
enum class RelationOutcome {
    Matched,          ///< the pose is found
    BadSettings,      ///< a setting is negative, 0 where it must not be, too large or not a number
    TooFewReference,  ///< fewer than two usable segments in the reference scan
    TooFewCurrent,    ///< fewer than two usable segments in the current scan
    NoCommonRelation, ///< no relation of the current scan is found in the reference scan
    OnePair,          ///< only one pair of segments matches
    OneDirection,     ///< the matching segments are too nearly parallel to fix the place
    Contradiction,    ///< the matching segments agree on a rotation, but on no place
    Unspecific,       ///< too little matches to tell the place from others like it
    Ambiguous         ///< another place fits nearly as well
};

/// The outcome in words, for people.
const char *describe(RelationOutcome outcome);

/// The match of a current scan with a reference scan. Numbers in pairs are those of the segments as given.
struct RelationMatch {
    RelationOutcome outcome = RelationOutcome::NoCommonRelation;
    /// Moves the current scan onto the reference. Identity unless Matched or Ambiguous.
    Transformation2D pose;
    /// The same by common edges alone, as published (Algorithms 8 and 9), from all pairs of the table.
    Transformation2D byEdges;
    std::vector<CorrespondencePair> byScores; ///< all pairs that Algorithm 5 found, best first
    std::vector<CorrespondencePair> pairs; ///< all that lie on each other at the pose, whatever their scores
    double score = 0;                      ///< largest merged score
    double reliability = 0;                ///< in [0, 1], of the pairs' directions
    double ambiguity = 0;                  ///< mean of a pair, weighted by length; m^2
    double deviation = 0;                  ///< standard deviation of the position; metres
    double matchedLength = 0;              ///< of the shorter segments of the pairs; metres
    double evidence = 0;      ///< matched length less what stands where the other scan looked through; metres
    double rivalEvidence = 0; ///< the same of the best place elsewhere; metres
    std::size_t leftOut = 0;  ///< segments that are not finite, have no length, or are beyond the bound
    std::size_t virtualLeftOut = 0; ///< virtual edges beyond the bound
    bool isCut = false;             ///< a bound left out relations
    std::size_t scores = 0;         ///< entries of the matching table
    std::size_t compared = 0;       ///< comparisons of two relations: the work done

    bool isMatched() const { return outcome == RelationOutcome::Matched; }
};

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
    static constexpr int maxPairs = 48; ///< of the last search

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
    bool isFound(const Transformation2D &pose) const {
        const Transformation2D apart = result_.pose.inverse() * pose;
        return apart.translation().norm() <= 2 * settings.distanceWindow &&
               std::abs(apart.alpha()) <= 2 * settings.angleWindow;
    }

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
