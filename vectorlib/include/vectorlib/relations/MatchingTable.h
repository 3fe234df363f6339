#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/relations/RelationSettings.h"
#include "vectorlib/relations/TypedSegment.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vectorlib {

/// Algorithm 2 with an erratum: whether two lengths with their types of ends may be of one structure. As
/// printed only equal lengths of complete segments pass, which measured lengths never are, and 4.1.1 asks
/// that they be sufficiently close. Lengths that differ by no more than the window and the slack of the ends
/// that are edges count as equal.
bool lengthsMayMatch(const TypedSegment &a, const TypedSegment &b, double window);

/// Whether two relative angles are no farther apart than the window; radians.
inline bool anglesMatch(double a, double b, double window) {
    return std::abs(wrapAngle(a - b)) <= window;
}

/// Which segments of one set may match which of another: 1 or 0 by row and column. Pose-free thesis 4.1.3:
/// lengths and types of ends (4.1.1), and the edges at their ends (4.1.2): where both have an edge at the
/// same end the angles must be equal, or keep the bound of a jump, and the segments beyond must have lengths
/// that may match. Keeps its buffer.
class ConsistencyTable {
public:
    using Segments = std::vector<TypedSegment>;

    /// Compares every segment of `rows` with every one of `columns`, both in the order of their scans.
    void fill(const Segments &rows, const Segments &columns, const RelationSettings &settings);
    /// Whether segment `row` of the first set may match segment `column` of the second.
    bool operator()(std::size_t row, std::size_t column) const {
        return cells_[row * columns_ + column] != 0;
    }
    /// The same for numbers that are not below 0.
    bool operator()(int row, int column) const {
        return (*this)(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
    }

private:
    static bool endsMayMatch(const Segments &a, std::size_t i, const Segments &b, std::size_t j,
                             const RelationSettings &settings);
    static bool beginsMayMatch(const Segments &a, std::size_t i, const Segments &b, std::size_t j,
                               const RelationSettings &settings);
    static bool cornersMayMatch(const Segments &a, std::size_t i, const Segments &b, std::size_t j,
                                const RelationSettings &settings);
    // The corner between segment i and the next one, seen in the other scan as a jump: what is hidden there
    // lies in its shadow.
    static bool keepsBound(const Segments &a, std::size_t i, const SegmentEnd &jump,
                           const RelationSettings &settings) {
        const double angle = relativeAngle(a[i].segment, a[i + 1].segment);
        return angle >= pi - settings.angleWindow && angle <= jump.bound + settings.angleWindow;
    }

    std::size_t columns_ = 0;
    std::vector<std::uint8_t> cells_;
};

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
