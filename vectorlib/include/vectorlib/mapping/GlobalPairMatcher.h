#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Votes.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/PointRefinement.h"
#include "vectorlib/registration/RegistrationCovariance.h"
#include "vectorlib/registration/ScanSurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vectorlib {

/// A motion that may be the one between two scans.
struct GlobalPairSolution {
    Transformation2D pose;      ///< of the second scan's sensor in the frame of the first
    SurfaceAgreement agreement; ///< of both scans
    double score = 0;           ///< that of the agreement; solutions are ranked by it
    double probability = 0;     ///< that the motion is within 10 cm and 2 degrees; see MatchProbability
};

/// What is known of the motion between two scans.
enum class GlobalPairVerdict {
    Found,         ///< the first solution is to be trusted
    Ambiguous,     ///< several motions fit alike: look at all solutions
    OpenDirection, ///< the scans slide on each other, as along a corridor: solutions stand all along it
    TooUnlike,     ///< no motion explains enough
    NothingFixed,  ///< the first scan shows too few surfaces
    NothingMoving  ///< the second scan shows too few surfaces
};

/// The verdict in words, for people.
const char *describe(GlobalPairVerdict verdict);

/// The motion between two scans of which nothing else is known.
struct GlobalPairMatch {
    std::vector<GlobalPairSolution> solutions; ///< distinct ones, best first
    GlobalPairVerdict verdict = GlobalPairVerdict::TooUnlike;
    /// By how much the score falls when the best solution slides half a metre where it is held least.
    double slideLoss = 0;
    bool searchedWidely = false; ///< the first, quick search did not convince

    bool isAccepted() const { return verdict == GlobalPairVerdict::Found; }
};

/// How probable it is that a solution of a match without estimate is right: within 10 cm and 2 degrees of
/// corrected poses, whose own errors count as those of the match. A logistic function of how well the best
/// solution agrees, up to a ceiling, tells whether the right one is among them; powers of how well each of
/// them fits divide that among them: of two that fit alike each has half. It takes for granted that the scans
/// show the same place.
struct MatchProbability {
    using Features = std::array<double, 5>;

    /// Of the features. With the ceiling and the sharpness fitted to the first half of the
    /// pairs of five logs, neighbouring scans and ones farther apart, by hermes-vector experiment calibration
    /// --half 1 --log intel... (docs/pairs.md has all of it).
    Features weights{-3.92, -10.99, 12.39, 2.44, -3.19};
    double ceiling = 0.986;  ///< however well two scans agree: corrected poses have errors, too
    double sharpness = 36.7; ///< how much a difference of fit tells

    /// What tells whether the right solution is among those of a match that has some: a constant 1, the part
    /// that the best contradicts of what it explains or contradicts, what it loses by sliding, the logarithm
    /// of how many metres of surface it explains, and its score.
    static Features features(const GlobalPairMatch &match);
    /// Half of it counts what is out of the other scan's sight, half of it hardly does.
    static double fit(const GlobalPairSolution &s) {
        return (s.agreement.score() + s.agreement.consistency()) / 2;
    }
    /// That the right solution is among those of a match with these features.
    double ofAny(const Features &f) const;
    /// Sets the probability of every solution of a match; they add up to at most `ceiling`.
    void operator()(GlobalPairMatch &match) const;
};

/// How thoroughly motions are searched.
struct GlobalSearchEffort {
    std::size_t turns;      ///< rotations for which shifts are voted
    std::size_t candidates; ///< motions of most votes that are refined roughly
    std::size_t refined;    ///< the best of them, refined with all points
    std::size_t rivals;     ///< refined too: those that are as consistent, though they explain less
};

/// Settings of GlobalPairMatcher: how widely it searches, and when a motion is found.
struct GlobalPairSettings {
    GlobalSearchEffort quick{8, 12, 3, 1};
    GlobalSearchEffort wide{20, 64, 8, 4}; ///< where the quick search does not convince
    double convincing = 0.57;              ///< score of a quick search that is enough
    double lead = 0.15;                    ///< of score over any other, which it must have, too
    double hopeless = 0.25;       ///< what scores less than the best by so much is not refined further
    double sameXY = 0.10;         ///< solutions nearer to each other are one; metres
    double sameAlpha = 0.035;     ///< the same; radians
    double farXY = 0.5;           ///< rivals are solutions farther away; metres
    double farAlpha = 0.17;       ///< the same; radians
    float reach = 10;             ///< longest motion looked for in small places; metres
    float reachByRange = 2;       ///< and in larger ones, in median ranges of the scans
    double slideStep = 0.25;      ///< of trials along the direction that is held least; metres
    double slideMargin = 0.1;     ///< loss of score with which a trial is still a solution
    double openMargin = 0.05;     ///< loss with which half a metre farther is as good a place
    double rivalMargin = 0.09;    ///< of consistency; a rival that falls behind by less is as good
    double possibleMargin = 0.3;  ///< the same of one that is looked for
    double enough = 0.80;         ///< probability of a solution to be trusted
    double minScore = 0.4;        ///< the same, its score
    double maxContradicted = 0.2; ///< the same, the part contradicted of all that is judged
    std::size_t minPieces = 8;    ///< a scan with fewer pieces of surface shows too little
    double roughDeviation = 0.10, deviation = 0.05; ///< see SurfaceAgreement; metres
    int roughPoints = 60, slidePoints = 180;        ///< how many of a scan judge rough motions, and slides
};

/// Finds the motion between two scans of which nothing is known but the scans. The directions of surfaces
/// vote for rotations, pairs of pieces for the shifts after each; what gets most votes is brought together
/// roughly by its pieces, and the best of it exactly by the points. What a motion explains of both scans,
/// less what it contradicts, ranks them, as lengths of surface. Keeps its buffers between calls.
class GlobalPairMatcher {
public:
    GlobalPairSettings settings;
    PointRefinement refine;
    SurfaceRefinement refineRoughly;
    MatchProbability tellProbability;
    PointCovariance tellCovariance;

    /// Both scans in their sensor's frame, in the order of ScanOrder; metres. Valid until the next call.
    const GlobalPairMatch &operator()(PointSpan<float> fixed, PointSpan<float> moving) {
        return found(fixed, moving, true);
    }
    /// The same by the quick search alone: half of the time, where a pair that is not found is no loss.
    const GlobalPairMatch &quickly(PointSpan<float> fixed, PointSpan<float> moving) {
        return found(fixed, moving, false);
    }
    /// What speaks for a motion that is known from elsewhere: it is the only solution, as it is. No other
    /// motions are looked for.
    const GlobalPairMatch &judge(PointSpan<float> fixed, PointSpan<float> moving,
                                 const Transformation2D &pose);
    /// Of x, y (metres, frame of the first scan) and alpha (radians) of a solution of the last match, if it
    /// is the right one; see PointCovariance.
    Eigen::Matrix3d covarianceOf(const GlobalPairSolution &s) const;

private:
    using Solutions = std::vector<GlobalPairSolution>;

    bool take(PointSpan<float> fixed, PointSpan<float> moving);
    const GlobalPairMatch &found(PointSpan<float> fixed, PointSpan<float> moving, bool mayBeWide);
    void find(bool mayBeWide);
    void conclude();
    void search(const GlobalSearchEffort &effort);
    // Rivals explain less than what is refined before them, and are far from it.
    void refineBest(const GlobalSearchEffort &effort);
    bool isFar(const GlobalPairSolution &a, const GlobalPairSolution &b) const {
        return !isNear(a.pose, b.pose, settings.farXY, settings.farAlpha);
    }
    bool isNew(const GlobalPairSolution &s) const;
    bool isRival(const GlobalPairSolution &s, const GlobalPairSolution &best, double margin) const {
        return isFar(s, best) && s.agreement.consistency() > best.agreement.consistency() - margin;
    }
    bool hasRival(double margin) const {
        const Solutions &all = match_.solutions;
        return std::any_of(all.begin(), all.end(), [&](const auto &s) { return isRival(s, all[0], margin); });
    }
    bool convinces() const;

    // By about so many points of each scan.
    GlobalPairSolution judged(const Transformation2D &pose, double deviation, int points) const;
    GlobalPairSolution refined(const Transformation2D &pose) {
        const Expectation nothing{{}, 1e6, 1e6};
        return judged(refine(pose, nothing), settings.deviation, allPoints);
    }
    bool isSame(const Transformation2D &a, const Transformation2D &b) const {
        return isNear(a, b, settings.sameXY, settings.sameAlpha);
    }
    static bool isNear(const Transformation2D &a, const Transformation2D &b, double xy, double alpha) {
        return (a.translation() - b.translation()).squaredNorm() < xy * xy &&
               a.cos() * b.cos() + a.sin() * b.sin() > std::cos(alpha);
    }
    // Best first, and of those that are the same the best.
    void keepDistinct(Solutions &list) const;

    GlobalPairSolution slid(const GlobalPairSolution &from, double metres) const {
        const Vector2D<double> t = from.pose.translation() + from.agreement.walls().weakest() * metres;
        return judged({t.x, t.y, from.pose.alpha()}, settings.deviation, settings.slidePoints);
    }
    double slideLossOf(const GlobalPairSolution &s) const {
        const double own = judged(s.pose, settings.deviation, settings.slidePoints).score;
        return own - std::max(slid(s, 2 * settings.slideStep).score, slid(s, -2 * settings.slideStep).score);
    }
    // Where the best solution is held least, places beside it may be better, and how much worse they are
    // tells how firmly it is held at all.
    void slide();
    // Along a corridor all places are solutions, as far as the scans go on fitting; and, turned round,
    // others.
    void followOpenDirection();
    GlobalPairVerdict verdict() const;

    static constexpr int allPoints = 1 << 20;
    static constexpr std::size_t maxFollowed = 100; // solutions; then no further heading

    ScanSurface fixed_, moving_;
    TurnVotes turns_;
    ShiftVotes shifts_;
    std::vector<MotionVote> votes_;
    Solutions candidates_;
    float reach_ = 0;
    GlobalPairMatch match_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/GlobalPairMatcher.cpp")
