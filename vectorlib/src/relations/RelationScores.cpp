#include "vectorlib/relations/RelationScores.h"

namespace vectorlib {

VECTORLIB_BODY int MatchSigns::operator()(const std::vector<CorrespondencePair> &pairs,
                                          const std::vector<TypedSegment> &reference,
                                          const std::vector<TypedSegment> &current,
                                          const Transformation2D &pose) const {
    const auto lineOf = [&](const CorrespondencePair &p) -> const LineSegment2D<double> & {
        return reference[static_cast<std::size_t>(p.fixed)].segment;
    };
    int signs = 0;
    bool isOblique = false;
    for (auto p = pairs.begin(); p != pairs.end(); ++p) {
        signs += std::none_of(pairs.begin(), p, [&](const CorrespondencePair &other) {
            return isSameLine(lineOf(other), lineOf(*p));
        });
        isOblique = isOblique || !isSquare(lineOf(pairs.front()), lineOf(*p));
        signs += commonJumps(reference[static_cast<std::size_t>(p->fixed)],
                             current[static_cast<std::size_t>(p->moving)], pose);
    }
    return signs + (isOblique ? 1 : 0);
}

VECTORLIB_BODY bool MatchSigns::isSameLine(const LineSegment2D<double> &a,
                                           const LineSegment2D<double> &b) const {
    return std::abs(a.direction().cross(b.direction())) < std::sin(angle) &&
           std::abs(a.across(b.middle())) < distance;
}

VECTORLIB_BODY void RelationScores::operator()(const Segments &reference, const RelationSet &ofReference,
                                               const Segments &current, const RelationSet &ofCurrent,
                                               const RelationSettings &settings, MatchingTable &table) {
    toReference_.fill(reference, current, settings);
    toCurrent_.fill(current, current, settings);
    cornersToReference_.fill(ofReference.corners(), ofCurrent.corners(), toReference_, settings.angleWindow);
    cornersToCurrent_.fill(ofCurrent.corners(), ofCurrent.corners(), toCurrent_, settings.angleWindow);
    table.reset(reference.size(), current.size());
    isCut_ = false;
    compared_ = 0;
    maxScores_ = settings.maxScores;
    maxCompared_ = settings.maxCompared;
    scoreLengths(ofReference, current, ofCurrent, table);
    scoreCorners(ofReference, ofCurrent, table);
    scorePairs(ofCurrent.parallels(), ofReference, ofCurrent, table);
    scorePairs(ofCurrent.angles(), ofReference, ofCurrent, table);
}

VECTORLIB_BODY void RelationScores::scoreLengths(const RelationSet &ofReference, const Segments &current,
                                                 const RelationSet &ofCurrent, MatchingTable &table) {
    for (std::size_t j = 0; j < current.size(); ++j) {
        numbers_.clear();
        ofReference.lengthsLike(current[j], [&](int i) {
            if (toReference_(i, static_cast<int>(j)))
                numbers_.push_back(i);
        });
        if (numbers_.empty())
            continue;
        if (!hasRoom(table, numbers_.size()))
            return;
        int count = 0;
        ofCurrent.lengthsLike(current[j], [&](int i) { count += toCurrent_(i, static_cast<int>(j)); });
        const double score = scoreOf(count, numbers_.size());
        for (int i : numbers_) {
            const std::size_t cell = table.cell(i, static_cast<int>(j));
            table.add(score, &cell, 1);
        }
    }
}

template <typename Relation>
void RelationScores::scorePairs(const std::vector<Relation> &relations, const RelationSet &ofReference,
                                const RelationSet &ofCurrent, MatchingTable &table) {
    for (const Relation &c : relations) {
        if (!mayCompare())
            return;
        cells_.clear();
        compared_ += ofReference.like(c, [&](const Relation &r) {
            if (toReference_(r.first, c.first) && toReference_(r.second, c.second))
                cells_.push_back({{table.cell(r.first, c.first), table.cell(r.second, c.second)}, 2});
        });
        if (cells_.empty())
            continue;
        if (!hasRoom(table, cells_.size()))
            return;
        int count = 0;
        compared_ += ofCurrent.like(c, [&](const Relation &other) {
            count += toCurrent_(other.first, c.first) && toCurrent_(other.second, c.second);
        });
        addAll(count, table);
    }
}

VECTORLIB_BODY void RelationScores::scoreCorners(const RelationSet &ofReference, const RelationSet &ofCurrent,
                                                 MatchingTable &table) {
    for (const CornerRelation &c : ofCurrent.cornerRelations()) {
        if (!mayCompare())
            return;
        cells_.clear();
        compared_ += ofReference.like(c, [&](const CornerRelation &r) {
            if (cornersToReference_(r.first, c.first) && cornersToReference_(r.second, c.second))
                cells_.push_back(cellsOf(r, ofReference.corners(), c, ofCurrent.corners(), table));
        });
        if (cells_.empty())
            continue;
        if (!hasRoom(table, cells_.size()))
            return;
        int count = 0;
        compared_ += ofCurrent.like(c, [&](const CornerRelation &other) {
            count += cornersToCurrent_(other.first, c.first) && cornersToCurrent_(other.second, c.second);
        });
        addAll(count, table);
    }
}

VECTORLIB_BODY RelationScores::Cells RelationScores::cellsOf(const CornerRelation &r,
                                                             const std::vector<Corner> &reference,
                                                             const CornerRelation &c,
                                                             const std::vector<Corner> &current,
                                                             const MatchingTable &table) {
    Cells result{{0, 0, 0, 0}, 0};
    const auto add = [&](int i, int j) {
        if (i >= 0 && j >= 0)
            result.cells[result.count++] = table.cell(i, j);
    };
    const Corner &a = reference[static_cast<std::size_t>(r.first)],
                 &b = reference[static_cast<std::size_t>(r.second)];
    const Corner &p = current[static_cast<std::size_t>(c.first)],
                 &q = current[static_cast<std::size_t>(c.second)];
    add(a.first, p.first);
    add(a.second, p.second);
    add(b.first, q.first);
    add(b.second, q.second);
    return result;
}

} // namespace vectorlib
