#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/edges/EdgeRaw2D.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/places/WallTiles.h"
#include "vectorlib/registration/ScanIndex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// A point of a scan and the direction of the wall there, free space on its left; sensor frame.
struct WallPoint {
    Vector2D<float> position;  ///< metres
    Vector2D<float> direction; ///< of unit length
    int object = 0;            ///< by ScanObjects
};

/// Tells which points of a scan lie on one and the same object, so that what they say is said once. An object
/// is a wall, or the walls that meet at corners that stick out, as those of a cupboard do; pieces of one line
/// are one wall.
class ScanObjects {
public:
    static constexpr int most = 63; ///< objects; the last one is all further ones
    double meeting = 0.25;          ///< between the ends of walls that meet; metres
    double sticksOut = 0.3;         ///< sine of the angle at such a corner, at least
    double beside = 0.1;            ///< a point lies on a wall so near; metres
    double sameLine = 0.985;        ///< cosine between pieces of one line, at least
    double gap = 0.3;               ///< between points of one object that is no wall; metres

    /// Walls with the most telling first, points counter-clockwise; both in the sensor's frame.
    void number(const std::vector<LineSegment2D<double>> &walls, std::vector<WallPoint> &points);

private:
    using Vector = Vector2D<double>;
    using Wall = LineSegment2D<double>;
    static constexpr double sameFacing = 0.8; // cosine between a point's wall and one it lies on, at least

    void join(const std::vector<Wall> &walls);
    bool isOne(const Wall &a, const Wall &b) const;
    int wallOf(const std::vector<Wall> &walls, const WallPoint &point) const;
    int root(int i) const {
        while (parent_[at(i)] != i)
            i = parent_[at(i)];
        return i;
    }
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }

    int count_ = 0; // of walls
    std::array<int, most> parent_{};
};

/// A scan as the search of a place needs it: its walls, the most telling first, and points that stand for
/// about as much wall each. Keeps its buffers.
class PlaceScan {
public:
    std::size_t maxPoints = 160; ///< that are compared with a map
    double spacing = 0.08;       ///< between them, at least; metres
    ScanObjects objects;

    /// Edges and points in the sensor's frame, metres; points counter-clockwise. Without points the edges
    /// stand for them. What is not finite is left out.
    void take(const std::vector<EdgeRaw2D> &edges, PointSpan<float> points);
    const std::vector<WallPoint> &points() const { return points_; }
    /// First the longest, then the longest that crosses it, then the others by length.
    const std::vector<LineSegment2D<double>> &walls() const { return walls_; }
    /// How much wall a point stands for; metres.
    double wallOfPoint() const { return wallOfPoint_; }

private:
    static constexpr std::size_t maxRead = 4000; // of a scan with more points, every n-th is read
    static constexpr double crossing = 0.5;      // sine of the angle of walls that cross

    void takeWalls(const std::vector<EdgeRaw2D> &edges);
    void takePoints(PointSpan<float> points);
    void takePointsOfWalls();
    // Keeps so many, evenly.
    void thin();

    ScanIndex index_;
    std::vector<WallPoint> points_;
    std::vector<LineSegment2D<double>> walls_;
    double wallOfPoint_ = 0;
};

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

    static bool isUsable(const Wall &w) {
        const double far = std::max(
            {std::abs(w.begin().x), std::abs(w.begin().y), std::abs(w.end().x), std::abs(w.end().y)});
        return w.length() <= longest && far < farthest;
    }
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
