#include "gui/vector/evaluation/Revisits.h"

#include "vectorlib/geometry/Angle.h"

#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace hermes::vector {

using vectorlib::Pose2D;

namespace {

/// Numbers of poses by the square in which they lie.
class PoseGrid {
public:
    explicit PoseGrid(double side)
        : side_(side) {}

    void insert(const Pose2D &pose, std::size_t number) {
        cells_[keyOf(cellOf(pose.x), cellOf(pose.y))].push_back(number);
    }
    /// Those in the pose's square and the eight around it.
    template <typename Take>
    void forEachNear(const Pose2D &pose, Take take) const {
        for (std::int64_t x = cellOf(pose.x) - 1; x <= cellOf(pose.x) + 1; ++x)
            for (std::int64_t y = cellOf(pose.y) - 1; y <= cellOf(pose.y) + 1; ++y)
                if (const auto cell = cells_.find(keyOf(x, y)); cell != cells_.end())
                    for (const std::size_t number : cell->second)
                        take(number);
    }

private:
    std::int64_t cellOf(double metres) const { return std::int64_t(std::floor(metres / side_)); }
    static std::uint64_t keyOf(std::int64_t x, std::int64_t y) {
        return std::uint64_t(x) << 32 ^ (std::uint64_t(y) & 0xffffffff);
    }

    double side_;
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

std::vector<double> wayAlong(const std::vector<Pose2D> &drive) {
    std::vector<double> way(drive.size());
    for (std::size_t i = 1; i < drive.size(); ++i)
        way[i] = way[i - 1] + std::hypot(drive[i].x - drive[i - 1].x, drive[i].y - drive[i - 1].y);
    return way;
}

} // namespace

void forEachRevisit(const std::vector<Pose2D> &drive, const RevisitRule &rule,
                    const std::function<void(std::size_t, std::size_t)> &take) {
    const std::vector<double> way = wayAlong(drive);
    PoseGrid grid(rule.metres);
    std::size_t behind = 0; // poses far enough back on the way
    for (std::size_t later = 0; later < drive.size(); ++later) {
        for (; behind + rule.scans <= later && way[later] - way[behind] >= rule.way; ++behind)
            grid.insert(drive[behind], behind);
        const Pose2D &here = drive[later];
        grid.forEachNear(here, [&](std::size_t earlier) {
            const Pose2D &there = drive[earlier];
            const double turn = std::remainder(here.theta - there.theta, 2 * vectorlib::pi);
            if (std::hypot(here.x - there.x, here.y - there.y) < rule.metres &&
                std::abs(turn) < rule.degrees * vectorlib::pi / 180)
                take(earlier, later);
        });
    }
}

} // namespace hermes::vector
