#pragma once

#include "vectorlib/simd/Simd.h"
#include "vectorlib/vectorization/SumRow.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vectorlib {

/// The sums of all points before certain points of a cluster, one row for each of these, stored by column so
/// that four rows make one SIMD register. There are `margin` more rows on both sides for those who read eight
/// at a time.
class SumTable {
public:
    static constexpr std::ptrdiff_t margin = 8;

    /// Makes room for so many rows. Those in front of the first are 0; the others have no value yet.
    void reset(std::size_t rows) {
        rows += 2 * margin;
        if (rows > capacity_) {
            capacity_ = rows + rows / 2;
            memory_.assign(5 * capacity_, 0);
        }
    }
    // The columns, see SumRow.
    double *x() { return memory_.data() + margin; }
    double *y() { return x() + capacity_; }
    double *xx() { return x() + 2 * capacity_; }
    double *yy() { return x() + 3 * capacity_; }
    double *xy() { return x() + 4 * capacity_; }
    const double *x() const { return memory_.data() + margin; }
    const double *y() const { return x() + capacity_; }
    const double *xx() const { return x() + 2 * capacity_; }
    const double *yy() const { return x() + 3 * capacity_; }
    const double *xy() const { return x() + 4 * capacity_; }

    /// Writes row i.
    void set(std::ptrdiff_t i, const SumRow &sums) {
        x()[i] = sums.x;
        y()[i] = sums.y;
        xx()[i] = sums.xx;
        yy()[i] = sums.yy;
        xy()[i] = sums.xy;
    }
    /// Row i once more for all that follow: whoever reads eight rows at a time finds the last one again.
    void repeat(std::ptrdiff_t i) {
        for (double *column : {x(), y(), xx(), yy(), xy()})
            std::fill_n(column + i + 1, margin, column[i]);
    }
    VECTORLIB_INLINE SumRow row(std::ptrdiff_t i) const {
        return {x()[i], y()[i], xx()[i], yy()[i], xy()[i]};
    }

private:
    std::vector<double> memory_;
    std::size_t capacity_ = 0;
};

} // namespace vectorlib
