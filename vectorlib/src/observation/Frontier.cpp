#include "vectorlib/observation/Frontier.h"

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

} // namespace vectorlib
