#pragma once

#include <QColor>
#include <array>

namespace hermes::desktop {

/// Colours of the map view, dark or light as the theme is.
struct MapColours {
    QColor background, grid, axis, map, accent, scan, correspondence, path, odometry, truth, robot, text,
        loop;
    std::array<QColor, 5> trust; // from 0 to 1: orange to blue, apart for the colour-blind, too
};

MapColours mapColours();
/// From low to high, for the points of a cloud.
std::array<QColor, 5> cloudColours();

} // namespace hermes::desktop
