#include "vectorlib/places/PlaceFitter.h"
#include "vectorlib/geometry/SmallMatrix.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY double PlaceFit::leadOver(const PlaceFit &other) const {
    double sum = 0, strongest = 0;
    for (std::size_t i = 0; i + 1 < said.size(); ++i) {
        const double more = said[i] - other.said[i];
        sum += more;
        strongest = std::max(strongest, more);
    }
    const double byHidden = std::min(said.back() - other.said.back(), maxHiddenLead * points);
    return points > 0 ? (sum - strongest + byHidden) / points : 0;
}

VECTORLIB_BODY double PlaceFit::reliability() const {
    const double xx = information(0, 0), yy = information(1, 1), xy = information(1, 0);
    return xx + yy > 0 ? 2 * std::sqrt(std::max(0.0, xx * yy - xy * xy)) / (xx + yy) : 0;
}

VECTORLIB_BODY std::optional<Eigen::Matrix3d> PlaceFit::covariance() const {
    if (!(reliability() > 1e-3))
        return std::nullopt;
    const Eigen::Matrix3d c = information.inverse() * (4 * std::max(meanSquare(), 0.02 * 0.02));
    return c.allFinite() && c(2, 2) > 0 ? std::optional<Eigen::Matrix3d>(c) : std::nullopt;
}

VECTORLIB_BODY Transformation2D PlaceFitter::refine(const WallTiles &tiles,
                                                    const std::vector<WallPoint> &points,
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

VECTORLIB_BODY PlaceFit PlaceFitter::judge(const WallTiles &tiles, const std::vector<WallPoint> &points,
                                           const Transformation2D &pose, std::size_t sample,
                                           bool looksThrough, double wallOfPoint) const {
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
        if (beyond > 0 && beside.wall < 0 && behind == 0)
            fit.before += seenBehind(tiles, p, p + turned * (beyond / turned.norm()), true) > 0;
        if (behind > 0)
            fit.discrepancy += areaBehind(points[i], behind, wallOfPoint * double(sample));
    }
    return fit;
}

VECTORLIB_BODY PlaceFitter::Beside PlaceFitter::wallBeside(const WallTiles &tiles, Vector p, Vector direction,
                                                           double width) const {
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

VECTORLIB_BODY Transformation2D PlaceFitter::improved(const WallTiles &tiles,
                                                      const std::vector<WallPoint> &points,
                                                      const Transformation2D &pose, double width,
                                                      std::size_t sample) const {
    // A little inertia, for what the walls leave open.
    Eigen::Matrix3d h = Eigen::Vector3d(0.1, 0.1, 0.1).asDiagonal();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    const double inverse = 1 / (scale * scale * width * width);
    for (std::size_t i = 0; i < points.size(); i += sample) {
        const Vector turned = pose.rotate(Vector(points[i].position));
        const Beside beside =
            wallBeside(tiles, pose.translation() + turned, pose.rotate(Vector(points[i].direction)), width);
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

VECTORLIB_BODY double PlaceFitter::seenBehind(const WallTiles &tiles, Vector sensor, Vector p,
                                              bool fronts) const {
    const Vector way = p - sensor;
    const double length = std::min(way.norm(), farthestLook);
    double behind = 0;
    for (double t = 0; t < length && behind == 0; t += 0.5 * WallTiles::tile)
        tiles.forEachNear(sensor + way * (t / way.norm()), [&](int number) {
            const LineSegment2D<double> &wall = tiles.wall(number);
            const double a = wall.across(sensor), b = wall.across(p);
            if (a * b >= 0 || (fronts && a < 0) || std::min(std::abs(a), std::abs(b)) < clearly)
                return;
            const double at = a / (a - b), along = wall.along(sensor + way * at);
            if (wall.length() >= shortest && along > beyondEnd && along < wall.length() - beyondEnd)
                behind = std::max(behind, 1 - at);
        });
    return behind;
}

} // namespace vectorlib
