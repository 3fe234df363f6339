#pragma once

#include "vectorlib/Body.h"

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
    std::int32_t index(double coordinate) const;
    /// The number of a tile, or -1.
    int find(std::int32_t i, std::int32_t j) const;
    /// The number of a tile, which is entered when it is new.
    int enter(std::int32_t i, std::int32_t j);

private:
    struct Slot {
        std::int32_t i = 0, j = 0;
        int number = -1;
    };
    static std::size_t hash(std::int32_t i, std::int32_t j);
    void put(const Slot &slot);
    void grow();

    double perMetre_;
    std::vector<Slot> slots_; // a power of two of them, at most half of them taken
    std::size_t count_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/TileTable.cpp")
