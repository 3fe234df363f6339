#pragma once

#include "vectorlib/geometry/Vector2D.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// Numbers the square tiles of an unbounded plane in the order in which they are first entered: a hash table
/// with open addressing, a few nanoseconds a look-up.
class TileTable {
public:
    explicit TileTable(double side)
        : perMetre_(1 / side) {}

    /// Of the tile that holds a coordinate. Coordinates beyond 10^9 tiles are in the last one, NaN is in 0.
    std::int32_t index(double coordinate) const {
        const double i = std::floor(coordinate * perMetre_);
        return i == i ? static_cast<std::int32_t>(std::clamp(i, -1e9, 1e9)) : 0;
    }
    /// The number of a tile, or -1.
    int find(std::int32_t i, std::int32_t j) const {
        if (slots_.empty())
            return -1;
        for (std::size_t at = hash(i, j);; ++at) {
            const Slot &slot = slots_[at & (slots_.size() - 1)];
            if (slot.number < 0 || (slot.i == i && slot.j == j))
                return slot.number;
        }
    }
    /// The number of a tile, which is entered when it is new.
    int enter(std::int32_t i, std::int32_t j) {
        const int known = find(i, j);
        if (known >= 0)
            return known;
        if (2 * (count_ + 1) > slots_.size())
            grow();
        put({i, j, static_cast<int>(count_)});
        return static_cast<int>(count_++);
    }

private:
    struct Slot {
        std::int32_t i = 0, j = 0;
        int number = -1;
    };
    static std::size_t hash(std::int32_t i, std::int32_t j) {
        const std::uint64_t key =
            static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32 | static_cast<std::uint32_t>(j);
        return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> 32);
    }
    void put(const Slot &slot) {
        std::size_t at = hash(slot.i, slot.j) & (slots_.size() - 1);
        while (slots_[at].number >= 0)
            at = (at + 1) & (slots_.size() - 1);
        slots_[at] = slot;
    }
    void grow() {
        std::vector<Slot> old(std::max<std::size_t>(64, 2 * slots_.size()));
        old.swap(slots_);
        for (const Slot &slot : old)
            if (slot.number >= 0)
                put(slot);
    }

    double perMetre_;
    std::vector<Slot> slots_; // a power of two of them, at most half of them taken
    std::size_t count_ = 0;
};

} // namespace vectorlib
