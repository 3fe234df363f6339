#pragma once

#include "vectorlib/geometry/SmallMatrix.h"
#include "vectorlib/places/PlaceScan.h"
#include "vectorlib/places/WallTiles.h"

#include <Eigen/LU>

namespace vectorlib {

/// How a scan lies in a map at some pose.
struct PlaceFit {
    Transformation2D pose;      ///< of the sensor in the map's frame
    double points = 0;          ///< that were compared
    double explained = 0;       ///< of them, with a wall of the map beside them that faces alike
    double distances = 0;       ///< sum of their squared distances, in units of the gate
    double hidden = 0;          ///< explained points that another wall of the map hides
    double blocked = 0;         ///< other points that a wall of the map hides
    double extra = 0;           ///< points where the map knows no wall, in open view
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero(); ///< of x, y, alpha in the map's frame, in units of 1/variance of a point
    double xx = 0, xy = 0, yy = 0; ///< over the normals of the walls

    double score() const {
        return points > 0 ? (explained - 0.5 * distances - 0.2 * hidden - 0.3 * blocked) / points : 0;
    }
    double reliability() const {
        const double sum = xx + yy;
        return sum > 0 ? 2 * std::sqrt(std::max(0.0, xx * yy - xy * xy)) / sum : 0;
    }
};

struct PlaceFitSettings {
    double firstGate = 0.35, gate = 0.2; ///< points farther from a wall are no pairs; metres
    int iterations = 8;
    double tolerance = 0.2; ///< a wall is looked through where point and sensor are farther from it; metres
};

/// Brings the points of a scan onto the walls of a map, from a pose nearby, and tells how well they lie there.
class PlaceFitter {
public:
    PlaceFitSettings settings;

    Transformation2D refine(const WallTiles &tiles, const std::vector<WallPoint> &points, Transformation2D pose, int sample, int iterations, double gate) {
        for (int i = 0; i < iterations; ++i) {
            const Transformation2D next = improved(tiles, points, pose, gate, sample);
            const Transformation2D step = pose.inverse() * next;
            pose = next;
            if (gate <= settings.gate && step.translation().norm() < 0.005 && std::abs(step.sin()) < 0.002)
                break;
            gate = std::max(settings.gate, 0.6 * gate);
        }
        return pose;
    }
    PlaceFit judge(const WallTiles &tiles, const std::vector<WallPoint> &points, const Transformation2D &pose, int sample = 1, bool look = true) {
        PlaceFit fit;
        fit.pose = pose;
        const Vector sensor = pose.translation();
        for (std::size_t i = 0; i < points.size(); i += std::size_t(sample)) {
            const WallPoint &point = points[i];
            const Vector p = pose * Vector(point.position), d = pose.rotate(Vector(point.direction));
            ++fit.points;
            double across = 0;
            const int k = nearest(tiles, p, d, settings.gate, across);
            const bool seenThrough = look && isBlocked(tiles, sensor, p);
            if (k >= 0) {
                ++fit.explained;
                fit.hidden += seenThrough;
                fit.distances += across * across / (settings.gate * settings.gate);
                const Vector n = tiles.wall(k).normal();
                fit.xx += n.x * n.x;
                fit.xy += n.x * n.y;
                fit.yy += n.y * n.y;
            } else
                ++(seenThrough ? fit.blocked : fit.extra);
        }
        return fit;
    }

private:
    using Vector = Vector2D<double>;
    static int nearest(const WallTiles &tiles, Vector p, Vector d, double gate, double &across) {
        int best = -1;
        double least = gate;
        tiles.forEachNear(p, [&](int number) {
            const LineSegment2D<double> &wall = tiles.wall(number);
            if (wall.direction().dot(d) < 0.8)
                return;
            const double a = wall.across(p);
            if (std::abs(a) >= least)
                return;
            const double t = wall.along(p), beyond = std::max({0.0, -t, t - wall.length()});
            if (beyond > 0.1)
                return;
            least = std::abs(a);
            across = a;
            best = number;
        });
        return best;
    }
    Transformation2D improved(const WallTiles &tiles, const std::vector<WallPoint> &points, const Transformation2D &pose,
                              double gate, int sample) const {
        Eigen::Matrix3d h = Eigen::Vector3d(0.1, 0.1, 0.1).asDiagonal();
        Eigen::Vector3d g = Eigen::Vector3d::Zero();
        const double inverse = 1 / (0.5 * gate * 0.5 * gate);
        for (std::size_t i = 0; i < points.size(); i += std::size_t(sample)) {
            const Vector turned = pose.rotate(Vector(points[i].position)), p = pose.translation() + turned;
            const Vector d = pose.rotate(Vector(points[i].direction));
            double r = 0;
            const int k = nearest(tiles, p, d, gate, r);
            if (k < 0)
                continue;
            const Vector n = tiles.wall(k).normal();
            const double u = turned.cross(n), q = 1 / (1 + r * r * inverse), w = q * q;
            h(0, 0) += w * n.x * n.x;
            h(1, 0) += w * n.x * n.y;
            h(2, 0) += w * n.x * u;
            h(1, 1) += w * n.y * n.y;
            h(2, 1) += w * n.y * u;
            h(2, 2) += w * u * u;
            g += (w * r) * Eigen::Vector3d(n.x, n.y, u);
        }
        h(0, 1) = h(1, 0);
        h(0, 2) = h(2, 0);
        h(1, 2) = h(2, 1);
        const auto back = solveSymmetric(h, g);
        if (!back)
            return pose;
        return {pose.x() - (*back)(0), pose.y() - (*back)(1), pose.alpha() - (*back)(2)};
    }
    // Whether a wall stands clearly between the sensor and the point.
    bool isBlocked(const WallTiles &tiles, Vector sensor, Vector p) const {
        const Vector way = p - sensor;
        const double length = way.norm(), tolerance = settings.tolerance;
        if (length < 2 * tolerance)
            return false;
        bool blocked = false;
        const double step = 0.5 * WallTiles::tile;
        for (double t = 0; t < length && !blocked; t += step)
            tiles.forEachNear(sensor + way * (t / length), [&](int number) {
                const LineSegment2D<double> &wall = tiles.wall(number);
                const double a = wall.across(sensor), b = wall.across(p);
                if (a * b >= 0 || std::abs(a) < tolerance || std::abs(b) < tolerance)
                    return;
                const Vector crossing = sensor + way * (a / (a - b));
                const double along = wall.along(crossing);
                blocked = blocked || (along > 0.1 && along < wall.length() - 0.1);
            });
        return blocked;
    }
};

} // namespace vectorlib
