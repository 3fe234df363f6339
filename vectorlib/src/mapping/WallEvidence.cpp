#include "vectorlib/mapping/WallEvidence.h"
#include "vectorlib/observation/Observer.h"

namespace vectorlib {

VECTORLIB_BODY void WallFinder::index(const VectorMap &map) {
    grid_.clear();
    walls_.clear();
    map.forEach([this](const MapEdge &e) {
        walls_.push_back({e.id, e.segment});
        grid_.insert(static_cast<int>(walls_.size()) - 1, e.segment);
    });
}

VECTORLIB_BODY std::int64_t WallFinder::operator()(const LineSegment2D<double> &edge) {
    std::int64_t nearest = -1;
    double least = maxDistance * maxDistance;
    // A wall beside half of the edge lies beside its middle.
    const Vector2D<double> margin(maxDistance, maxDistance);
    grid_.query(edge.middle() - margin, edge.middle() + margin, [&](int number) {
        const auto &[id, wall] = walls_[static_cast<std::size_t>(number)];
        if (wall.direction().dot(edge.direction()) < std::cos(maxAngle) ||
            2 * edge.overlap(wall) < edge.length())
            return;
        const double square = wall.meanSquareAcross(edge);
        if (square < least || (square == least && id < nearest)) {
            least = square;
            nearest = id;
        }
    });
    return nearest;
}

VECTORLIB_BODY void WallIds::keep(VectorMap &map, const ScanDrive &drive) {
    find(map, drive, new_);
    Lengths shared;
    std::size_t k = 0;
    for (const std::vector<EdgeRaw2D> &edges : drive.edges)
        for (const EdgeRaw2D &e : edges) {
            if (k < old_.size() && old_[k] >= 0 && new_[k] >= 0)
                shared[{new_[k], old_[k]}] += e.segment.length();
            ++k;
        }
    const auto best = bestOf(shared);
    std::vector<MapEdge> walls;
    map.forEach([&](const MapEdge &e) {
        walls.push_back(e);
        const auto found = best.find(e.id);
        walls.back().id = found != best.end() ? found->second : next_++;
    });
    map.assign(walls);
}

VECTORLIB_BODY void WallIds::find(const VectorMap &map, const ScanDrive &drive,
                                  std::vector<std::int64_t> &walls) {
    finder_.index(map);
    walls.clear();
    for (std::size_t i = 0; i < drive.edges.size(); ++i) {
        const Transformation2D pose(drive.poses[i]);
        for (const EdgeRaw2D &e : drive.edges[i])
            walls.push_back(finder_(pose * e.segment));
    }
}

VECTORLIB_BODY std::map<std::int64_t, std::int64_t> WallIds::bestOf(const Lengths &shared) {
    struct Most {
        std::int64_t wall = -1;
        double length = 0;
    };
    std::map<std::int64_t, Most> ofNew, ofOld;
    const auto offer = [](Most &most, std::int64_t wall, double length) {
        if (length > most.length)
            most = {wall, length};
    };
    for (const auto &[walls, length] : shared) {
        offer(ofNew[walls.first], walls.second, length);
        offer(ofOld[walls.second], walls.first, length);
    }
    std::map<std::int64_t, std::int64_t> result;
    for (const auto &[wall, most] : ofNew)
        if (ofOld[most.wall].wall == wall)
            result[wall] = most.wall;
    return result;
}

VECTORLIB_BODY void WallEvidence::operator()(const std::vector<LineSegment2D<double>> &walls,
                                             const ScanDrive &drive) {
    divide(walls);
    const Pose2D *last = nullptr;
    for (std::size_t i = 0; i < drive.edges.size(); ++i) {
        const Pose2D &pose = drive.poses[i];
        if (drive.edges[i].empty() || (last && isSamePlace(*last, pose)))
            continue;
        last = &pose;
        look(drive.edges[i], drive.own ? (*drive.own)[i] : drive.edges[i].size());
        ask(walls, Transformation2D(pose));
    }
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

VECTORLIB_BODY void WallEvidence::look(const std::vector<EdgeRaw2D> &edges, std::size_t count) {
    range_.fill(0);
    for (std::size_t i = 0; i < count && i < edges.size(); ++i) {
        const Vector2D<double> begin = edges[i].segment.begin(), end = edges[i].segment.end();
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
