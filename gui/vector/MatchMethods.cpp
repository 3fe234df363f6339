#include "gui/vector/MatchMethods.h"

#include "common/progress/Progress.h"
#include "vectorlib/correspondence/SearchResult.h"
#include "vectorlib/mapping/GlobalPairMatcher.h"
#include "vectorlib/mapping/ScanPairMatcher.h"
#include "vectorlib/observation/SimulatedScanner.h"
#include "vectorlib/relations/RelationMatcher.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

namespace hermes::vector {

using vectorlib::GlobalPairMatch;
using vectorlib::SearchResult;
using vectorlib::Solution;
using vectorlib::Transformation2D;

namespace {

bool isScan(const SegmentSet &set) {
    return set.kind == SegmentSet::Kind::Points;
}

/// The points of a set; of segments those that a scanner would see from where they were seen.
std::vector<vectorlib::Vector2D<float>> pointsOf(const SegmentSet &set) {
    if (isScan(set))
        return set.points;
    std::vector<vectorlib::LineSegment2D<float>> walls;
    for (const vectorlib::LineSegment2D<double> &s : set.segments())
        walls.emplace_back(vectorlib::Vector2D<float>(s.begin()), vectorlib::Vector2D<float>(s.end()));
    vectorlib::SimulatedScanner<float> scan;
    scan.sigma = 0;
    return scan(walls, {});
}

/// Which segments lie on each other under a motion that was found without them, and what they say of it.
class SegmentsUnderMotion {
public:
    SegmentsUnderMotion(const SegmentSet &fixed, const SegmentSet &moving)
        : fixed_(fixed)
        , moving_(moving) {
        find_.settings.permitted = {0.1, 0.1, 0.05};
    }
    /// Takes what the search for segments tells, but leaves the pose and the verdict of a match of points.
    void addTo(MatchedSolution &matched) {
        const Transformation2D pose = matched.solution.pose;
        const SearchResult &found = find_(fixed_.segments(), moving_.segments(), pose);
        potentialPairs = found.potentialPairs;
        combinations = found.combinations;
        if (found.solutions.empty())
            return;
        const Solution own = matched.solution;
        matched.solution = found.solutions[0];
        matched.solution.accepted = own.accepted;
        matched.solution.score = own.score;
        if (isScan(fixed_) || isScan(moving_))
            matched.solution.pose = own.pose;
        if (!matched.covariance || !(isScan(fixed_) || isScan(moving_)))
            matched.covariance =
                vectorlib::SolutionCovariance()(found.solutions[0], fixed_.measured, moving_.measured);
    }
    std::size_t potentialPairs = 0;
    std::uint64_t combinations = 0;

private:
    const SegmentSet &fixed_, &moving_;
    vectorlib::CorrespondenceFinder find_;
};

MatchedSolution solutionOf(const vectorlib::GlobalPairSolution &s, const Eigen::Matrix3d &covariance,
                           bool accepted, const std::string &verdict) {
    MatchedSolution m;
    m.solution.pose = s.pose;
    m.solution.score = s.score;
    m.solution.reliability = s.agreement.walls().reliability();
    m.solution.accepted = accepted;
    m.verdict = accepted ? "accepted" : verdict;
    m.probability = s.probability;
    m.covariance = covariance;
    return m;
}

/// The solutions of a matcher's last match in the given form, with their segments.
Matched matchedOf(const GlobalPairMatch &match, const vectorlib::GlobalPairMatcher &matcher,
                  const SegmentSet &fixed, const SegmentSet &moving) {
    Matched result;
    result.outcome = outcomeOf(match.verdict);
    result.reason = describe(match.verdict);
    SegmentsUnderMotion segments(fixed, moving);
    Progress progress("comparing segments, solution");
    progress.update(0, double(match.solutions.size()));
    for (const vectorlib::GlobalPairSolution &s : match.solutions) {
        const bool best = result.solutions.empty();
        const std::string verdict = best ? result.reason : "another solution fits better";
        result.solutions.push_back(
            solutionOf(s, matcher.covarianceOf(s), best && match.isAccepted(), verdict));
        segments.addTo(result.solutions.back());
        if (best) {
            result.potentialPairs = segments.potentialPairs;
            result.combinations = segments.combinations;
        }
        progress.update(double(result.solutions.size()), double(match.solutions.size()));
    }
    return result;
}

/// The angle over which the points of a scan go round the sensor, counter-clockwise; radians.
double turnOf(const std::vector<vectorlib::Vector2D<float>> &scan) {
    double turn = 0;
    for (std::size_t i = 1; i < scan.size(); ++i)
        turn += std::atan2(scan[i - 1].cross(scan[i]), scan[i - 1].dot(scan[i]));
    return turn;
}

using TypedSegments = std::vector<vectorlib::TypedSegment>;

double lengthOf(const TypedSegments &segments) {
    double length = 0;
    for (const vectorlib::TypedSegment &s : segments)
        length += s.segment.length();
    return length;
}

TypedSegments typedSegmentsOf(const SegmentSet &set) {
    if (isScan(set)) {
        constexpr double nearlyAll = 1.9 * vectorlib::pi;
        const double turn = turnOf(set.points);
        vectorlib::TypedSegmentExtractor extract;
        extract.setScanner(turn > 0 && turn < nearlyAll ? turn : 2 * vectorlib::pi, set.points.size());
        return extract(set.points);
    }
    TypedSegments result;
    for (const vectorlib::LineSegment2D<double> &s : set.segments()) {
        result.emplace_back();
        result.back().segment = s;
    }
    return result;
}

} // namespace

Matched matchByFinder(const SegmentSet &fixed, const SegmentSet &moving,
                      const vectorlib::SearchSettings &settings, const Transformation2D &around, bool inMap) {
    vectorlib::CorrespondenceFinder find;
    find.settings = settings;
    vectorlib::SegmentMap map;
    for (std::size_t i = 0; inMap && i < fixed.segments().size(); ++i)
        map.add(fixed.segments()[i]);
    const SearchResult &found =
        inMap ? find(map, moving.segments(), around) : find(fixed.segments(), moving.segments(), around);
    Matched result{"finder", outcomeOf(found), reasonOf(found), found.potentialPairs, found.combinations, {}};
    for (const Solution &s : found.solutions)
        result.solutions.push_back({s, describe(s.fault), std::nullopt,
                                    vectorlib::SolutionCovariance()(s, fixed.measured, moving.measured)});
    return result;
}

Matched matchGlobally(const SegmentSet &fixed, const SegmentSet &moving, double noise) {
    vectorlib::GlobalPairMatcher match;
    if (noise > 0)
        match.tellCovariance.noise = noise;
    const GlobalPairMatch &found = match(pointsOf(fixed), pointsOf(moving));
    Matched result = matchedOf(found, match, fixed, moving);
    result.method = "global";
    return result;
}

Matched matchByRelations(const SegmentSet &fixed, const SegmentSet &moving) {
    vectorlib::RelationMatcher match;
    const TypedSegments reference = typedSegmentsOf(fixed), current = typedSegmentsOf(moving);
    const vectorlib::RelationMatch &found = match(reference, current);
    Matched result{"relations", outcomeOf(found.outcome), reasonOf(found.outcome), 0, 0, {}};
    if (!found.isMatched() && found.outcome != vectorlib::RelationOutcome::Ambiguous)
        return result;
    MatchedSolution s;
    s.solution.pose = found.pose;
    s.solution.score = found.evidence / std::min(lengthOf(reference), lengthOf(current));
    s.solution.reliability = found.reliability;
    s.solution.ambiguity = found.ambiguity;
    s.solution.accepted = found.isMatched();
    s.verdict = found.isMatched() ? "accepted" : result.reason;
    SegmentsUnderMotion segments(fixed, moving);
    segments.addTo(s);
    result.potentialPairs = segments.potentialPairs;
    result.combinations = segments.combinations;
    result.solutions.push_back(s);
    return result;
}

Matched matchTracking(const SegmentSet &fixed, const SegmentSet &moving, const MatchExpectation &expected,
                      const vectorlib::EarSettings &segmentation, double noise) {
    vectorlib::ScanPairMatcher track;
    track.settings.deviationXY = expected.deviationXY;
    track.settings.deviationAlpha = expected.deviationAlpha;
    if (expected.deviationXY > 0.5 || expected.deviationAlpha > 0.3) // hardly more than a guess
        track.settings.lines = track.settings.wideLines;
    track.extract.segment.settings = segmentation;
    const vectorlib::ScanPairMatch &tracked = track(fixed.points, moving.points, expected.pose);
    vectorlib::GlobalPairMatcher judge;
    if (noise > 0)
        judge.tellCovariance.noise = noise;
    Matched result = matchedOf(judge.judge(fixed.points, moving.points, tracked.pose), judge, fixed, moving);
    result.method = "tracking";
    if (result.solutions.empty()) { // too little to be judged
        result.solutions.emplace_back();
        result.solutions[0].solution.pose = tracked.pose;
    }
    if (tracked.accepted)
        result.outcome = MatchOutcome::Found;
    else if (result.outcome != MatchOutcome::OpenDirection && result.outcome != MatchOutcome::TooLittle) {
        result.outcome = MatchOutcome::Nowhere;
        result.reason = "too little agrees near the expected motion";
    }
    for (MatchedSolution &s : result.solutions) {
        s.solution.accepted = tracked.accepted;
        s.verdict = tracked.accepted ? "accepted" : result.reason;
    }
    return result;
}

} // namespace hermes::vector
