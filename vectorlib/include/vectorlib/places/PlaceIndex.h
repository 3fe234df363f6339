#pragma once

#include "vectorlib/mapping/VectorMap.h"
#include "vectorlib/places/Corner.h"
#include "vectorlib/places/WallTiles.h"

#include <vector>

namespace vectorlib {

/// The walls of a map and their corners, by what does not depend on a pose. Grows and changes with the map at
/// a cost that follows the change.
class PlaceIndex {
public:
    using Wall = LineSegment2D<double>;
    static constexpr int turnBins = 18; ///< of 10 degrees

    CornerSettings corner;
    double shortest = 0.10; ///< walls that have corners; metres

    void clear() {
        tiles_.clear();
        walls_.clear();
        for (auto &bin : corners_)
            bin.clear();
        for (auto &bin : byLength_)
            bin.clear();
        count_ = cornerCount_ = 0;
    }
    std::size_t size() const { return count_; }
    std::size_t corners() const { return cornerCount_; }
    WallTiles &tiles() { return tiles_; }

    /// Brings the index up to a map; only walls that changed since the last time cost more than a comparison.
    void follow(const VectorMap &map) {
        const std::vector<MapEdge> &slots = map.slots();
        for (std::size_t i = slots.size(); i < walls_.size(); ++i)
            set(static_cast<int>(i), nullptr);
        for (std::size_t i = 0; i < slots.size(); ++i)
            set(static_cast<int>(i), slots[i].observations > 0 ? &slots[i].segment : nullptr);
    }
    /// The wall of a number is now this one; none when null.
    void set(int number, const Wall *wall) {
        const auto at = static_cast<std::size_t>(number);
        if (at >= walls_.size()) {
            if (!wall)
                return;
            walls_.resize(at + 1);
        }
        if (wall && !isUsable(*wall))
            wall = nullptr;
        Known &known = walls_[at];
        if (known.there && wall && known.wall.begin() == wall->begin() && known.wall.end() == wall->end())
            return;
        if (known.there)
            remove(number);
        if (wall)
            add(number, *wall);
    }
    /// Calls take(wall) for the walls that are at least so long.
    template <typename Take>
    void forEachWall(double length, Take take) const {
        for (int bin = lengthBinOf(length); bin < lengthBins; ++bin)
            for (int number : byLength_[static_cast<std::size_t>(bin)])
                if (tiles_.wall(number).length() >= length)
                    take(tiles_.wall(number));
    }
    /// Calls take(corner) for the corners with about such a turn.
    template <typename Take>
    void forEachCorner(double turn, double tolerance, Take take) const {
        const int first = binOf(turn - tolerance), last = binOf(turn + tolerance);
        for (int bin = first; bin <= last; ++bin)
            for (const Corner &c : corners_[static_cast<std::size_t>(bin)])
                if (std::abs(c.turn - turn) <= tolerance)
                    take(c);
    }

private:
    static constexpr double longest = 2000, farthest = 1e7; // metres
    static constexpr int lengthBins = 32; // two for each doubling, from 0.1 m on
    struct Known {
        bool there = false;
        Wall wall;
        std::size_t place = 0; // among those of about its length
    };
    static int lengthBinOf(double length) {
        return length > 0.1 ? std::clamp(static_cast<int>(2 * std::log2(length * 10)), 0, lengthBins - 1) : 0;
    }
    static bool isUsable(const Wall &w) {
        return w.isFinite() && w.length() > 0 && w.length() <= longest &&
               std::max(std::abs(w.begin().x), std::abs(w.begin().y)) < farthest;
    }
    static int binOf(double turn) {
        return std::clamp(static_cast<int>(turn * (turnBins / pi)), 0, turnBins - 1);
    }
    void add(int number, const Wall &wall) {
        auto &alike = byLength_[static_cast<std::size_t>(lengthBinOf(wall.length()))];
        walls_[static_cast<std::size_t>(number)] = {true, wall, alike.size()};
        alike.push_back(number);
        ++count_;
        if (wall.length() >= shortest)
            findCorners(number, wall);
        tiles_.add(number, wall);
    }
    void remove(int number) {
        Known &known = walls_[static_cast<std::size_t>(number)];
        known.there = false;
        --count_;
        auto &alike = byLength_[static_cast<std::size_t>(lengthBinOf(known.wall.length()))];
        walls_[static_cast<std::size_t>(alike.back())].place = known.place;
        alike[known.place] = alike.back();
        alike.pop_back();
        tiles_.remove(number);
        for (auto &bin : corners_) {
            const auto end = std::remove_if(bin.begin(), bin.end(), [number](const Corner &c) {
                return c.first.wall == number || c.second.wall == number;
            });
            cornerCount_ -= std::size_t(bin.end() - end);
            bin.erase(end, bin.end());
        }
    }
    void findCorners(int number, const Wall &wall) {
        const Vector2D<double> more = wall.direction() * corner.widestGap;
        near_.clear();
        const Wall reach(wall.begin() - more, wall.end() + more, wall.direction());
        tiles_.forEachTile(reach, corner.widestGap, [&](std::int32_t i, std::int32_t j) {
            tiles_.forEachNear({(i + 0.5) * WallTiles::tile, (j + 0.5) * WallTiles::tile},
                               [this](int other) { near_.push_back(other); });
        });
        std::sort(near_.begin(), near_.end());
        near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
        for (int other : near_)
            if (tiles_.wall(other).length() >= shortest)
                if (const auto c = cornerOf(number, wall, other, tiles_.wall(other), corner)) {
                    corners_[static_cast<std::size_t>(binOf(c->turn))].push_back(*c);
                    ++cornerCount_;
                }
    }

    WallTiles tiles_;
    std::vector<Known> walls_; // by number
    std::array<std::vector<Corner>, turnBins> corners_;
    std::array<std::vector<int>, lengthBins> byLength_;
    std::size_t count_ = 0, cornerCount_ = 0;
    std::vector<int> near_;
};

} // namespace vectorlib
