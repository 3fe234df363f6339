#pragma once

#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cstddef>

namespace vectorlib {

/// Settings of EarSegmenter; the defaults are those of thesis 5.3.
struct EarSettings {
    /// In which two points are compared (thesis 5.2.2): by their distance, or range and angle by themselves.
    enum class Coordinates { Cartesian, Polar };

    int neighbours = 10;           ///< K: how many earlier points are examined
    double minThreshold = 0.05;    ///< lower bound of the distance threshold, the sensor's accuracy; metres
    double maxThreshold = 0.20;    ///< upper bound of the distance threshold; metres
    int minPoints = 15;            ///< smaller clusters are outliers
    bool closed = true;            ///< the last point is a neighbour of the first (a full turn)
    double fieldOfView = 2 * pi;   ///< F of erratum 14; radians
    std::size_t nominalPoints = 0; ///< N of erratum 14, the scanner's rays; 0: as many as points
    Coordinates coordinates = Coordinates::Cartesian; ///< of points; ranges are always compared as such

    /// For a scanner of `rays` rays over `fieldOfView` (radians, 2 pi for a full turn). Up to 0.3 degree
    /// between rays the settings of thesis 5.3; beyond, points of one wall lie farther apart and small
    /// clusters count.
    static EarSettings forScanner(double fieldOfView, std::size_t rays) {
        EarSettings s;
        s.fieldOfView = fieldOfView;
        s.nominalPoints = rays;
        s.closed = fieldOfView > 1.99 * pi;
        if (rays > 0 && fieldOfView / static_cast<double>(rays) > 0.3 * pi / 180) {
            s.neighbours = 5;
            s.minThreshold = 0.10;
            s.maxThreshold = 0.60;
            s.minPoints = 4;
        }
        return s;
    }
};

} // namespace vectorlib
