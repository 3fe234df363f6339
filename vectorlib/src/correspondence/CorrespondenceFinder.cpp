#include "vectorlib/correspondence/CorrespondenceFinder.h"

namespace vectorlib {

VECTORLIB_BODY int SegmentMap::add(const LineSegment2D<double> &segment) {
    const int number = static_cast<int>(segments_.size());
    segments_.push_back(segment);
    if (segment.isFinite() && segment.length() <= longest)
        grid_.insert(number, segment);
    else if (segment.isFinite())
        long_.push_back(number);
    return number;
}

VECTORLIB_BODY const std::vector<int> &SegmentMap::near(Vector2D<double> middle, double reach) {
    found_.clear();
    if (!middle.isFinite() || !(reach >= 0))
        return found_;
    const Vector2D<double> half(reach, reach);
    if (reach * reach > cell * cell * (1 + double(segments_.size()))) // fewer segments than cells
        for (std::size_t i = 0; i < segments_.size(); ++i)
            found_.push_back(static_cast<int>(i));
    else {
        found_ = long_;
        grid_.query(middle - half, middle + half, [this](int number) { found_.push_back(number); });
        std::sort(found_.begin(), found_.end());
    }
    return found_;
}

VECTORLIB_BODY void ExpectedViewTest::setFixed(const Segments &fixed, const Transformation2D *seenFrom) {
    fixed_ = &fixed;
    obstacles_.clear();
    if (!seenFrom)
        return;
    for (const LineSegment2D<double> &border : frontier_(observe_(fixed, seenFrom->pose())))
        obstacles_.push_back(*seenFrom * border);
}

VECTORLIB_BODY void ExpectedViewTest::setMoving(const Segments &moving) {
    observed_ = observe_(moving, {});
    observedAngle_ = 0;
    for (const VisiblePart<double> &part : observed_) {
        const Vector2D<double> begin = part.segment.begin(), end = part.segment.end();
        observedAngle_ += std::atan2(begin.cross(end), begin.dot(end));
    }
}

VECTORLIB_BODY const SearchResult &CorrespondenceFinder::operator()(const Segments &fixed,
                                                                    const Segments &moving,
                                                                    const Transformation2D &expected) {
    if (start(moving, expected)) {
        for (std::size_t i = 0; i < fixed.size(); ++i)
            fixed_.take(toLocal_ * fixed[i], static_cast<int>(i));
        search(&toLocal_);
    }
    return result_;
}

VECTORLIB_BODY const SearchResult &CorrespondenceFinder::operator()(SegmentMap &map, const Segments &moving,
                                                                    const Transformation2D &expected) {
    if (start(moving, expected)) {
        double reach = 0;
        for (const LineSegment2D<double> &s : moving_.segments)
            reach = std::max({reach, s.begin().norm(), s.end().norm()});
        reach += std::hypot(settings.permitted.dx, settings.permitted.dy);
        for (int number : map.near(expected.translation(), reach))
            fixed_.take(toLocal_ * map[number], number);
        search(nullptr);
    }
    return result_;
}

VECTORLIB_BODY bool CorrespondenceFinder::start(const Segments &moving, const Transformation2D &expected) {
    spare_.insert(spare_.end(), std::make_move_iterator(result_.solutions.begin()),
                  std::make_move_iterator(result_.solutions.end()));
    result_.solutions.clear();
    result_.outcome = SearchOutcome::BadSettings;
    result_.potentialPairs = result_.bundles = result_.buckets = result_.combinations = 0;
    fixed_.clear();
    moving_.clear();
    if (!settings.isGood() || !expected.isFinite())
        return false;
    for (std::size_t i = 0; i < moving.size(); ++i)
        moving_.take(moving[i], static_cast<int>(i));
    expected_ = expected;
    toLocal_ = expected.inverse();
    return true;
}

VECTORLIB_BODY void CorrespondenceFinder::search(const Transformation2D *seenFrom) {
    result_.outcome = findCombinations();
    if (combinations_->empty())
        return;
    view_.setFixed(fixed_.segments, seenFrom);
    view_.setMoving(moving_.segments);
    for (const Combination &c : *combinations_)
        judge(select_(pairs_, fixed_.segments, moving_.segments, c.transformation));
    std::sort(result_.solutions.begin(), result_.solutions.end(), [](const Solution &a, const Solution &b) {
        return a.accepted != b.accepted ? a.accepted : a.score > b.score;
    });
}

VECTORLIB_BODY SearchOutcome CorrespondenceFinder::findCombinations() {
    combinations_ = &none_;
    if (moving_.segments.empty())
        return SearchOutcome::NothingMoving;
    if (fixed_.segments.empty())
        return SearchOutcome::NothingFixed;
    const bool isWithinBounds = collect_(fixed_.segments, moving_.segments, settings, pairs_);
    result_.potentialPairs = pairs_.size();
    if (!isWithinBounds)
        return SearchOutcome::TooManyPairs;
    if (pairs_.empty())
        return SearchOutcome::NoPotentialPair;
    bundle_.reliability = buckets_.reliability = combine_.reliability = settings.reliability;
    bundle_.ambiguity = combine_.ambiguity = settings.ambiguity;
    bundle_.stiffness = settings.stiffness;
    combine_.keep = settings.maxSolutions;
    combine_.most = settings.maxCombinations;
    const std::vector<Bundle> &bundles = bundle_(pairs_);
    buckets_(bundles);
    combinations_ = &combine_(buckets_);
    result_.bundles = bundles.size();
    result_.buckets = buckets_.size();
    result_.combinations = combine_.tried();
    return combine_.isCut()          ? SearchOutcome::Cut
           : !combinations_->empty() ? SearchOutcome::Complete
           : result_.buckets < 2     ? SearchOutcome::OneDirection
                                     : SearchOutcome::NoCombination;
}

VECTORLIB_BODY void CorrespondenceFinder::judge(const Transformation2D &t) {
    if (!t.isFinite() || select_.pairs().size() < 2)
        return;
    const Transformation2D pose = expected_ * t;
    for (const Solution &other : result_.solutions)
        if (combine_.same(other.pose, pose))
            return;
    Solution s = emptySolution();
    s.pose = pose;
    measure(s, t);
    s.view = view_(t);
    s.fault = faultOf(s, t);
    s.accepted = s.fault == Fault::None;
    s.score = s.view.angle > 0
                  ? s.matchedShare * s.reliability * s.view.common / (s.view.common + s.view.discrepancy) /
                        (1 + s.ambiguity / std::max(settings.ambiguity, 1e-12))
                  : 0;
    result_.solutions.push_back(std::move(s));
}

VECTORLIB_BODY Fault CorrespondenceFinder::faultOf(const Solution &s, const Transformation2D &t) const {
    if (!(s.reliability >= settings.reliability))
        return Fault::Reliability;
    if (!(s.ambiguity <= settings.ambiguity))
        return Fault::Ambiguity;
    if (!(s.matchedShare >= settings.matchedShare))
        return Fault::MatchedShare;
    if (!settings.isEvidence(s.view, view_.observedAngle()))
        return Fault::NoEvidence;
    if (!(s.view.discrepancy <= std::max(settings.discrepancy, settings.discrepancyShare * s.view.common)))
        return Fault::Discrepancy;
    return settings.permitted.holds(t) ? Fault::None : Fault::NotPermitted;
}

VECTORLIB_BODY void CorrespondenceFinder::measure(Solution &s, const Transformation2D &t) {
    sums_.clear();
    isMatched_.assign(moving_.segments.size(), 0);
    for (const CorrespondencePair &p : select_.pairs()) {
        const auto f = static_cast<std::size_t>(p.fixed), m = static_cast<std::size_t>(p.moving);
        const LineSegment2D<double> &fixed = fixed_.segments[f], &moving = moving_.segments[m];
        const double weight = std::min(fixed.length(), moving.length());
        sums_.add(fixed, moving, weight);
        s.ambiguity += weight * PairSelection::energy(fixed, t * moving, settings.stiffness);
        s.pairs.push_back({fixed_.numbers[f], moving_.numbers[m]});
        isMatched_[m] = 1;
    }
    s.ambiguity /= sums_.weight();
    s.reliability = sums_.reliability();
    double matched = 0, all = 0;
    for (std::size_t m = 0; m < isMatched_.size(); ++m) {
        all += moving_.segments[m].length();
        matched += isMatched_[m] ? moving_.segments[m].length() : 0;
    }
    s.matchedShare = matched / all;
}

VECTORLIB_BODY Solution CorrespondenceFinder::emptySolution() {
    Solution s;
    if (!spare_.empty()) {
        s.pairs = std::move(spare_.back().pairs);
        s.pairs.clear();
        spare_.pop_back();
    }
    return s;
}

} // namespace vectorlib
