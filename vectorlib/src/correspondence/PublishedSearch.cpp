#include "vectorlib/correspondence/PublishedSearch.h"

namespace vectorlib {

VECTORLIB_BODY void PublishedBundle::add(const PotentialPair &pair) {
    const double turn = wrapAngle(pair.alpha - alpha);
    const double shift = (pair.normal.dot(normal) < 0 ? -1 : 1) * pair.shift; // facing walls
    sums.add(pair.sums);
    turns += pair.length * turn;
    turns2 += pair.length * turn * turn;
    shifts += pair.length * shift;
    shifts2 += pair.length * shift * shift;
}

VECTORLIB_BODY const std::vector<PublishedBundle> &
PublishedBundles::operator()(const std::vector<PotentialPair> &pairs) {
    bundles_.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i)
        place(pairs[i], static_cast<int>(i));
    buckets_.clear();
    for (std::size_t i = 0; i < bundles_.size(); ++i)
        putIntoBucket(i);
    return bundles_;
}

VECTORLIB_BODY void PublishedBundles::place(const PotentialPair &pair, int number) {
    for (PublishedBundle &bundle : bundles_) {
        PublishedBundle with = bundle;
        with.add(pair);
        if (with.sums.reliability() <= reliability && with.ambiguity() <= ambiguity) {
            bundle = std::move(with);
            bundle.pairs.push_back(number);
            return;
        }
    }
    bundles_.emplace_back(pair);
    bundles_.back().add(pair);
    bundles_.back().pairs.push_back(number);
}

VECTORLIB_BODY bool PublishedBundles::collide(std::size_t a, std::size_t b) const {
    LineSegmentRegistration joint = bundles_[a].sums;
    joint.add(bundles_[b].sums);
    return joint.reliability() <= reliability;
}

VECTORLIB_BODY void PublishedBundles::putIntoBucket(std::size_t bundle) {
    const auto fits = [&](const std::vector<std::size_t> &bucket) {
        return std::all_of(bucket.begin(), bucket.end(),
                           [&](std::size_t other) { return collide(bundle, other); });
    };
    const auto found = std::find_if(buckets_.begin(), buckets_.end(), fits);
    bundles_[bundle].bucket = static_cast<std::size_t>(found - buckets_.begin());
    if (found == buckets_.end())
        buckets_.push_back({bundle});
    else
        found->push_back(bundle);
}

VECTORLIB_BODY const std::vector<PublishedCombination> &
PublishedCombinations::operator()(const PublishedBundles &sorted) {
    sorted_ = &sorted;
    kept_.clear();
    found_ = parts_ = tried_ = 0;
    cut_ = false;
    chosen_.clear();
    LineSegmentRegistration none;
    if (!sorted.bundles().empty())
        none.stiffness = bundle(0).sums.stiffness;
    extend(0, none);
    return kept_;
}

VECTORLIB_BODY bool PublishedCombinations::joins(std::size_t number, const LineSegmentRegistration &sums,
                                                 LineSegmentRegistration &joint) {
    cut_ = cut_ || tried_ >= most;
    if (cut_)
        return false;
    ++tried_;
    joint = sums;
    joint.add(bundle(number).sums);
    return joint.ambiguity().total() <= ambiguity;
}

VECTORLIB_BODY void PublishedCombinations::extend(std::size_t bucket, const LineSegmentRegistration &sums) {
    if (bucket == sorted_->buckets().size()) {
        if (chosen_.size() > 1 && sums.reliability() >= reliability)
            conclude(sums);
        return;
    }
    LineSegmentRegistration joint;
    for (const std::size_t number : sorted_->buckets()[bucket])
        if (joins(number, sums, joint)) {
            chosen_.push_back(number);
            extend(bucket + 1, joint);
            chosen_.pop_back();
        }
    if (!cut_)
        extend(bucket + 1, sums);
}

VECTORLIB_BODY void PublishedCombinations::conclude(const LineSegmentRegistration &sums) {
    ++found_;
    if (isPart(sums)) {
        ++parts_;
        return;
    }
    const PublishedCombination found{sums, chosen_};
    kept_.insert(std::upper_bound(kept_.begin(), kept_.end(), found,
                                  [](const PublishedCombination &a, const PublishedCombination &b) {
                                      return a.length() > b.length();
                                  }),
                 found);
    if (kept_.size() > keep)
        kept_.pop_back();
}

VECTORLIB_BODY bool PublishedCombinations::isPart(const LineSegmentRegistration &sums) {
    LineSegmentRegistration joint;
    for (std::size_t bucket = 0; bucket < sorted_->buckets().size(); ++bucket) {
        const std::vector<std::size_t> &numbers = sorted_->buckets()[bucket];
        if (std::any_of(chosen_.begin(), chosen_.end(),
                        [&](std::size_t number) { return bundle(number).bucket == bucket; }))
            continue;
        for (const std::size_t number : numbers)
            if (joins(number, sums, joint) && joint.reliability() >= reliability)
                return true;
    }
    return false;
}

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

} // namespace vectorlib
