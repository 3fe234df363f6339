#pragma once

#include "vectorlib/Body.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// The lists of scores of every pair of a reference segment (row) and a current one (column), and the merged
/// table of their sums. Pose-free thesis 5.2 to 5.5. A score that is in several lists is one: made invalid in
/// one it is gone from all. Scores are kept in units of 2^-40 as integers, so that a sum from which all was
/// taken away is exactly 0. Keeps its buffers.
class MatchingTable {
public:
    /// A pair of a reference segment (row) and a current one (column), and its merged score.
    struct Cell {
        int row = 0;
        int column = 0;
        double score = 0; ///< 0: there is none
    };

    /// Begins anew with an empty table of this size.
    void reset(std::size_t rows, std::size_t columns);
    int rows() const { return rows_; }
    int columns() const { return columns_; }
    /// The number of a cell, as add() takes it.
    std::size_t cell(int row, int column) const { return static_cast<std::size_t>(row * columns_ + column); }
    /// The sum of the valid scores of a pair.
    double merged(int row, int column) const { return double(merged_[cell(row, column)]) / unit; }
    std::size_t scores() const { return scores_.size(); }

    /// Adds one score to the lists of up to four cells; the same cell twice counts once. Algorithm 4, lines
    /// 14 to 19.
    void add(double score, const std::size_t *cells, int count);
    /// The pair of the largest sum among those that are not taken; the first of equal ones. Algorithm 6.
    Cell maximum() const;
    /// Marks a pair as matched: maximum() does not give it again.
    void take(int row, int column) { taken_[cell(row, column)] = 1; }
    /// Makes all scores of a pair invalid, in all lists.
    void invalidate(int row, int column);
    /// Makes all other pairs of a row and a column invalid. Algorithm 7.
    void keepOnly(int row, int column);
    /// Makes all other pairs invalid that do not come in the order of this one: rows up to it with columns
    /// from it on, and rows from it on with columns up to it. Both calls of Algorithm 10.
    void keepInOrder(int row, int column);

private:
    static constexpr double unit = 1099511627776.0; // 2^40
    struct Score {
        std::int64_t value = 0;
        std::array<std::uint32_t, 4> cells{};
        std::array<std::int32_t, 4> next{}; // 4 * score + slot of the next entry of the cell's list; -1: end
        int count = 0;
    };

    int rows_ = 0, columns_ = 0;
    std::vector<Score> scores_;
    std::vector<std::int32_t> heads_;
    std::vector<std::int64_t> merged_;
    std::vector<std::uint8_t> taken_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/relations/MatchingTable.cpp")
