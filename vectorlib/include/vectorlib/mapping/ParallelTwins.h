#pragma once

#include "vectorlib/mapping/ScanDrive.h"
#include "vectorlib/mapping/WallFinder.h"

#include <map>
#include <tuple>

namespace vectorlib {

/// Two walls of a map side by side that face the same way.
struct TwinWalls {
    int first = 0, second = 0; ///< their numbers; the first was seen at least as often
    double distance = 0; ///< of the second in front of the first, in the middle of what they share; metres
    double from = 0, to = 0; ///< what they share, along the first; metres
    int witnesses = 0;       ///< scans that saw both at once, so far apart
};

/// Which walls ParallelTwins compares.
struct ParallelTwinsSettings {
    std::int64_t minObservations = 3; ///< walls that were seen less often are left out
    double maxAngle = pi / 18;        ///< between the two; radians
    double least = 0.05, most = 0.6;  ///< distance between the two; metres
    int enoughWitnesses = 2;          ///< with so many both are real: a door in its frame, a cupboard, glass
};

/// How much of a map is there twice; metres, of walls seen at least as often as was asked for.
struct TwinShare {
    double walls = 0; ///< length of all
    double twins = 0; ///< length of the parts beside a twin that is not real
    double real = 0;  ///< length of the parts beside a twin that is real
    double share() const { return walls > 0 ? twins / walls : 0; }
};

/// Finds walls that a map may hold twice: parallel, facing the same way, side by side over at least half of
/// the shorter one. Scans tell which of them are real: those that saw both at once.
class ParallelTwins {
public:
    ParallelTwinsSettings settings;

    /// All such pairs, the nearest first. Valid until the next call.
    const std::vector<TwinWalls> &operator()(const VectorMap &map, const ScanDrive &drive) {
        pairs_.clear();
        grid_.clear();
        map.forEach([this](const MapEdge &e) { grid_.insert(static_cast<int>(e.id), e.segment); });
        for (std::size_t i = 0; i < map.slots().size(); ++i)
            if (map.slots()[i].observations >= settings.minObservations)
                pairWith(map, static_cast<int>(i));
        if (!pairs_.empty())
            countWitnesses(map, drive);
        std::sort(pairs_.begin(), pairs_.end(), [](const TwinWalls &a, const TwinWalls &b) {
            const double p = std::abs(a.distance), q = std::abs(b.distance);
            return std::tie(p, a.first, a.second) < std::tie(q, b.first, b.second);
        });
        return pairs_;
    }
    /// How much of the map is there twice: the lengths of all such pairs.
    TwinShare share(const VectorMap &map, const ScanDrive &drive) {
        TwinShare result;
        map.forEach([&](const MapEdge &e) {
            if (e.observations >= settings.minObservations)
                result.walls += e.segment.length();
        });
        PartsOfWalls twins, real;
        for (const TwinWalls &pair : (*this)(map, drive)) {
            PartsOfWalls &parts = isReal(pair) ? real : twins;
            const LineSegment2D<double> &wall = map.slots()[std::size_t(pair.first)].segment;
            const LineSegment2D<double> &other = map.slots()[std::size_t(pair.second)].segment;
            const LineSegment2D<double> shared = wall.part(pair.from, pair.to);
            parts[pair.first].emplace_back(pair.from, pair.to);
            parts[pair.second].emplace_back(std::max(0.0, other.along(shared.begin())),
                                            std::min(other.length(), other.along(shared.end())));
        }
        result.twins = lengthOf(twins);
        result.real = lengthOf(real);
        return result;
    }
    /// Of a pair of the last call.
    bool isReal(const TwinWalls &pair) const { return pair.witnesses >= settings.enoughWitnesses; }

private:
    // Intervals along walls, by the numbers of the walls.
    using PartsOfWalls = std::map<int, std::vector<std::pair<double, double>>>;

    // What two intervals of one wall share counts once.
    static double lengthOf(PartsOfWalls &walls) {
        double sum = 0;
        for (auto &[number, parts] : walls) {
            std::sort(parts.begin(), parts.end());
            double end = 0;
            for (const auto &[from, to] : parts) {
                sum += std::max(0.0, to - std::max(from, end));
                end = std::max(end, to);
            }
        }
        return sum;
    }
    void pairWith(const VectorMap &map, int number) {
        const LineSegment2D<double> &wall = map.slots()[std::size_t(number)].segment;
        grid_.query(wall, settings.most, [&](int other) {
            const std::int64_t a = map.slots()[std::size_t(number)].observations;
            const std::int64_t b = map.slots()[std::size_t(other)].observations;
            if (b >= settings.minObservations && (b < a || (b == a && other > number)))
                addIfTwins(map, number, other);
        });
    }
    void addIfTwins(const VectorMap &map, int first, int second) {
        const LineSegment2D<double> &wall = map.slots()[std::size_t(first)].segment;
        const LineSegment2D<double> &other = map.slots()[std::size_t(second)].segment;
        if (wall.direction().dot(other.direction()) < std::cos(settings.maxAngle))
            return;
        TwinWalls pair{first,
                       second,
                       0,
                       std::max(0.0, wall.along(other.begin())),
                       std::min(wall.length(), wall.along(other.end())),
                       0};
        if (2 * (pair.to - pair.from) < std::min(wall.length(), other.length()) || pair.to <= pair.from)
            return;
        const Vector2D<double> middle = wall.begin() + wall.direction() * ((pair.from + pair.to) / 2);
        pair.distance = -other.across(middle);
        const double apart = std::abs(pair.distance);
        if (apart >= settings.least && apart <= settings.most)
            pairs_.push_back(pair);
    }
    void countWitnesses(const VectorMap &map, const ScanDrive &drive) {
        pairsOf_.clear();
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            pairsOf_[pairs_[i].first].push_back(i);
        find_.index(map);
        for (std::size_t i = 0; i < drive.edges.size(); ++i)
            askScan(map, drive.edges[i], Transformation2D(drive.poses[i]));
    }
    // A scan is a witness when what it saw of both walls is at least half as far apart as they are.
    void askScan(const VectorMap &map, const std::vector<EdgeRaw2D> &edges, const Transformation2D &pose) {
        seen_.clear();
        for (const EdgeRaw2D &e : edges) {
            const LineSegment2D<double> edge = pose * e.segment;
            const int number = static_cast<int>(find_(edge));
            if (number < 0)
                continue;
            const double off = map.slots()[std::size_t(number)].segment.across(edge.middle());
            Sight &sight = seen_[number];
            if (edge.length() > sight.length)
                sight = {edge.length(), off};
        }
        for (const auto &[number, sight] : seen_) {
            const auto found = pairsOf_.find(number);
            if (found == pairsOf_.end())
                continue;
            for (const std::size_t i : found->second) {
                const auto other = seen_.find(pairs_[i].second);
                if (other == seen_.end())
                    continue;
                const double seen = pairs_[i].distance + other->second.off - sight.off;
                const double ratio = seen / pairs_[i].distance;
                pairs_[i].witnesses += ratio > 0.5 && ratio < 1.5;
            }
        }
    }

    // The longest edge of a scan on a wall, and how far it lies in front of the wall.
    struct Sight {
        double length = 0, off = 0;
    };
    WallFinder find_;
    SegmentGrid grid_{1.0};
    std::vector<TwinWalls> pairs_;
    std::map<int, std::vector<std::size_t>> pairsOf_; // by the number of the first wall
    std::map<int, Sight> seen_;                       // by the number of the wall
};

} // namespace vectorlib
