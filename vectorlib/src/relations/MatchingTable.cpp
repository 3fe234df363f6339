#include "vectorlib/relations/MatchingTable.h"

#include <algorithm>

namespace vectorlib {

VECTORLIB_BODY void MatchingTable::reset(std::size_t rows, std::size_t columns) {
    rows_ = static_cast<int>(rows);
    columns_ = static_cast<int>(columns);
    scores_.clear();
    heads_.assign(rows * columns, -1);
    merged_.assign(rows * columns, 0);
    taken_.assign(rows * columns, 0);
}

VECTORLIB_BODY void MatchingTable::add(double score, const std::size_t *cells, int count) {
    Score s;
    s.value = static_cast<std::int64_t>(score * unit + 0.5);
    const int number = static_cast<int>(scores_.size());
    for (int i = 0; i < count; ++i) {
        bool isNew = true;
        for (int j = 0; j < s.count; ++j)
            isNew = isNew && s.cells[static_cast<std::size_t>(j)] != cells[i];
        if (!isNew)
            continue;
        const auto slot = static_cast<std::size_t>(s.count++);
        s.cells[slot] = static_cast<std::uint32_t>(cells[i]);
        s.next[slot] = heads_[cells[i]];
        heads_[cells[i]] = 4 * number + static_cast<int>(slot);
        merged_[cells[i]] += s.value;
    }
    scores_.push_back(s);
}

VECTORLIB_BODY MatchingTable::Cell MatchingTable::maximum() const {
    std::int64_t most = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < merged_.size(); ++i)
        if (merged_[i] > most && !taken_[i]) {
            most = merged_[i];
            at = i;
        }
    if (most == 0)
        return {};
    return {static_cast<int>(at) / columns_, static_cast<int>(at) % columns_, double(most) / unit};
}

VECTORLIB_BODY void MatchingTable::invalidate(int row, int column) {
    for (int at = heads_[cell(row, column)]; at >= 0;) {
        Score &s = scores_[static_cast<std::size_t>(at / 4)];
        for (int i = 0; i < s.count; ++i)
            merged_[s.cells[static_cast<std::size_t>(i)]] -= s.value;
        s.value = 0;
        at = s.next[static_cast<std::size_t>(at % 4)];
    }
    heads_[cell(row, column)] = -1;
}

VECTORLIB_BODY void MatchingTable::keepOnly(int row, int column) {
    for (int i = 0; i < rows_; ++i)
        if (i != row)
            invalidate(i, column);
    for (int j = 0; j < columns_; ++j)
        if (j != column)
            invalidate(row, j);
}

VECTORLIB_BODY void MatchingTable::keepInOrder(int row, int column) {
    for (int i = 0; i < rows_; ++i)
        for (int j = 0; j < columns_; ++j)
            if ((i != row || j != column) && ((i <= row && j >= column) || (i >= row && j <= column)))
                invalidate(i, j);
}

} // namespace vectorlib
