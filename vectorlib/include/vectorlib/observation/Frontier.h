#pragma once

#include "vectorlib/observation/Observer.h"

namespace vectorlib {

/// The border between what a view has explored and what it has not: from the end of each visible part to the
/// begin of the next. Behind it lies the shadow of the nearer of the two. Directions in which nothing was
/// seen under more than `widestGap` are unexplored down to the sensor. Thesis 7.4.2, third rule.
///
/// `view` is that of an Observer with a full turn; the frontier is in its frame, counter-clockwise. An empty
/// view has explored nothing and has no frontier.
class Frontier {
public:
    double widestGap = pi / 6; ///< radians

    /// The frontier of a view; valid until the next call.
    const std::vector<LineSegment2D<double>> &operator()(const std::vector<VisiblePart<double>> &view) {
        segments_.clear();
        for (std::size_t i = 0; i < view.size(); ++i)
            close(view[i].segment.end(), view[i + 1 < view.size() ? i + 1 : 0].segment.begin());
        return segments_;
    }

private:
    void close(Vector2D<double> end, Vector2D<double> begin) {
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

    std::vector<LineSegment2D<double>> segments_;
};

} // namespace vectorlib
