#pragma once

#include "vectorlib/geometry/LineSegment2D.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// Segments by the line they lie on and by their place along it, both seen from the origin. Rotated about the
/// origin a segment keeps both, so that whatever a rotation and a short shift bring onto a line is found by
/// them, without looking at all others. Keeps its buffers.
class NearLines {
public:
    /// Takes finite segments of some length, in a frame whose origin is the centre of rotation. `reach`: the
    /// longest shift; metres.
    void build(const std::vector<LineSegment2D<double>> &segments, double reach) {
        reach_ = std::min(reach, 1e12) + rounding;
        longest_ = 0;
        entries_.clear();
        for (const LineSegment2D<double> &s : segments) {
            entries_.push_back({rowOf(across(s)), along(s), static_cast<int>(entries_.size())});
            longest_ = std::max(longest_, s.length());
        }
        std::sort(entries_.begin(), entries_.end());
    }
    /// Calls take(number) for every segment that a rotation about the origin and then a shift of at most
    /// `reach` bring onto the line of `s` and beside it, and for some more; ends where it returns false.
    template <typename Take>
    void query(const LineSegment2D<double> &s, Take take) const {
        const double from = along(s) - reach_ - longest_, to = along(s) + s.length() + reach_;
        const std::int64_t last = rowOf(across(s) + reach_);
        for (std::int64_t row = rowOf(across(s) - reach_); row <= last; ++row) {
            auto e = std::lower_bound(entries_.begin(), entries_.end(), Entry{row, from, -1});
            for (; e != entries_.end() && e->row == row && e->along <= to; ++e)
                if (!take(e->number))
                    return;
        }
    }

private:
    static constexpr double rounding = 1e-6; // of products of coordinates up to 10^9 m; metres

    struct Entry {
        std::int64_t row;
        double along; // where it begins; metres
        int number;

        bool operator<(const Entry &o) const {
            return row != o.row ? row < o.row : along != o.along ? along < o.along : number < o.number;
        }
    };

    static double across(const LineSegment2D<double> &s) { return s.begin().dot(s.normal()); }
    static double along(const LineSegment2D<double> &s) { return s.begin().dot(s.direction()); }
    // Rows are as high as the reach, so that a query looks at three or four.
    std::int64_t rowOf(double across) const {
        return static_cast<std::int64_t>(std::clamp(std::floor(across / reach_), -1e15, 1e15));
    }

    double reach_ = 1, longest_ = 0;
    std::vector<Entry> entries_;
};

} // namespace vectorlib
