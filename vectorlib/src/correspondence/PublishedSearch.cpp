#include "vectorlib/correspondence/PublishedSearch.h"

namespace vectorlib {

VECTORLIB_BODY const PublishedResult &
PublishedSearch::operator()(const Segments &fixed, const Segments &moving, const Transformation2D &expected) {
    result_ = PublishedResult();
    result_.search.outcome = SearchOutcome::BadSettings;
    if (!settings.isGood() || !expected.isFinite())
        return result_;
    const Transformation2D toLocal = expected.inverse();
    fixed_.clear();
    moving_.clear();
    for (std::size_t i = 0; i < fixed.size(); ++i)
        fixed_.take(toLocal * fixed[i], static_cast<int>(i));
    for (std::size_t i = 0; i < moving.size(); ++i)
        moving_.take(moving[i], static_cast<int>(i));
    result_.search.outcome = findCombinations();
    if (combinations_->empty())
        return result_;
    view_.setFixed(fixed_.segments, &toLocal);
    view_.setMoving(moving_.segments);
    for (const PublishedCombination &combination : *combinations_)
        judge(combination, expected);
    return result_;
}

VECTORLIB_BODY SearchOutcome PublishedSearch::findCombinations() {
    combinations_ = &none_;
    pairs_.clear();
    bundle_(pairs_);
    if (moving_.segments.empty())
        return SearchOutcome::NothingMoving;
    if (fixed_.segments.empty())
        return SearchOutcome::NothingFixed;
    const bool isWithinBounds = collect_(fixed_.segments, moving_.segments, settings, pairs_);
    SearchResult &told = result_.search;
    told.potentialPairs = pairs_.size();
    if (!isWithinBounds)
        return SearchOutcome::TooManyPairs;
    if (pairs_.empty())
        return SearchOutcome::NoPotentialPair;
    std::sort(pairs_.begin(), pairs_.end(), [](const PotentialPair &a, const PotentialPair &b) {
        return a.numbers.fixed != b.numbers.fixed ? a.numbers.fixed < b.numbers.fixed
                                                  : a.numbers.moving < b.numbers.moving;
    });
    bundle_.reliability = combine.reliability = settings.reliability;
    bundle_.ambiguity = combine.ambiguity = settings.ambiguity;
    told.bundles = bundle_(pairs_).size();
    told.buckets = bundle_.buckets().size();
    combinations_ = &combine(bundle_);
    told.combinations = combine.tried();
    result_.found = combine.found();
    result_.parts = combine.parts();
    result_.leftOut = combine.leftOut();
    return combine.isCut()           ? SearchOutcome::Cut
           : !combinations_->empty() ? SearchOutcome::Complete
           : told.buckets < 2        ? SearchOutcome::OneDirection
                                     : SearchOutcome::NoCombination;
}

VECTORLIB_BODY void PublishedSearch::judge(const PublishedCombination &combination,
                                           const Transformation2D &expected) {
    const Transformation2D t = combination.sums.transformation();
    Solution s;
    s.pose = expected * t;
    std::vector<char> isMatched(moving_.segments.size(), 0);
    for (const std::size_t number : combination.bundles)
        for (const int pair : bundle_.bundles()[number].pairs) {
            const CorrespondencePair &p = pairs_[static_cast<std::size_t>(pair)].numbers;
            s.pairs.push_back({fixed_.numbers[static_cast<std::size_t>(p.fixed)],
                               moving_.numbers[static_cast<std::size_t>(p.moving)]});
            isMatched[static_cast<std::size_t>(p.moving)] = 1;
        }
    double matched = 0, all = 0;
    for (std::size_t m = 0; m < isMatched.size(); ++m) {
        all += moving_.segments[m].length();
        matched += isMatched[m] ? moving_.segments[m].length() : 0;
    }
    s.matchedShare = matched / all;
    s.reliability = combination.sums.reliability();
    s.ambiguity = combination.sums.ambiguity().total();
    s.view = view_(t);
    s.fault = !settings.permitted.holds(t)                    ? Fault::NotPermitted
              : !(s.view.discrepancy <= settings.discrepancy) ? Fault::Discrepancy
                                                              : Fault::None;
    s.accepted = s.fault == Fault::None;
    result_.doubts.push_back(doubtOf(s));
    result_.search.solutions.push_back(std::move(s));
}

VECTORLIB_BODY Fault PublishedSearch::doubtOf(const Solution &s) const {
    return !settings.isEvidence(s.view, view_.observedAngle()) ? Fault::NoEvidence
           : !(s.matchedShare >= settings.matchedShare)        ? Fault::MatchedShare
                                                               : Fault::None;
}

} // namespace vectorlib
