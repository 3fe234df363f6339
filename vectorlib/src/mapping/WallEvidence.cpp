#include "vectorlib/mapping/WallEvidence.h"

#include "vectorlib/observation/Sector.h"

#include <utility>

namespace vectorlib {

VECTORLIB_BODY void WallEvidence::operator()(const std::vector<LineSegment2D<double>> &walls,
                                             const ScanDrive &drive) {
    divide(walls);
    const Pose2D *last = nullptr;
    for (std::size_t i = 0; i < drive.edges.size(); ++i) {
        const Pose2D &pose = drive.poses[i];
        if (drive.edges[i].empty() || (last && isSamePlace(*last, pose)))
            continue;
        last = &pose;
        look(drive.edges[i]);
        ask(walls, Transformation2D(pose));
    }
}

VECTORLIB_BODY int WallEvidence::directionOf(Vector2D<double> p) {
    return std::clamp(static_cast<int>((turnOf(p) + 2) * (directions / 4)), 0, directions - 1);
}

VECTORLIB_BODY Vector2D<double> WallEvidence::towards(int direction) {
    const double turn = (direction + 0.5) * (4.0 / directions) - 2, up = std::abs(turn), x = 1 - up;
    const double y = up <= 1 ? up : 2 - up;
    return {x, turn < 0 ? -y : y};
}

VECTORLIB_BODY void WallEvidence::divide(const std::vector<LineSegment2D<double>> &walls) {
    grid_.clear();
    starts_.assign(1, 0);
    for (std::size_t i = 0; i < walls.size(); ++i) {
        grid_.insert(static_cast<int>(i), walls[i]);
        const double count = std::round(walls[i].length() / settings.part);
        starts_.push_back(starts_.back() + std::max<std::size_t>(1, static_cast<std::size_t>(count)));
    }
    evidence_.assign(starts_.back(), {});
}

VECTORLIB_BODY bool WallEvidence::isSamePlace(const Pose2D &a, const Pose2D &b) const {
    return std::hypot(a.x - b.x, a.y - b.y) < settings.newPlace &&
           std::abs(wrapAngle(a.theta - b.theta)) < settings.newHeading;
}

VECTORLIB_BODY void WallEvidence::look(const std::vector<EdgeRaw2D> &edges) {
    range_.fill(0);
    for (const EdgeRaw2D &e : edges) {
        const Vector2D<double> begin = e.segment.begin(), end = e.segment.end();
        if (!(begin.cross(end) > 0)) // nor what is not finite
            continue;
        const SightLine line(begin, end);
        cutBehind(begin, end, 0, [&](const Sector &sector) {
            const int last = directionOf(sector.towardsLeft);
            for (int d = directionOf(sector.towardsRight); d <= last; ++d) {
                const Vector2D<double> to = towards(d);
                if (turnOf(to) < sector.right || turnOf(to) > sector.left)
                    continue;
                const double r = line.meet(to).norm();
                float &range = range_[static_cast<std::size_t>(d)];
                if (range == 0 || r < range)
                    range = static_cast<float>(r);
            }
        });
    }
}

VECTORLIB_BODY void WallEvidence::ask(const std::vector<LineSegment2D<double>> &walls,
                                      const Transformation2D &pose) {
    const Transformation2D toSensor = pose.inverse();
    const Vector2D<double> half(settings.reach, settings.reach), centre = pose.translation();
    grid_.query(centre - half, centre + half, [&](int number) {
        const std::size_t wall = static_cast<std::size_t>(number), count = parts(wall);
        const LineSegment2D<double> seen = toSensor * walls[wall];
        const double across = seen.across({0, 0});
        if (!(std::abs(across) <= settings.reach))
            return;
        const Vector2D<double> step = (seen.end() - seen.begin()) * (1.0 / double(count));
        for (std::size_t k = 0; k < count; ++k)
            judge(seen.begin() + step * (double(k) + 0.5), across, evidence_[starts_[wall] + k]);
    });
}

VECTORLIB_BODY void WallEvidence::judge(Vector2D<double> at, double across, PartEvidence &evidence) const {
    const double square = at.squaredNorm();
    if (!(square <= settings.reach * settings.reach))
        return;
    const double distance = std::sqrt(square), sine = std::abs(across) / distance;
    if (sine < settings.leastSine)
        return;
    const int d = directionOf(at);
    int known = 0;
    double least = settings.throughBehind + 1;
    bool isSeen = false;
    for (int i = d - 1; i <= d + 1; ++i) {
        const float range = range_[static_cast<std::size_t>((i + directions) % directions)];
        if (range == 0)
            continue;
        ++known;
        const double behind = (double(range) - distance) * sine;
        least = std::min(least, behind);
        isSeen = isSeen || std::abs(behind) <= settings.seenWithin;
    }
    if (isSeen && across > 0) {
        ++evidence.seen;
        evidence.throughBefore += std::exchange(evidence.throughAfter, 0);
    } else if (known == 3 && least > settings.throughBehind) {
        ++evidence.throughAfter;
    }
}

} // namespace vectorlib
