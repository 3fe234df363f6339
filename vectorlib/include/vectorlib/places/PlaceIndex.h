#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/MapEdge.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/places/WallTiles.h"

#include <algorithm>
#include <array>
#include <vector>

namespace vectorlib {

/// The walls of a map for the search of places: by length, and by where they are. Grows and changes with the
/// map at a cost that follows the change.
class PlaceIndex {
public:
    using Wall = LineSegment2D<double>;

    /// Forgets the walls and frees their memory.
    void clear();
    /// Walls of the map.
    std::size_t size() const { return size_; }
    /// Walls that are too long, too far away or too many: they are not searched.
    std::size_t leftOut() const { return leftOut_; }
    WallTiles &tiles() { return tiles_; }

    /// Brings the index up to a map (VectorMap::slots). A wall that did not change since the last time costs
    /// a comparison. A map never loses slots: one with fewer is another map, and the index is made anew.
    /// False when `isLate` said so before all was done; the next call goes on from there.
    template <typename IsLate>
    bool follow(const std::vector<MapEdge> &slots, IsLate isLate) {
        if (slots.size() < walls_.size())
            clear();
        const std::size_t begin = followed_ < slots.size() ? followed_ : 0;
        for (std::size_t done = 0; done < slots.size(); ++done) {
            const std::size_t i = begin + done < slots.size() ? begin + done : begin + done - slots.size();
            followed_ = i;
            if (done % 64 == 63 && isLate())
                return false;
            set(static_cast<int>(i), slots[i].observations > 0 ? &slots[i].segment : nullptr);
        }
        followed_ = 0;
        return true;
    }
    /// The same without an end before all is done.
    bool follow(const std::vector<MapEdge> &slots) {
        return follow(slots, [] { return false; });
    }
    /// The wall of a number is now this one; none when null. One that was refused is tried again.
    void set(int number, const Wall *wall);
    /// Calls take(wall) for the walls that are at least so long, while it returns true.
    template <typename Take>
    bool forEachWall(double length, Take take) const {
        for (int bin = lengthBinOf(length); bin < lengthBins; ++bin)
            for (const int number : byLength_[static_cast<std::size_t>(bin)])
                if (const Wall &wall = tiles_.wall(number); wall.length() >= length && !take(wall))
                    return false;
        return true;
    }

private:
    static constexpr double longest = 2000, farthest = 1e7; // metres
    static constexpr int lengthBins = 32;                   // two for each doubling, from 0.1 m on
    struct Known {
        bool there = false, isUsed = false;
        Wall wall;
        std::size_t place = 0; // among those of about its length
    };

    static bool isUsable(const Wall &w);
    static int lengthBinOf(double length) {
        return length > 0.1 ? std::clamp(static_cast<int>(2 * std::log2(length * 10)), 0, lengthBins - 1) : 0;
    }
    std::vector<int> &alike(const Wall &wall) {
        return byLength_[static_cast<std::size_t>(lengthBinOf(wall.length()))];
    }
    void add(int number, const Wall &wall);
    void remove(int number);

    WallTiles tiles_;
    std::vector<Known> walls_; // by number
    std::array<std::vector<int>, lengthBins> byLength_;
    std::size_t size_ = 0, leftOut_ = 0;
    std::size_t followed_ = 0; // where the next call goes on
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/PlaceIndex.cpp")
