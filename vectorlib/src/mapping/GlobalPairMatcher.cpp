#include "vectorlib/mapping/GlobalPairMatcher.h"
#include "vectorlib/geometry/SmallMatrix.h"

namespace vectorlib {

VECTORLIB_BODY const char *describe(GlobalPairVerdict verdict) {
    static constexpr const char *texts[] = {"found",
                                            "several motions fit alike",
                                            "the scans slide on each other, as along a corridor",
                                            "no motion explains enough of what the scans show",
                                            "the static scan shows too few surfaces",
                                            "the dynamic scan shows too few surfaces"};
    return texts[static_cast<int>(verdict)]; // in the order of the enumeration
}

VECTORLIB_BODY MatchProbability::Features MatchProbability::features(const GlobalPairMatch &match) {
    const SurfaceAgreement &a = match.solutions[0].agreement;
    const double judged = a.explained() + a.contradicted();
    return {1, judged > 0 ? a.contradicted() / judged : 1, std::clamp(match.slideLoss, -0.1, 0.25),
            std::log(std::max(0.3, a.explained() * a.length())), a.score()};
}

VECTORLIB_BODY double MatchProbability::ofAny(const Features &f) const {
    double sum = 0;
    for (std::size_t i = 0; i < f.size(); ++i)
        sum += weights[i] * f[i];
    return ceiling / (1 + std::exp(-sum));
}

VECTORLIB_BODY void MatchProbability::operator()(GlobalPairMatch &match) const {
    if (match.solutions.empty())
        return;
    const double any = ofAny(features(match));
    double total = 0, best = -1;
    for (const GlobalPairSolution &s : match.solutions)
        best = std::max(best, fit(s));
    for (GlobalPairSolution &s : match.solutions)
        total += s.probability = std::exp(sharpness * (fit(s) - best));
    for (GlobalPairSolution &s : match.solutions)
        s.probability *= any / total;
}

VECTORLIB_BODY const GlobalPairMatch &
GlobalPairMatcher::judge(PointSpan<float> fixed, PointSpan<float> moving, const Transformation2D &pose) {
    if (take(fixed, moving) && pose.isFinite()) {
        match_.solutions.push_back(judged(pose, settings.deviation, allPoints));
        match_.slideLoss = slideLossOf(match_.solutions[0]);
        conclude();
    }
    return match_;
}

VECTORLIB_BODY Eigen::Matrix3d GlobalPairMatcher::covarianceOf(const GlobalPairSolution &s) const {
    Eigen::Matrix3d covariance = tellCovariance(refine, s.pose);
    if (match_.slideLoss < settings.openMargin) { // what seems to hold the scans there is noise
        const Vector2D<double> way = s.agreement.walls().weakest();
        const double half = 2 * settings.slideStep;
        covariance += square(half * half, Eigen::Vector3d(way.x, way.y, 0));
    }
    return covariance;
}

VECTORLIB_BODY bool GlobalPairMatcher::take(PointSpan<float> fixed, PointSpan<float> moving) {
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

VECTORLIB_BODY const GlobalPairMatch &GlobalPairMatcher::found(PointSpan<float> fixed,
                                                               PointSpan<float> moving, bool mayBeWide) {
    if (take(fixed, moving)) {
        find(mayBeWide);
        conclude();
    }
    return match_;
}

VECTORLIB_BODY void GlobalPairMatcher::find(bool mayBeWide) {
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

VECTORLIB_BODY void GlobalPairMatcher::conclude() {
    if (match_.solutions.empty())
        return;
    tellProbability(match_);
    match_.verdict = verdict();
}

VECTORLIB_BODY void GlobalPairMatcher::search(const GlobalSearchEffort &effort) {
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

VECTORLIB_BODY void GlobalPairMatcher::refineBest(const GlobalSearchEffort &effort) {
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

VECTORLIB_BODY bool GlobalPairMatcher::isNew(const GlobalPairSolution &s) const {
    return std::all_of(match_.solutions.begin(), match_.solutions.end(),
                       [&](const GlobalPairSolution &k) { return isFar(k, s); });
}

VECTORLIB_BODY bool GlobalPairMatcher::convinces() const {
    const Solutions &s = match_.solutions;
    if (s.empty() || s[0].score < settings.convincing || hasRival(settings.possibleMargin))
        return false;
    return s.size() < 2 || s[0].score - s[1].score >= settings.lead;
}

VECTORLIB_BODY GlobalPairSolution GlobalPairMatcher::judged(const Transformation2D &pose, double deviation,
                                                            int points) const {
    const int most = std::max(refine.fixed().size(), refine.moving().size());
    GlobalPairSolution s;
    s.pose = pose;
    s.agreement = SurfaceAgreement({refine.fixed(), fixed_}, {refine.moving(), moving_}, pose, deviation,
                                   1 + most / (points + 1));
    s.score = s.agreement.score();
    return s;
}

VECTORLIB_BODY void GlobalPairMatcher::keepDistinct(Solutions &list) const {
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

VECTORLIB_BODY void GlobalPairMatcher::slide() {
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

VECTORLIB_BODY void GlobalPairMatcher::followOpenDirection() {
    constexpr int most = 40; // to each side
    const double least = match_.solutions[0].score - settings.slideMargin, step = 2 * settings.slideStep;
    candidates_.clear();
    for (const GlobalPairSolution &start : match_.solutions) {
        const bool followed = std::any_of(candidates_.begin(), candidates_.end(), [&](const auto &s) {
            return isNear({0, 0, s.pose.alpha()}, {0, 0, start.pose.alpha()}, 1, settings.farAlpha);
        });
        if (start.score < least || followed || candidates_.size() > maxFollowed)
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

VECTORLIB_BODY GlobalPairVerdict GlobalPairMatcher::verdict() const {
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

} // namespace vectorlib
