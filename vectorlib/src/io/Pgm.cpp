#include "vectorlib/io/Pgm.h"

#include "vectorlib/io/TextInput.h"

#include <algorithm>
#include <cstdio>

namespace vectorlib {

VECTORLIB_BODY std::optional<OccupancyPicture>
OccupancyPicture::draw(const std::vector<MapEdge> &map, const std::vector<StampedPose> &trajectory,
                       double resolution, double driven) {
    OccupancyPicture p;
    p.resolution_ = resolution;
    if (!p.frame(map, trajectory))
        return std::nullopt;
    for (std::size_t i = 0; i + 1 < trajectory.size(); ++i)
        if (!trajectory[i + 1].isApart)
            p.line({trajectory[i].pose.x, trajectory[i].pose.y},
                   {trajectory[i + 1].pose.x, trajectory[i + 1].pose.y}, driven, freeCell);
    for (const MapEdge &m : map)
        p.line(m.segment.begin(), m.segment.end(), 0, occupiedCell);
    return p;
}

VECTORLIB_BODY std::string OccupancyPicture::yamlText(const std::string &text) {
    constexpr const char *plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-";
    if (text.find_first_not_of(plain) == std::string::npos && text.find_first_of(".-") != 0)
        return text;
    std::string quoted = "\"";
    for (std::size_t at = 0; at < text.size();) {
        const auto [code, length] = nextCharacter(text, at);
        char escaped[12];
        std::snprintf(escaped, sizeof escaped, "\\U%08x", code ? unsigned(code) : text[at] & 0xffu);
        const bool isShown = code >= ' ' && code <= '~' && code != '"' && code != '\\';
        quoted += isShown ? text.substr(at, 1) : escaped;
        at += length;
    }
    return quoted + '"';
}

VECTORLIB_BODY bool OccupancyPicture::frame(const std::vector<MapEdge> &map,
                                            const std::vector<StampedPose> &trajectory) {
    Vector2D<double> low, high;
    bool any = false;
    const auto include = [&](Vector2D<double> p) {
        low = any ? Vector2D<double>(std::min(low.x, p.x), std::min(low.y, p.y)) : p;
        high = any ? Vector2D<double>(std::max(high.x, p.x), std::max(high.y, p.y)) : p;
        any = true;
    };
    for (const MapEdge &m : map) {
        include(m.segment.begin());
        include(m.segment.end());
    }
    for (const StampedPose &s : trajectory)
        include({s.pose.x, s.pose.y});
    origin_ = low - Vector2D<double>(margin, margin);
    const double width = std::ceil((high.x - low.x + 2 * margin) / resolution_);
    const double height = std::ceil((high.y - low.y + 2 * margin) / resolution_);
    if (!(width * height <= static_cast<double>(maxCells)))
        return false;
    width_ = static_cast<std::size_t>(width);
    height_ = static_cast<std::size_t>(height);
    cells_.assign(width_ * height_, unknownCell);
    return true;
}

VECTORLIB_BODY void OccupancyPicture::line(Vector2D<double> a, Vector2D<double> b, double radius,
                                           unsigned char value) {
    const double length = (b - a).norm();
    const auto steps = static_cast<std::size_t>(std::ceil(length / resolution_ * 2)) + 1;
    for (std::size_t i = 0; i <= steps; ++i)
        disc(a + (b - a) * (static_cast<double>(i) / static_cast<double>(steps)), radius, value);
}

VECTORLIB_BODY void OccupancyPicture::disc(Vector2D<double> centre, double radius, unsigned char value) {
    const int reach = static_cast<int>(std::floor(radius / resolution_));
    const int column = static_cast<int>((centre.x - origin_.x) / resolution_);
    const int row = static_cast<int>((centre.y - origin_.y) / resolution_);
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx)
            if (dx * dx + dy * dy <= reach * reach)
                set(column + dx, row + dy, value);
}

} // namespace vectorlib
