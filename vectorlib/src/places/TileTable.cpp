#include "vectorlib/places/TileTable.h"

#include "vectorlib/geometry/Vector2D.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY std::int32_t TileTable::index(double coordinate) const {
    const double i = std::floor(coordinate * perMetre_);
    return i == i ? static_cast<std::int32_t>(std::clamp(i, -1e9, 1e9)) : 0;
}

VECTORLIB_BODY int TileTable::find(std::int32_t i, std::int32_t j) const {
    if (slots_.empty())
        return -1;
    for (std::size_t at = hash(i, j);; ++at) {
        const Slot &slot = slots_[at & (slots_.size() - 1)];
        if (slot.number < 0 || (slot.i == i && slot.j == j))
            return slot.number;
    }
}

VECTORLIB_BODY int TileTable::enter(std::int32_t i, std::int32_t j) {
    const int known = find(i, j);
    if (known >= 0)
        return known;
    if (2 * (count_ + 1) > slots_.size())
        grow();
    put({i, j, static_cast<int>(count_)});
    return static_cast<int>(count_++);
}

VECTORLIB_BODY std::size_t TileTable::hash(std::int32_t i, std::int32_t j) {
    const std::uint64_t key =
        static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32 | static_cast<std::uint32_t>(j);
    return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15u) >> 32);
}

VECTORLIB_BODY void TileTable::put(const Slot &slot) {
    std::size_t at = hash(slot.i, slot.j) & (slots_.size() - 1);
    while (slots_[at].number >= 0)
        at = (at + 1) & (slots_.size() - 1);
    slots_[at] = slot;
}

VECTORLIB_BODY void TileTable::grow() {
    std::vector<Slot> old(std::max<std::size_t>(64, 2 * slots_.size()));
    old.swap(slots_);
    for (const Slot &slot : old)
        if (slot.number >= 0)
            put(slot);
}

} // namespace vectorlib
