#include "vectorlib/relations/MatchingTable.h"

namespace vectorlib {

VECTORLIB_BODY bool lengthsMayMatch(const TypedSegment &a, const TypedSegment &b, double window) {
    const double la = a.segment.length(), lb = b.segment.length();
    const auto slack = [](const TypedSegment &s) {
        return (s.begin.isEdge() ? s.begin.slack : 0) + (s.end.isEdge() ? s.end.slack : 0);
    };
    if (std::abs(la - lb) <= window + slack(a) + slack(b))
        return true;
    return !(la < lb ? a : b).isComplete();
}

VECTORLIB_BODY void ConsistencyTable::fill(const Segments &rows, const Segments &columns,
                                           const RelationSettings &settings) {
    columns_ = columns.size();
    cells_.resize(rows.size() * columns_);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j < columns_; ++j)
            cells_[i * columns_ + j] = lengthsMayMatch(rows[i], columns[j], settings.distanceWindow) &&
                                       endsMayMatch(rows, i, columns, j, settings) &&
                                       beginsMayMatch(rows, i, columns, j, settings);
}

VECTORLIB_BODY bool ConsistencyTable::endsMayMatch(const Segments &a, std::size_t i, const Segments &b,
                                                   std::size_t j, const RelationSettings &settings) {
    const bool isA = a[i].joined && i + 1 < a.size(), isB = b[j].joined && j + 1 < b.size();
    if (isA && isB)
        return cornersMayMatch(a, i, b, j, settings);
    if (isA && b[j].end.type == EndType::Jump)
        return keepsBound(a, i, b[j].end, settings);
    if (isB && a[i].end.type == EndType::Jump)
        return keepsBound(b, j, a[i].end, settings);
    return true;
}

VECTORLIB_BODY bool ConsistencyTable::beginsMayMatch(const Segments &a, std::size_t i, const Segments &b,
                                                     std::size_t j, const RelationSettings &settings) {
    const bool isA = i > 0 && a[i - 1].joined, isB = j > 0 && b[j - 1].joined;
    if (isA && isB)
        return lengthsMayMatch(a[i - 1], b[j - 1], settings.distanceWindow) &&
               anglesMatch(relativeAngle(a[i - 1].segment, a[i].segment),
                           relativeAngle(b[j - 1].segment, b[j].segment), settings.angleWindow);
    if (isA && b[j].begin.type == EndType::Jump)
        return keepsBound(a, i - 1, b[j].begin, settings);
    if (isB && a[i].begin.type == EndType::Jump)
        return keepsBound(b, j - 1, a[i].begin, settings);
    return true;
}

VECTORLIB_BODY bool ConsistencyTable::cornersMayMatch(const Segments &a, std::size_t i, const Segments &b,
                                                      std::size_t j, const RelationSettings &settings) {
    return lengthsMayMatch(a[i + 1], b[j + 1], settings.distanceWindow) &&
           anglesMatch(relativeAngle(a[i].segment, a[i + 1].segment),
                       relativeAngle(b[j].segment, b[j + 1].segment), settings.angleWindow);
}

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
