#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/places/PlaceIndex.h"
#include "vectorlib/places/WallTiles.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace vectorlib {

/// How a scan lies in a map at some pose.
struct PlaceFit {
    static constexpr double maxHiddenLead = 0.0125; ///< of a lead, by what walls hide
    static constexpr double leastKnown = 0.3;       ///< of the points, as if the map knew so many
    Transformation2D pose;                          ///< of the sensor in the map's frame
    double points = 0;                              ///< that were compared
    double explained = 0;   ///< of them, with a wall of the map beside them that faces alike
    double distances = 0;   ///< sum of their squared distances from it; m^2
    double hidden = 0;      ///< explained points that another wall of the map hides
    double blocked = 0;     ///< other points that a wall of the map hides
    double before = 0;      ///< other points before a wall of the map; see PlaceFitter::beyond
    double discrepancy = 0; ///< area seen behind walls of the map; m^2
    /// What each object of the scan says for the place, and last what walls of the map hide; in points.
    std::array<double, ScanObjects::most + 1> said{};
    Eigen::Matrix3d information =
        Eigen::Matrix3d::Zero(); ///< of x, y, alpha by the explained points; 1/m^2 apart

    double explainedShare() const { return points > 0 ? explained / points : 0; }
    double hiddenShare() const { return points > 0 ? (hidden + blocked) / points : 0; }
    /// What speaks against the pose: the share of the points that are seen through walls, and half of that of
    /// those on no wall.
    double against() const { return points > 0 ? hiddenShare() + 0.5 * (1 - explainedShare()) : 0; }
    /// The share that contradicts, of what the map knows there: points seen through walls, and half of those
    /// before walls, as these may be people.
    double contradicted() const {
        const double against = hidden + blocked + 0.5 * before;
        return against > 0 ? against / std::max(explained - hidden + against, leastKnown * points) : 0;
    }
    /// Up to 1: the explained share, less what lies apart and what is seen through walls.
    double score() const { return points > 0 ? std::accumulate(said.begin(), said.end(), 0.0) / points : 0; }
    /// How much higher the score is than that of another place of the same scan, when the object that speaks
    /// most for this one is not heard, and what walls hide little: an object that was moved onto one of the
    /// other place explains points, and can be looked through where it stood. Against a place that is not
    /// there when the other has no points.
    double leadOver(const PlaceFit &other) const;
    /// Mean squared distance of the explained points; m^2.
    double meanSquare() const { return explained > 0 ? distances / explained : 0; }
    /// In [0, 1], of the walls' directions as that of lines (paper (28)): small along a corridor.
    double reliability() const;
    /// Of x, y (metres) and alpha (radians). Points beside each other err alike, so that four count as one,
    /// and the map's own walls are known to 2 cm at best. Nothing where the walls do not fix the pose.
    std::optional<Eigen::Matrix3d> covariance() const;
};

/// Brings the points of a scan onto the walls of a map, from a pose nearby, and tells how well they lie there
/// and what they look through. The cost follows the scan and the walls beside it, not the map.
class PlaceFitter {
public:
    double gate = 0.2;       ///< points farther from a wall are not explained; metres
    double sameFacing = 0.8; ///< least cosine between the directions of a point's wall and the map's
    double beyondEnd = 0.1;  ///< that a point may lie beyond the end of its wall; metres
    double scale = 0.5;      ///< a residual of this share of the gate weighs a quarter
    double shortest = 0;     ///< of the walls that hide; metres
    double clearly = 0.2;    ///< a wall hides a point when it and the sensor are farther from it; metres
    double beyond = 0;       ///< a point is before a wall that shows its front so far behind; metres

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
    // How much of the way to a point lies behind a wall, as a share; 0 where none stands clearly between. Of
    // all walls, or of those that show their front.
    double seenBehind(const WallTiles &tiles, Vector sensor, Vector p, bool fronts = false) const;
    static double areaBehind(const WallPoint &point, double behind, double wallOfPoint) {
        const Vector p(point.position);
        const double turn = std::abs(p.cross(Vector(point.direction))) * wallOfPoint; // angle times r^2
        return turn * (1 - (1 - behind) * (1 - behind)) / 2;
    }
    static constexpr double farthestLook = 100; // metres
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/PlaceFitter.cpp")
