#include "vectorlib/relations/RelationMatcher.h"
#include "vectorlib/relations/TypedSegmentExtractor.h"

namespace vectorlib {

VECTORLIB_BODY double precisionValue(const LineSegment2D<double> &a, const LineSegment2D<double> &b) {
    const double shorter = std::min(a.length(), b.length());
    return shorter * shorter;
}

VECTORLIB_BODY double rotationalDifference(const std::vector<CorrespondencePair> &pairs,
                                           const std::vector<TypedSegment> &reference,
                                           const std::vector<TypedSegment> &current) {
    double sine = 0, cosine = 0;
    for (const CorrespondencePair &p : pairs) {
        const LineSegment2D<double> &r = reference[static_cast<std::size_t>(p.fixed)].segment;
        const LineSegment2D<double> &c = current[static_cast<std::size_t>(p.moving)].segment;
        const double w = precisionValue(r, c);
        cosine += w * c.direction().dot(r.direction());
        sine += w * c.direction().cross(r.direction());
    }
    return std::atan2(sine, cosine);
}

VECTORLIB_BODY bool poseDifference(const std::vector<CorrespondencePair> &pairs,
                                   const std::vector<TypedSegment> &reference,
                                   const std::vector<TypedSegment> &current, double leastAngle,
                                   Transformation2D &pose) {
    const double alpha = rotationalDifference(pairs, reference, current);
    const Transformation2D turn(0, 0, alpha);
    const double sine = std::sin(leastAngle);
    Vector2D<double> total;
    double weights = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (std::size_t j = i + 1; j < pairs.size(); ++j) {
            const auto at = [](const std::vector<TypedSegment> &set, int k) -> const LineSegment2D<double> & {
                return set[static_cast<std::size_t>(k)].segment;
            };
            const LineSegment2D<double> &k = at(reference, pairs[i].fixed),
                                        &u = at(reference, pairs[j].fixed);
            const LineSegment2D<double> &m = at(current, pairs[i].moving), &v = at(current, pairs[j].moving);
            Vector2D<double> there, here;
            if (!crossing(k, u, sine, there) || !crossing(m, v, sine, here))
                continue;
            const double w = std::min(precisionValue(k, u), precisionValue(m, v));
            total += (there - turn * here) * w;
            weights += w;
        }
    const Vector2D<double> t = weights > 0 ? total / weights : Vector2D<double>();
    pose = Transformation2D(t.x, t.y, alpha);
    return weights > 0;
}

VECTORLIB_BODY const char *describe(RelationOutcome outcome) {
    static constexpr const char *texts[] = {
        "matched",
        "a setting is negative, zero where it must not be, too large or not a number",
        "fewer than two usable segments in the reference scan",
        "fewer than two usable segments in the current scan",
        "no relation of the current scan is found in the reference scan",
        "only one pair of segments matches",
        "the directions of the matching segments are too much alike to fix the place",
        "the matching segments agree on a rotation, but on no place",
        "too little matches to tell the place from others like it: a corner alone fits any corner",
        "another place fits nearly as well"};
    return texts[static_cast<int>(outcome)]; // in the order of the enumeration
}

VECTORLIB_BODY const RelationMatch &RelationMatcher::operator()(const Segments &reference,
                                                                const Segments &current) {
    clear();
    if (!settings.isValid())
        return end(RelationOutcome::BadSettings);
    reference_.build(reference, settings);
    current_.build(current, settings);
    return match();
}

VECTORLIB_BODY const RelationMatch &RelationMatcher::next(const Segments &current) {
    clear();
    if (!settings.isValid())
        return end(RelationOutcome::BadSettings);
    std::swap(reference_, current_);
    current_.build(current, settings);
    return match();
}

VECTORLIB_BODY void RelationMatcher::clear() {
    result_.pose = result_.byEdges = Transformation2D();
    result_.byScores.clear();
    result_.pairs.clear();
    result_.score = result_.reliability = result_.ambiguity = result_.deviation = 0;
    result_.matchedLength = result_.evidence = result_.rivalEvidence = 0;
    result_.leftOut = result_.virtualLeftOut = result_.scores = result_.compared = 0;
    result_.isCut = false;
    places_.clear();
    isUnspecific_ = false;
}

VECTORLIB_BODY const RelationMatch &RelationMatcher::end(RelationOutcome outcome) {
    result_.outcome = outcome;
    return result_;
}

VECTORLIB_BODY const RelationMatch &RelationMatcher::match() {
    const Segments &reference = reference_.segments(), &current = current_.segments();
    result_.leftOut = reference_.leftOut() + current_.leftOut();
    result_.virtualLeftOut =
        reference_.relations().virtualEdgesLeftOut + current_.relations().virtualEdgesLeftOut;
    if (reference.size() < 2)
        return end(RelationOutcome::TooFewReference);
    if (current.size() < 2)
        return end(RelationOutcome::TooFewCurrent);
    score_(reference, reference_.relations(), current, current_.relations(), settings, table_);
    result_.scores = table_.scores();
    result_.compared = score_.compared();
    result_.isCut = score_.isCut();
    result_.score = table_.maximum().score;
    if (result_.score == 0)
        return end(RelationOutcome::NoCommonRelation);
    leastSeen_ = std::min(lengthOf(reference), lengthOf(current));
    consensus_.distance = settings.distanceWindow;
    consensus_.angle = settings.angleWindow;
    signs_.distance = settings.distanceWindow;
    const RelationOutcome first = searchFirst();
    for (int i = 1; i < settings.searches; ++i)
        if (!searchAgain())
            break;
    if (result_.evidence == 0 && settings.searches > 1)
        searchAll();
    if (result_.evidence == 0)
        return end(isUnspecific_ ? RelationOutcome::Unspecific : first);
    result_.rivalEvidence = rivalEvidence();
    return end(result_.rivalEvidence >= settings.rivalShare * result_.evidence ? RelationOutcome::Ambiguous
                                                                               : RelationOutcome::Matched);
}

VECTORLIB_BODY double RelationMatcher::lengthOf(const Segments &segments) {
    double length = 0;
    for (const TypedSegment &s : segments)
        length += s.segment.length();
    return length;
}

VECTORLIB_BODY RelationOutcome RelationMatcher::searchFirst() {
    first_ = table_;
    const Pairs &found = search(first_, settings.threshold);
    for (const CorrespondencePair &p : found)
        result_.byScores.push_back({reference_.given(p.fixed), current_.given(p.moving)});
    for (const CorrespondencePair &p : found)
        table_.invalidate(p.fixed, p.moving);
    if (found.size() < 2)
        return RelationOutcome::OnePair;
    const bool haveEdge = poseDifference(found, reference_.segments(), current_.segments(),
                                         consensus_.leastAngle, result_.byEdges);
    if (place(found, settings.places))
        return RelationOutcome::Matched;
    return haveEdge ? RelationOutcome::Contradiction : RelationOutcome::OneDirection;
}

VECTORLIB_BODY bool RelationMatcher::searchAgain() {
    again_ = table_;
    const Pairs &found = search(again_, settings.laterThreshold);
    for (const CorrespondencePair &p : found)
        table_.invalidate(p.fixed, p.moving);
    if (found.size() >= 2)
        place(found, settings.places);
    return !found.empty();
}

VECTORLIB_BODY const RelationMatcher::Pairs &RelationMatcher::search(MatchingTable &table, double threshold) {
    search_.threshold = threshold * result_.score;
    search_.window = settings.angleWindow;
    search_.sameOrder = settings.sameOrder;
    const Segments &reference = reference_.segments(), &current = current_.segments();
    return search_(table, [&](int row, int column) {
        return relativeAngle(current[static_cast<std::size_t>(column)].segment,
                             reference[static_cast<std::size_t>(row)].segment);
    });
}

VECTORLIB_BODY void RelationMatcher::searchAll() {
    all_.clear();
    for (int i = 0; i < first_.rows(); ++i)
        for (int j = 0; j < first_.columns(); ++j)
            if (score_.referenceTable()(i, j))
                all_.push_back({i, j});
    if (all_.size() > maxPairs) {
        const auto shorter = [&](const CorrespondencePair &p) {
            return std::min(reference_.segments()[static_cast<std::size_t>(p.fixed)].segment.length(),
                            current_.segments()[static_cast<std::size_t>(p.moving)].segment.length());
        };
        std::nth_element(all_.begin(), all_.begin() + maxPairs, all_.end(),
                         [&](const CorrespondencePair &a, const CorrespondencePair &b) {
                             const double la = shorter(a), lb = shorter(b);
                             return la != lb ? la > lb
                                             : std::pair(a.fixed, a.moving) < std::pair(b.fixed, b.moving);
                         });
        all_.resize(maxPairs);
    }
    place(all_, 8);
}

VECTORLIB_BODY bool RelationMatcher::place(const Pairs &found, int most) {
    const int count = consensus_.propose(found, reference_.segments(), current_.segments(), most);
    bool isAny = false;
    for (int i = 0; i < count; ++i)
        isAny = judge(consensus_.settle(i, reference_.segments(), current_.segments())) || isAny;
    return isAny;
}

VECTORLIB_BODY bool RelationMatcher::judge(const Transformation2D &pose) {
    if (!pose.isFinite() || consensus_.pairs().size() < 2 || !(consensus_.deviation() <= settings.deviation))
        return false;
    const double against = seenThrough_(reference_.segments(), current_.segments(), pose);
    const double evidence = consensus_.length() - against;
    if (evidence <= 0 || consensus_.length() < settings.matchedShare * leastSeen_)
        return false;
    places_.push_back({pose, evidence});
    if (against > settings.seenThroughShare * consensus_.length())
        return false;
    if (signs_(consensus_.pairs(), reference_.segments(), current_.segments(), pose) < settings.leastSigns) {
        isUnspecific_ = true;
        return false;
    }
    if (evidence > result_.evidence)
        take(pose, evidence);
    return true;
}

VECTORLIB_BODY void RelationMatcher::take(const Transformation2D &pose, double evidence) {
    const LineSegmentRegistration &registration = consensus_.registration();
    result_.evidence = evidence;
    result_.pose = pose;
    result_.matchedLength = consensus_.length();
    result_.reliability = registration.reliability();
    result_.deviation = consensus_.deviation();
    result_.ambiguity = registration.ambiguity().total() / registration.weight();
    result_.pairs.clear();
    for (const CorrespondencePair &p : consensus_.pairs())
        result_.pairs.push_back({reference_.given(p.fixed), current_.given(p.moving)});
}

VECTORLIB_BODY double RelationMatcher::rivalEvidence() const {
    double most = 0;
    for (const Place &place : places_)
        if (!isFound(place.pose))
            most = std::max(most, place.evidence);
    return most;
}

} // namespace vectorlib
