#pragma once

#include "vectorlib/places/PlaceFit.h"
#include "vectorlib/places/PlaceScan.h"
#include "vectorlib/places/WallTiles.h"

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
                            double firstGate) const {
        double width = std::max(firstGate, gate);
        for (int i = 0; i < iterations; ++i) {
            const Transformation2D next = improved(tiles, points, pose, width, sample);
            const Transformation2D step = pose.inverse() * next;
            pose = next;
            if (width <= gate && step.translation().norm() < smallStep && std::abs(step.sin()) < smallStep)
                break;
            width = std::max(gate, 0.6 * width);
        }
        return pose;
    }
    /// How every `sample`-th point lies; what they look through only when asked for.
    PlaceFit judge(const WallTiles &tiles, const std::vector<WallPoint> &points, const Transformation2D &pose,
                   std::size_t sample, bool looksThrough, double wallOfPoint) const {
        PlaceFit fit;
        fit.pose = pose;
        const Vector sensor = pose.translation();
        for (std::size_t i = 0; i < points.size(); i += sample) {
            const Vector turned = pose.rotate(Vector(points[i].position)), p = sensor + turned;
            const Beside beside = wallBeside(tiles, p, pose.rotate(Vector(points[i].direction)), gate);
            const double behind = looksThrough ? seenBehind(tiles, sensor, p) : 0;
            ++fit.points;
            if (behind > 0)
                fit.said.back() -= beside.wall >= 0 ? hiddenWeight : blockedWeight;
            if (beside.wall >= 0) {
                const double squared = beside.across * beside.across;
                ++fit.explained;
                fit.hidden += behind > 0;
                fit.distances += squared;
                fit.said[std::size_t(points[i].object)] += 1 - apartWeight * squared / (gate * gate);
                const Vector n = tiles.wall(beside.wall).normal();
                fit.information += square(1, Eigen::Vector3d(n.x, n.y, turned.cross(n)));
            } else
                fit.blocked += behind > 0;
            if (behind > 0)
                fit.discrepancy += areaBehind(points[i], behind, wallOfPoint * double(sample));
        }
        return fit;
    }

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

    Beside wallBeside(const WallTiles &tiles, Vector p, Vector direction, double width) const {
        Beside best;
        double least = width;
        tiles.forEachNear(p, [&](int number) {
            const LineSegment2D<double> &wall = tiles.wall(number);
            const double across = wall.across(p);
            if (std::abs(across) >= least || wall.direction().dot(direction) < sameFacing)
                return;
            const double along = wall.along(p);
            if (along < -beyondEnd || along > wall.length() + beyondEnd)
                return;
            least = std::abs(across);
            best = {number, across};
        });
        return best;
    }
    Transformation2D improved(const WallTiles &tiles, const std::vector<WallPoint> &points,
                              const Transformation2D &pose, double width, std::size_t sample) const {
        // A little inertia, for what the walls leave open.
        Eigen::Matrix3d h = Eigen::Vector3d(0.1, 0.1, 0.1).asDiagonal();
        Eigen::Vector3d g = Eigen::Vector3d::Zero();
        const double inverse = 1 / (scale * scale * width * width);
        for (std::size_t i = 0; i < points.size(); i += sample) {
            const Vector turned = pose.rotate(Vector(points[i].position));
            const Beside beside = wallBeside(tiles, pose.translation() + turned,
                                             pose.rotate(Vector(points[i].direction)), width);
            if (beside.wall < 0)
                continue;
            const Vector n = tiles.wall(beside.wall).normal();
            const double r = beside.across, q = 1 / (1 + r * r * inverse), w = q * q; // Geman and McClure
            const Eigen::Vector3d j(n.x, n.y, turned.cross(n));
            h += square(w, j);
            g += (w * r) * j;
        }
        const std::optional<Eigen::Vector3d> back = solveSymmetric(h, g);
        if (!back)
            return pose;
        return {pose.x() - (*back)(0), pose.y() - (*back)(1), pose.alpha() - (*back)(2)};
    }
    // How much of the way to a point lies behind a wall, as a share; 0 where none stands clearly between.
    double seenBehind(const WallTiles &tiles, Vector sensor, Vector p) const {
        const Vector way = p - sensor;
        const double length = std::min(way.norm(), farthestLook);
        double behind = 0;
        for (double t = 0; t < length && behind == 0; t += 0.5 * WallTiles::tile)
            tiles.forEachNear(sensor + way * (t / way.norm()), [&](int number) {
                const LineSegment2D<double> &wall = tiles.wall(number);
                const double a = wall.across(sensor), b = wall.across(p);
                if (a * b >= 0 || std::min(std::abs(a), std::abs(b)) < clearly)
                    return;
                const double at = a / (a - b), along = wall.along(sensor + way * at);
                if (along > beyondEnd && along < wall.length() - beyondEnd)
                    behind = std::max(behind, 1 - at);
            });
        return behind;
    }
    static double areaBehind(const WallPoint &point, double behind, double wallOfPoint) {
        const Vector p(point.position);
        const double turn = std::abs(p.cross(Vector(point.direction))) * wallOfPoint; // angle times r^2
        return turn * (1 - (1 - behind) * (1 - behind)) / 2;
    }
    static constexpr double farthestLook = 100; // metres
};

} // namespace vectorlib
