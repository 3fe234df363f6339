#pragma once

#include "vectorlib/geometry/LineSegment2D.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vectorlib {

/// A spatial index of line segments: square cells of a hash grid, each with the numbers of the segments that
/// pass through it. The cost of a query follows the region and what lies in it, not the map.
class SegmentGrid {
public:
    explicit SegmentGrid(double cell = 2.0)
        : cell_(cell) {}

    void clear() {
        cells_.clear();
        mark_.clear();
    }
    /// Enters a segment under its number; entering it again after it grew adds the new cells. Nothing is
    /// taken out: whoever asks checks what it finds.
    void insert(int number, const LineSegment2D<double> &segment) {
        const int steps = 1 + static_cast<int>(segment.length() / (0.5 * cell_));
        for (int i = 0; i <= steps; ++i) {
            const Vector2D<double> p =
                segment.begin() + (segment.end() - segment.begin()) * (double(i) / steps);
            std::vector<int> &cell = cells_[key(index(p.x), index(p.y))];
            if (cell.empty() || cell.back() != number)
                if (std::find(cell.begin(), cell.end(), number) == cell.end())
                    cell.push_back(number);
        }
        if (static_cast<std::size_t>(number) >= mark_.size())
            mark_.resize(static_cast<std::size_t>(number) + 1, 0);
    }
    /// Calls take(number) once for every segment near the box; at most two cells beyond it, never fewer than
    /// those that touch it.
    template <typename Take>
    void query(Vector2D<double> low, Vector2D<double> high, Take take) {
        ++query_;
        // Sampling at half a cell can cut a corner of at most a quarter of a cell: one cell of margin covers
        // it.
        const std::int64_t left = index(low.x) - 1, right = index(high.x) + 1;
        const std::int64_t bottom = index(low.y) - 1, top = index(high.y) + 1;
        const double cells =
            std::max(0.0, double(right - left + 1)) * std::max(0.0, double(top - bottom + 1));
        constexpr double many = 1e5; // of a box as large as a town most have nothing in them
        if (cells > many && cells > double(cells_.size())) {
            for (const auto &[place, numbers] : cells_) {
                const auto [i, j] = cellOf(place);
                if (i >= left && i <= right && j >= bottom && j <= top)
                    takeNew(numbers, take);
            }
            return;
        }
        for (std::int64_t i = left; i <= right; ++i)
            for (std::int64_t j = bottom; j <= top; ++j) {
                const auto cell = cells_.find(key(i, j));
                if (cell != cells_.end())
                    takeNew(cell->second, take);
            }
    }

    /// The same for every segment that may lie within `margin` of another one (metres).
    template <typename Take>
    void query(const LineSegment2D<double> &segment, double margin, Take take) {
        const Vector2D<double> a = segment.begin(), b = segment.end(), beside(margin, margin);
        query(Vector2D<double>(std::min(a.x, b.x), std::min(a.y, b.y)) - beside,
              Vector2D<double>(std::max(a.x, b.x), std::max(a.y, b.y)) + beside, take);
    }

private:
    template <typename Take>
    void takeNew(const std::vector<int> &numbers, Take &take) {
        for (int number : numbers)
            if (mark_[static_cast<std::size_t>(number)] != query_) {
                mark_[static_cast<std::size_t>(number)] = query_;
                take(number);
            }
    }
    // Cells beyond 10^9 are all one, so that no coordinate overflows; NaN is in cell 0.
    std::int64_t index(double v) const {
        const double i = std::floor(v / cell_);
        return i == i ? static_cast<std::int64_t>(std::clamp(i, -1e9, 1e9)) : 0;
    }
    static std::int64_t key(std::int64_t i, std::int64_t j) {
        return static_cast<std::int64_t>((static_cast<std::uint64_t>(i) << 32) ^
                                         (static_cast<std::uint64_t>(j) & 0xffffffffu));
    }
    static std::pair<std::int64_t, std::int64_t> cellOf(std::int64_t key) {
        return {key >> 32, static_cast<std::int32_t>(static_cast<std::uint32_t>(key))};
    }
    // Of both halves of a key: std::hash of 32 bits takes the lower one.
    struct Hash {
        std::size_t operator()(std::int64_t key) const {
            return static_cast<std::size_t>((static_cast<std::uint64_t>(key) * 0x9E3779B97F4A7C15u) >> 32);
        }
    };

    double cell_;
    std::unordered_map<std::int64_t, std::vector<int>, Hash> cells_;
    std::vector<unsigned> mark_; // the last query that took each number
    unsigned query_ = 0;
};

} // namespace vectorlib
