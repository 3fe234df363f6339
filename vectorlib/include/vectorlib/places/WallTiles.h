#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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
    int find(std::int32_t i, std::int32_t j) const;
    /// The number of a tile, which is entered when it is new.
    int enter(std::int32_t i, std::int32_t j);

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
    void put(const Slot &slot);
    void grow();

    double perMetre_;
    std::vector<Slot> slots_; // a power of two of them, at most half of them taken
    std::size_t count_ = 0;
};

/// Which eighth of a turn a direction lies in, 0 to 7 counter-clockwise from the x axis.
template <typename Scalar>
int octantOf(Vector2D<Scalar> d) {
    int octant = 0;
    if (d.y < 0) {
        d = -d;
        octant = 4;
    }
    if (d.x < 0) {
        d = {d.y, -d.x};
        octant += 2;
    }
    return (octant + (d.y > d.x)) & 7;
}

/// One bit for the eighth of a turn that a wall faces: its direction with free space on the left.
template <typename Scalar>
std::uint8_t facingBit(Vector2D<Scalar> direction) {
    return static_cast<std::uint8_t>(1u << octantOf(direction));
}

/// The bits of all directions within 25 degrees of a wall's.
inline std::uint8_t facingBits(Vector2D<double> direction) {
    constexpr double cosine = 0.9063, sine = 0.4226;
    const Vector2D<double> d = direction;
    return static_cast<std::uint8_t>(
        facingBit(d) | facingBit(Vector2D<double>(cosine * d.x - sine * d.y, sine * d.x + cosine * d.y)) |
        facingBit(Vector2D<double>(cosine * d.x + sine * d.y, cosine * d.y - sine * d.x)));
}

/// The walls of a map by place, in square tiles: which walls lie near a point, what a ray meets, and, in
/// cells of 10 cm, whether a wall that faces some way is beside a point. Walls come and go by number. Map
/// frame; metres.
class WallTiles {
public:
    using Vector = Vector2D<double>;
    using Wall = LineSegment2D<double>;

    static constexpr double cell = 0.1;   ///< metres
    static constexpr int side = 8;        ///< of a tile, in cells
    static constexpr double tile = 0.8;   ///< metres
    static constexpr double beside = 0.2; ///< a wall fills the cells whose middles are so near; metres
    static constexpr double near = 0.35;  ///< a tile lists the walls that are so near to it; metres

    /// Of walls in tiles, some 100 bytes each at worst: walls beyond are refused.
    std::size_t maxEntries = 8000000;

    /// The wall that was added under this number.
    const Wall &wall(int number) const { return walls_[static_cast<std::size_t>(number)]; }
    /// Tiles that had a wall at some time: the memory follows them.
    std::size_t tiles() const { return tiles_.size(); }

    /// Enters a wall; its number must be free. False, and nothing entered, when there is no room for it.
    bool add(int number, const Wall &wall);
    /// Takes out a wall that was added.
    void remove(int number);
    /// Calls take(number) for the walls of the tile that holds a point: all that are within `near` of it, and
    /// some more.
    template <typename Take>
    void forEachNear(Vector p, Take take) const {
        const int at = table_.find(table_.index(p.x), table_.index(p.y));
        if (at >= 0)
            for (int number : tiles_[static_cast<std::size_t>(at)].walls)
                take(number);
    }
    /// Whether a wall that faces in about the direction of `bit` is beside a point.
    bool shows(Vector p, std::uint8_t bit);
    /// Calls take(i, j) for the tiles within `margin` of a wall, and perhaps for some at their corners.
    template <typename Take>
    void forEachTile(const Wall &wall, double margin, Take take) const {
        const Vector a = wall.begin(), b = wall.end();
        const std::int32_t top = table_.index(std::max(a.y, b.y) + margin);
        for (std::int32_t j = table_.index(std::min(a.y, b.y) - margin); j <= top; ++j) {
            // The part of the wall within the row and its margin.
            double from = std::min(a.x, b.x), to = std::max(a.x, b.x);
            if (std::abs(b.y - a.y) > 1e-9) {
                const auto xAt = [&](double y) {
                    return a.x + (b.x - a.x) * std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0);
                };
                const double one = xAt(j * tile - margin), other = xAt((j + 1) * tile + margin);
                from = std::min(one, other);
                to = std::max(one, other);
            }
            const std::int32_t right = table_.index(to + margin);
            for (std::int32_t i = table_.index(from - margin); i <= right; ++i)
                take(i, j);
        }
    }

private:
    using Raster = std::array<std::uint8_t, side * side>;
    static constexpr int unknown = -2, none = -1;
    static constexpr std::size_t maxRasters = 1u << 20; // 64 MiB
    struct Tile {
        std::int32_t i, j;
        int raster;             // -1: not drawn
        std::vector<int> walls; // sorted
    };

    static int cellOf(double offset) {
        return std::clamp(static_cast<int>(offset * (1 / cell)), 0, side - 1);
    }
    int rasterOf(Tile &t);
    void forgetRasters();
    void redraw(Tile &t) {
        rasters_[static_cast<std::size_t>(t.raster)].fill(0);
        for (int number : t.walls)
            draw(t, wall(number));
    }
    void draw(Tile &t, const Wall &wall);

    TileTable table_{tile};
    std::vector<Tile> tiles_;
    std::vector<Wall> walls_; // by number
    std::vector<Raster> rasters_;
    std::size_t entries_ = 0;
    int last_ = unknown; // raster that was looked at
    std::int32_t lastI_ = 0, lastJ_ = 0;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/places/WallTiles.cpp")
