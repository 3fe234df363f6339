#pragma once

#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/Angle.h"
#include "vectorlib/relations/MatchingTable.h"

#include <cmath>

namespace vectorlib {

/// The pairs of a matching table, best first. Algorithm 5: the pair of the largest merged score sets the
/// rotation, the others must have the same within the window; what is matched makes the rest of its row and
/// column invalid (Algorithm 7), or all that is not in its order (Algorithm 10). Keeps its buffers.
class PairSearch {
public:
    double threshold = 0;                     ///< merged scores must be above it
    double window = 5 * pi / 180;             ///< of rotations; radians
    bool sameOrder = false;                   ///< Algorithm 10 instead of 7
    static constexpr int mostSteps = 1 << 14; ///< pairs looked at, matched or not

    /// rotation(row, column) is the angle that turns the current segment onto the reference one. What was
    /// matched stays in the table, its rivals are gone. fixed is a row, moving a column.
    template <typename RotationOf>
    const std::vector<CorrespondencePair> &operator()(MatchingTable &table, RotationOf rotation) {
        pairs_.clear();
        MatchingTable::Cell best = table.maximum();
        const double angle = best.score > 0 ? rotation(best.row, best.column) : 0;
        for (int step = 0; best.score > threshold && step < mostSteps; ++step) {
            if (std::abs(wrapAngle(rotation(best.row, best.column) - angle)) <= window) {
                pairs_.push_back({best.row, best.column});
                table.take(best.row, best.column);
                if (sameOrder)
                    table.keepInOrder(best.row, best.column);
                else
                    table.keepOnly(best.row, best.column);
            } else {
                table.invalidate(best.row, best.column);
            }
            best = table.maximum();
        }
        return pairs_;
    }

private:
    std::vector<CorrespondencePair> pairs_;
};

} // namespace vectorlib
