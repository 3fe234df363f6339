#include "vectorlib/io/Plot.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY PlotPlace placeOf(const Plot &plot, std::pair<double, double> point) {
    constexpr double most = 1e300; // beyond which an axis around it is none
    if (!(std::abs(point.first) < most) || !(std::abs(point.second) < most))
        return PlotPlace::Break;
    return (!plot.xLogarithmic || point.first > 0) && (!plot.yLogarithmic || point.second > 0)
               ? PlotPlace::Shown
               : PlotPlace::LeftOut;
}

VECTORLIB_BODY std::vector<std::vector<std::pair<double, double>>> outlinesOf(const Curve &curve,
                                                                              const Plot &plot) {
    std::vector<std::vector<std::pair<double, double>>> outlines;
    std::vector<std::pair<double, double>> low, high;
    const auto close = [&] {
        high.insert(high.end(), low.rbegin(), low.rend());
        if (low.size() > 1)
            outlines.push_back(high);
        low.clear();
        high.clear();
    };
    for (std::size_t i = 0; i < std::min(curve.points.size(), curve.band.size()); ++i) {
        const double x = curve.points[i].first;
        const std::pair<double, double> below(x, curve.band[i].first), above(x, curve.band[i].second);
        if (placeOf(plot, below) == PlotPlace::Shown && placeOf(plot, above) == PlotPlace::Shown) {
            low.push_back(below);
            high.push_back(above);
        } else {
            close();
        }
    }
    close();
    return outlines;
}

} // namespace vectorlib
