#pragma once

#include "vectorlib/correspondence/ShiftVotes.h"
#include "vectorlib/correspondence/TurnVotes.h"
#include "vectorlib/mapping/MatchProbability.h"
#include "vectorlib/registration/PointCovariance.h"
#include "vectorlib/registration/SurfaceRefinement.h"

namespace vectorlib {

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
                                 const Transformation2D &pose) {
        if (take(fixed, moving) && pose.isFinite()) {
            match_.solutions.push_back(judged(pose, settings.deviation, allPoints));
            match_.slideLoss = slideLossOf(match_.solutions[0]);
            conclude();
        }
        return match_;
    }
    /// Of x, y (metres, frame of the first scan) and alpha (radians) of a solution of the last match, if it
    /// is the right one; see PointCovariance.
    Eigen::Matrix3d covarianceOf(const GlobalPairSolution &s) const {
        Eigen::Matrix3d covariance = tellCovariance(refine, s.pose);
        if (match_.slideLoss < settings.openMargin) { // what seems to hold the scans there is noise
            const Vector2D<double> way = s.agreement.openDirection();
            const double half = 2 * settings.slideStep;
            covariance += square(half * half, Eigen::Vector3d(way.x, way.y, 0));
        }
        return covariance;
    }

private:
    using Solutions = std::vector<GlobalPairSolution>;

    bool take(PointSpan<float> fixed, PointSpan<float> moving) {
        match_.solutions.clear();
        match_.searchedWidely = false;
        match_.slideLoss = 0;
        match_.verdict = GlobalPairVerdict::TooUnlike;
        refine.start(fixed, moving);
        fixed_.build(refine.fixed());
        moving_.build(refine.moving());
        if (fixed_.pieces().size() < settings.minPieces)
            match_.verdict = GlobalPairVerdict::NothingFixed;
        else if (moving_.pieces().size() < settings.minPieces)
            match_.verdict = GlobalPairVerdict::NothingMoving;
        return match_.verdict == GlobalPairVerdict::TooUnlike;
    }
    const GlobalPairMatch &found(PointSpan<float> fixed, PointSpan<float> moving, bool mayBeWide) {
        if (take(fixed, moving)) {
            find(mayBeWide);
            conclude();
        }
        return match_;
    }
    void find(bool mayBeWide) {
        reach_ = std::max(settings.reach,
                          settings.reachByRange * std::max(fixed_.medianRange(), moving_.medianRange()));
        refineRoughly.start(fixed_, moving_);
        shifts_.start(fixed_, moving_, reach_);
        search(settings.quick);
        if (mayBeWide && !convinces()) {
            match_.searchedWidely = true;
            search(settings.wide);
        }
        if (match_.solutions.empty())
            return;
        slide();
        if (match_.slideLoss < settings.openMargin)
            followOpenDirection();
    }
    void conclude() {
        if (match_.solutions.empty())
            return;
        tellProbability(match_);
        match_.verdict = verdict();
    }
    void search(const GlobalSearchEffort &effort) {
        votes_.clear();
        for (const TurnVote &turn : turns_(fixed_, moving_, effort.turns))
            shifts_(turn.degrees, votes_);
        std::sort(votes_.begin(), votes_.end(),
                  [](const MotionVote &a, const MotionVote &b) { return a.votes > b.votes; });
        if (votes_.size() > effort.candidates)
            votes_.resize(effort.candidates);
        candidates_.clear();
        for (const MotionVote &vote : votes_)
            candidates_.push_back(
                judged(refineRoughly(vote.pose), settings.roughDeviation, settings.roughPoints));
        keepDistinct(candidates_);
        refineBest(effort);
    }
    // Rivals explain less than what is refined before them, and are far from it.
    void refineBest(const GlobalSearchEffort &effort) {
        std::size_t found = 0;
        match_.solutions.clear();
        for (std::size_t i = 0; i < candidates_.size() && found < effort.rivals; ++i) {
            const GlobalPairSolution &c = candidates_[i];
            const bool isHopeful = i < effort.refined && c.score >= candidates_[0].score - settings.hopeless;
            const bool other = !isHopeful && isNew(c) && isRival(c, candidates_[0], settings.possibleMargin);
            if (isHopeful || other)
                match_.solutions.push_back(refined(c.pose));
            else if (i < effort.refined && isNew(c))
                match_.solutions.push_back(judged(c.pose, settings.deviation, settings.slidePoints));
            found += other;
        }
        keepDistinct(match_.solutions);
    }
    bool isFar(const GlobalPairSolution &a, const GlobalPairSolution &b) const {
        return !isNear(a.pose, b.pose, settings.farXY, settings.farAlpha);
    }
    bool isNew(const GlobalPairSolution &s) const {
        return std::all_of(match_.solutions.begin(), match_.solutions.end(),
                           [&](const GlobalPairSolution &k) { return isFar(k, s); });
    }
    bool isRival(const GlobalPairSolution &s, const GlobalPairSolution &best, double margin) const {
        return isFar(s, best) && s.agreement.consistency() > best.agreement.consistency() - margin;
    }
    bool hasRival(double margin) const {
        const Solutions &all = match_.solutions;
        return std::any_of(all.begin(), all.end(), [&](const auto &s) { return isRival(s, all[0], margin); });
    }
    bool convinces() const {
        const Solutions &s = match_.solutions;
        if (s.empty() || s[0].score < settings.convincing || hasRival(settings.possibleMargin))
            return false;
        return s.size() < 2 || s[0].score - s[1].score >= settings.lead;
    }

    // By about so many points of each scan.
    GlobalPairSolution judged(const Transformation2D &pose, double deviation, int points) const {
        const int most = std::max(refine.fixed().size(), refine.moving().size());
        GlobalPairSolution s;
        s.pose = pose;
        s.agreement = SurfaceAgreement({refine.fixed(), fixed_}, {refine.moving(), moving_}, pose, deviation,
                                       1 + most / (points + 1));
        s.score = s.agreement.score();
        return s;
    }
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
    void keepDistinct(Solutions &list) const {
        std::sort(list.begin(), list.end(),
                  [](const GlobalPairSolution &a, const GlobalPairSolution &b) { return a.score > b.score; });
        std::size_t kept = 0;
        for (const GlobalPairSolution &s : list) {
            const auto isKept = [&](const GlobalPairSolution &k) { return isSame(k.pose, s.pose); };
            const auto end = list.begin() + static_cast<std::ptrdiff_t>(kept);
            if (std::none_of(list.begin(), end, isKept))
                list[kept++] = s;
        }
        list.resize(kept);
    }

    GlobalPairSolution slid(const GlobalPairSolution &from, double metres) const {
        const Vector2D<double> t = from.pose.translation() + from.agreement.openDirection() * metres;
        return judged({t.x, t.y, from.pose.alpha()}, settings.deviation, settings.slidePoints);
    }
    double slideLossOf(const GlobalPairSolution &s) const {
        const double own = judged(s.pose, settings.deviation, settings.slidePoints).score;
        return own - std::max(slid(s, 2 * settings.slideStep).score, slid(s, -2 * settings.slideStep).score);
    }
    // Where the best solution is held least, places beside it may be better, and how much worse they are
    // tells how firmly it is held at all.
    void slide() {
        const GlobalPairSolution best = match_.solutions[0];
        const double own = judged(best.pose, settings.deviation, settings.slidePoints).score;
        double farther = -1;
        for (int way : {-2, -1, 1, 2}) {
            const GlobalPairSolution other = slid(best, way * settings.slideStep);
            if (way == -2 || way == 2)
                farther = std::max(farther, other.score);
            if (other.score > own - settings.slideMargin)
                match_.solutions.push_back(refined(other.pose));
        }
        keepDistinct(match_.solutions);
        match_.slideLoss =
            isSame(match_.solutions[0].pose, best.pose) ? own - farther : slideLossOf(match_.solutions[0]);
    }
    // Along a corridor all places are solutions, as far as the scans go on fitting; and, turned round,
    // others.
    void followOpenDirection() {
        constexpr int most = 40; // to each side
        const double least = match_.solutions[0].score - settings.slideMargin, step = 2 * settings.slideStep;
        candidates_.clear();
        for (const GlobalPairSolution &start : match_.solutions) {
            const bool followed = std::any_of(candidates_.begin(), candidates_.end(), [&](const auto &s) {
                return isNear({0, 0, s.pose.alpha()}, {0, 0, start.pose.alpha()}, 1, settings.farAlpha);
            });
            if (start.score < least || followed || candidates_.size() > mostFollowed)
                continue;
            candidates_.push_back(start);
            for (double side : {-step, step})
                for (int i = 1; i <= most; ++i) {
                    const GlobalPairSolution other = slid(start, i * side);
                    if (other.score < least)
                        break;
                    candidates_.push_back(other);
                }
        }
        match_.solutions.insert(match_.solutions.end(), candidates_.begin(), candidates_.end());
        keepDistinct(match_.solutions);
    }
    GlobalPairVerdict verdict() const {
        const GlobalPairSolution &best = match_.solutions[0];
        const double explained = best.agreement.explained(), contradicted = best.agreement.contradicted();
        if (best.score < settings.minScore ||
            contradicted > settings.maxContradicted * (explained + contradicted))
            return GlobalPairVerdict::TooUnlike;
        if (match_.slideLoss < settings.openMargin)
            return GlobalPairVerdict::OpenDirection;
        double any = 0;
        for (const GlobalPairSolution &s : match_.solutions)
            any += s.probability;
        if (hasRival(settings.rivalMargin) || (best.probability < settings.enough && any >= settings.enough))
            return GlobalPairVerdict::Ambiguous;
        return any >= settings.enough ? GlobalPairVerdict::Found : GlobalPairVerdict::TooUnlike;
    }

    static constexpr int allPoints = 1 << 20;
    static constexpr std::size_t mostFollowed = 100; // solutions; then no further heading

    ScanSurface fixed_, moving_;
    TurnVotes turns_;
    ShiftVotes shifts_;
    std::vector<MotionVote> votes_;
    Solutions candidates_;
    float reach_ = 0;
    GlobalPairMatch match_;
};

} // namespace vectorlib
