#include "vectorlib/places/WallTiles.h"

namespace vectorlib {

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

VECTORLIB_BODY bool WallTiles::add(int number, const Wall &wall) {
    std::size_t needed = 0;
    forEachTile(wall, near, [&](std::int32_t, std::int32_t) { ++needed; });
    if (entries_ + needed > maxEntries)
        return false;
    entries_ += needed;
    if (static_cast<std::size_t>(number) >= walls_.size())
        walls_.resize(static_cast<std::size_t>(number) + 1);
    walls_[static_cast<std::size_t>(number)] = wall;
    forEachTile(wall, near, [&](std::int32_t i, std::int32_t j) {
        const auto at = static_cast<std::size_t>(table_.enter(i, j));
        if (at == tiles_.size()) {
            tiles_.push_back({i, j, -1, {}});
            last_ = unknown;
        }
        Tile &t = tiles_[at];
        t.walls.insert(std::lower_bound(t.walls.begin(), t.walls.end(), number), number);
        if (t.raster >= 0)
            draw(t, wall);
    });
    return true;
}

VECTORLIB_BODY void WallTiles::remove(int number) {
    forEachTile(wall(number), near, [&](std::int32_t i, std::int32_t j) {
        Tile &t = tiles_[static_cast<std::size_t>(table_.find(i, j))];
        const auto at = std::lower_bound(t.walls.begin(), t.walls.end(), number);
        if (at != t.walls.end() && *at == number) {
            t.walls.erase(at);
            --entries_;
        }
        if (t.raster >= 0)
            redraw(t);
    });
}

VECTORLIB_BODY bool WallTiles::shows(Vector p, std::uint8_t bit) {
    const std::int32_t i = table_.index(p.x), j = table_.index(p.y);
    if (i != lastI_ || j != lastJ_ || last_ == unknown) {
        const int at = table_.find(i, j);
        last_ = at >= 0 ? rasterOf(tiles_[static_cast<std::size_t>(at)]) : none;
        lastI_ = i;
        lastJ_ = j;
    }
    if (last_ == none)
        return false;
    const int x = cellOf(p.x - i * tile), y = cellOf(p.y - j * tile);
    return (rasters_[static_cast<std::size_t>(last_)][static_cast<std::size_t>(y * side + x)] & bit) != 0;
}

VECTORLIB_BODY int WallTiles::rasterOf(Tile &t) {
    if (t.raster < 0) {
        if (rasters_.size() >= maxRasters)
            forgetRasters();
        t.raster = static_cast<int>(rasters_.size());
        rasters_.emplace_back();
        redraw(t);
    }
    return t.raster;
}

VECTORLIB_BODY void WallTiles::forgetRasters() {
    rasters_.clear();
    last_ = unknown;
    for (Tile &t : tiles_)
        t.raster = -1;
}

VECTORLIB_BODY void WallTiles::draw(Tile &t, const Wall &wall) {
    const Vector corner(t.i * tile, t.j * tile);
    Raster &raster = rasters_[static_cast<std::size_t>(t.raster)];
    const std::uint8_t bits = facingBits(wall.direction());
    // The part of the wall near the tile.
    const Vector middle = corner + Vector(tile / 2, tile / 2);
    const double reach = tile * 0.7072 + beside, foot = wall.along(middle);
    if (std::abs(wall.across(middle)) > reach || foot < -reach || foot > wall.length() + reach)
        return;
    const Vector a = wall.begin() + wall.direction() * std::clamp(foot - reach, 0.0, wall.length()) - corner;
    const Vector b = wall.begin() + wall.direction() * std::clamp(foot + reach, 0.0, wall.length()) - corner;
    const int left = cellOf(std::min(a.x, b.x) - beside), right = cellOf(std::max(a.x, b.x) + beside);
    const int low = cellOf(std::min(a.y, b.y) - beside), high = cellOf(std::max(a.y, b.y) + beside);
    const Wall part(a, b, wall.direction());
    for (int y = low; y <= high; ++y)
        for (int x = left; x <= right; ++x)
            if (part.distance({(x + 0.5) * cell, (y + 0.5) * cell}) <= beside)
                raster[static_cast<std::size_t>(y * side + x)] |= bits;
}

} // namespace vectorlib
