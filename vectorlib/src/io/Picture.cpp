#include "vectorlib/io/Picture.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY const char *colour::distinct(std::size_t i) {
    constexpr const char *cycle[] = {"#0072b2", "#e69f00", "#009e73", "#cc79a7",
                                     "#56b4e9", "#a0522d", "#7b5ea7", "#5f7a00"};
    return cycle[i % 8];
}

VECTORLIB_BODY void Picture::path(Style style, const std::vector<Point> &path) {
    Layer &layer = add(Kind::Path, std::move(style));
    for (const Point &p : path)
        take(layer, p);
}

VECTORLIB_BODY void Picture::area(Style style, const std::vector<Point> &corners) {
    Layer &layer = add(Kind::Area, std::move(style));
    for (const Point &p : corners)
        take(layer, p);
}

VECTORLIB_BODY void Picture::pose(Style style, Point at, double heading) {
    Layer &layer = add(Kind::Pose, std::move(style));
    if (std::isfinite(heading))
        take(layer, at);
    layer.heading = heading;
}

VECTORLIB_BODY Picture::Box Picture::box() const {
    const Point size = box_.size();
    double margin = std::max(0.03 * std::max(size.x, size.y), 0.2);
    for (const double far : {box_.low.x, box_.low.y, box_.high.x, box_.high.y})
        margin = std::max(margin, 1e-14 * std::abs(far)); // less would be lost by rounding
    return {box_.low - Point(margin, margin), box_.high + Point(margin, margin)};
}

VECTORLIB_BODY double Picture::gridStep() const {
    const Point size = box().size();
    const double wanted = std::max(size.x, size.y) / mostLines;
    const double power = std::pow(10, std::floor(std::log10(wanted)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= wanted)
            return factor * power;
    return 10 * power;
}

VECTORLIB_BODY std::vector<double> Picture::gridLines(double low, double high, double step, int most) {
    std::vector<double> lines;
    // Counted: far from the origin a step more may be the same number.
    for (int i = 0; i <= most; ++i) {
        const double at = (std::ceil(low / step) + i) * step;
        if (at > high)
            break;
        lines.push_back(std::abs(at) < step / 2 ? 0 : at);
    }
    return lines;
}

VECTORLIB_BODY Picture::Layer &Picture::add(Kind kind, Style style) {
    layers_.push_back({kind, std::move(style), {}, 0});
    return layers_.back();
}

VECTORLIB_BODY void Picture::take(Layer &layer, Point p) {
    if (!isPlace(p))
        return;
    layer.vertices.push_back(p);
    box_.low = any_ ? Point(std::min(box_.low.x, p.x), std::min(box_.low.y, p.y)) : p;
    box_.high = any_ ? Point(std::max(box_.high.x, p.x), std::max(box_.high.y, p.y)) : p;
    any_ = true;
}

} // namespace vectorlib
