#include "vectorlib/observation/Discrepancy.h"

namespace vectorlib {

VECTORLIB_BODY const std::vector<LineSegment2D<double>> &
Frontier::operator()(const std::vector<VisiblePart<double>> &view) {
    segments_.clear();
    for (std::size_t i = 0; i < view.size(); ++i)
        close(view[i].segment.end(), view[i + 1 < view.size() ? i + 1 : 0].segment.begin());
    return segments_;
}

VECTORLIB_BODY void Frontier::close(Vector2D<double> end, Vector2D<double> begin) {
    double gap = std::atan2(end.cross(begin), end.dot(begin));
    if (gap < -1e-6) // more than half a turn: parts do not overlap
        gap += 2 * pi;
    if (gap > widestGap) {
        segments_.emplace_back(end, Vector2D<double>());
        segments_.emplace_back(Vector2D<double>(), begin);
    } else if ((begin - end).norm() > 1e-9) {
        segments_.emplace_back(end, begin);
    }
}

VECTORLIB_BODY ViewComparison Discrepancy::operator()(const std::vector<VisiblePart<double>> &expected,
                                                      const std::vector<VisiblePart<double>> &observed) {
    result_ = ViewComparison();
    shared_.clear();
    read(expected, expected_);
    read(observed, observed_);
    std::size_t i = 0, j = 0;
    while (i < expected_.sectors.size() && j < observed_.sectors.size()) {
        const Sector &a = expected_.sectors[i], &b = observed_.sectors[j];
        const Sector &later = a.right > b.right ? a : b, &sooner = a.left < b.left ? a : b;
        if (later.right < sooner.left)
            compare(expected_.lines[a.edge], observed_.lines[b.edge], later.towardsRight, sooner.towardsLeft);
        a.left < b.left ? ++i : ++j;
    }
    return result_;
}

VECTORLIB_BODY void Discrepancy::read(const std::vector<VisiblePart<double>> &parts, View &view) {
    view.lines.clear();
    view.sectors.clear();
    for (const VisiblePart<double> &part : parts) {
        const std::size_t edge = view.lines.size();
        view.lines.emplace_back(part.segment.begin(), part.segment.end());
        cutBehind(part.segment.begin(), part.segment.end(), edge,
                  [&](const Sector &sector) { view.sectors.push_back(sector); });
    }
    // The part straight behind was cut in two: its right half belongs at the end.
    if (view.sectors.size() > 1 && view.sectors[0].right > view.sectors[1].right)
        std::rotate(view.sectors.begin(), view.sectors.begin() + 1, view.sectors.end());
}

VECTORLIB_BODY void Discrepancy::compare(const SightLine &a, const SightLine &b, Vector2D<double> right,
                                         Vector2D<double> left) {
    result_.angle += std::atan2(right.cross(left), right.dot(left));
    const double atRight = compareDistance(a, b, right), atLeft = compareDistance(a, b, left);
    if ((atRight < 0 && atLeft > 0) || (atRight > 0 && atLeft < 0)) {
        const Vector2D<double> crossing = right * std::abs(atLeft) + left * std::abs(atRight);
        measure(a, b, right, crossing);
        measure(a, b, crossing, left);
    } else {
        measure(a, b, right, left);
    }
}

VECTORLIB_BODY void Discrepancy::measure(const SightLine &a, const SightLine &b, Vector2D<double> right,
                                         Vector2D<double> left) {
    const SharedSector s{a.meet(right), a.meet(left), b.meet(right), b.meet(left)};
    const double expected = s.expectedRight.cross(s.expectedLeft) / 2;
    const double observed = s.observedRight.cross(s.observedLeft) / 2;
    result_.discrepancy += std::abs(expected - observed);
    result_.common += std::min(expected, observed);
    shared_.push_back(s);
}

} // namespace vectorlib
