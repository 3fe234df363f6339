#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/places/PlaceFit.h"
#include "vectorlib/places/PlaceScan.h"
#include "vectorlib/places/ScanObjects.h"
#include "vectorlib/places/WallTiles.h"

#include <vector>

namespace vectorlib {

/// Brings the points of a scan onto the walls of a map, from a pose nearby, and tells how well they lie there
/// and what they look through. The cost follows the scan and the walls beside it, not the map.
class PlaceFitter {
public:
    double gate = 0.2;       ///< points farther from a wall are not explained; metres
    double sameFacing = 0.8; ///< least cosine between the directions of a point's wall and the map's
    double beyondEnd = 0.1;  ///< that a point may lie beyond the end of its wall; metres
    double scale = 0.5;      ///< a residual of this share of the gate weighs a quarter
    double clearly = 0.2;    ///< a wall hides a point when it and the sensor are farther from it; metres

    /// Gauss-Newton steps on the points' distances from their walls, while the gate narrows; every
    /// `sample`-th point takes part.
    Transformation2D refine(const WallTiles &tiles, const std::vector<WallPoint> &points,
                            Transformation2D pose, std::size_t sample, int iterations,
                            double firstGate) const;
    /// How every `sample`-th point lies; what they look through only when asked for.
    PlaceFit judge(const WallTiles &tiles, const std::vector<WallPoint> &points, const Transformation2D &pose,
                   std::size_t sample, bool looksThrough, double wallOfPoint) const;

private:
    using Vector = Vector2D<double>;
    static constexpr double smallStep = 0.003; // metres, and radians
    // Of the score. A map has walls where doors stand open now, and some that were drawn a little aside: what
    // they hide weighs less than points without a wall.
    static constexpr double apartWeight = 0.5, hiddenWeight = 0.2, blockedWeight = 0.3;
    struct Beside {
        int wall = -1;
        double across = 0;
    };

    Beside wallBeside(const WallTiles &tiles, Vector p, Vector direction, double width) const;
    Transformation2D improved(const WallTiles &tiles, const std::vector<WallPoint> &points,
                              const Transformation2D &pose, double width, std::size_t sample) const;
    // How much of the way to a point lies behind a wall, as a share; 0 where none stands clearly between.
    double seenBehind(const WallTiles &tiles, Vector sensor, Vector p) const;
    static double areaBehind(const WallPoint &point, double behind, double wallOfPoint);
    static constexpr double farthestLook = 100; // metres
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/PlaceFitter.cpp")
