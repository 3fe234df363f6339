#include "vectorlib/observation/Observer.h"

namespace vectorlib {

VECTORLIB_BODY double turnOf(Vector2D<double> d) {
    const double up = std::abs(d.y);
    const double turn = d.x >= 0 ? up / (d.x + up) : 2 - up / (up - d.x);
    return d.y < 0 ? -turn : turn;
}

VECTORLIB_BODY SightLine::SightLine(Vector2D<double> begin, Vector2D<double> end) {
    normal = -(end - begin).normalized().left();
    distance = normal.dot(begin);
    if (distance < 0) {
        normal = -normal;
        distance = -distance;
    }
}

VECTORLIB_BODY double compareDistance(const SightLine &a, const SightLine &b, Vector2D<double> direction) {
    const double left = a.distance * b.normal.dot(direction), right = b.distance * a.normal.dot(direction);
    const double difference = left - right;
    return std::abs(difference) > 1e-13 * (left + right) ? difference : 0;
}

VECTORLIB_BODY void NearestEdges::clear() {
    lines_.clear();
    facing_.clear();
    sectors_.clear();
    starts_.assign(1, 0);
}

VECTORLIB_BODY void NearestEdges::add(Vector2D<double> begin, Vector2D<double> end, bool facing,
                                      double lowest, double highest) {
    const std::size_t edge = lines_.size();
    lines_.emplace_back(begin, end);
    facing_.push_back(facing);
    const bool counterClockwise = begin.cross(end) > 0;
    cutBehind(counterClockwise ? begin : end, counterClockwise ? end : begin, edge, [&](Sector sector) {
        clip(sector, lowest, highest);
        if (sector.right < sector.left) {
            sectors_.push_back(sector);
            starts_.push_back(sectors_.size());
        }
    });
}

VECTORLIB_BODY void NearestEdges::clip(Sector &sector, double lowest, double highest) const {
    const auto direction = [](double turn) {
        // The inverse of turnOf, of any length.
        const double up = turn < 0 ? -turn : turn, x = 1 - up, y = up <= 1 ? up : 2 - up;
        return Vector2D<double>(x, turn < 0 ? -y : y);
    };
    if (sector.right < lowest) {
        sector.right = lowest;
        sector.towardsRight = direction(lowest);
    }
    if (sector.left > highest) {
        sector.left = highest;
        sector.towardsLeft = direction(highest);
    }
}

VECTORLIB_BODY void NearestEdges::mergeNeighbours() {
    merged_.clear();
    mergedStarts_.assign(1, 0);
    for (std::size_t k = 0; k + 1 < starts_.size(); k += 2) {
        if (k + 2 < starts_.size())
            merge(starts_[k], starts_[k + 1], starts_[k + 2]);
        else
            merged_.insert(merged_.end(), sectors_.begin() + std::ptrdiff_t(starts_[k]), sectors_.end());
        mergedStarts_.push_back(merged_.size());
    }
    sectors_.swap(merged_);
    starts_.swap(mergedStarts_);
}

VECTORLIB_BODY void NearestEdges::merge(std::size_t i, std::size_t middle, std::size_t end) {
    first_ = merged_.size();
    std::size_t j = middle;
    const auto trim = [this](std::size_t k, const Sector &from) {
        sectors_[k].right = from.left;
        sectors_[k].towardsRight = from.towardsLeft;
    };
    while (i < middle && j < end) {
        Sector &a = sectors_[i], &b = sectors_[j];
        if (a.left <= b.right) {
            emit(a);
            ++i;
        } else if (b.left <= a.right) {
            emit(b);
            ++j;
        } else {
            // First the part where one stands alone, then the part where both are.
            if (a.right != b.right) {
                Sector alone = a.right < b.right ? a : b;
                const Sector &next = a.right < b.right ? b : a;
                alone.left = next.right;
                alone.towardsLeft = next.towardsRight;
                emit(alone);
            }
            Sector both = a.right < b.right ? b : a;
            const Sector &shorter = a.left < b.left ? a : b;
            both.left = shorter.left;
            both.towardsLeft = shorter.towardsLeft;
            emitNearest(both, a.edge, b.edge);
            const bool aEnds = a.left == both.left, bEnds = b.left == both.left;
            aEnds ? void(++i) : trim(i, both);
            bEnds ? void(++j) : trim(j, both);
        }
    }
    for (; i < middle; ++i)
        emit(sectors_[i]);
    for (; j < end; ++j)
        emit(sectors_[j]);
}

VECTORLIB_BODY void NearestEdges::emitNearest(Sector both, std::size_t a, std::size_t b) {
    const double right = compareDistance(lines_[a], lines_[b], both.towardsRight);
    const double left = compareDistance(lines_[a], lines_[b], both.towardsLeft);
    if ((right < 0 && left > 0) || (right > 0 && left < 0)) {
        const Vector2D<double> crossing =
            both.towardsRight * std::abs(left) + both.towardsLeft * std::abs(right);
        const double turn = std::clamp(turnOf(crossing), both.right, both.left);
        emit({both.right, turn, both.towardsRight, crossing, right < 0 ? a : b});
        emit({turn, both.left, crossing, both.towardsLeft, right < 0 ? b : a});
        return;
    }
    const double nearer = right + left;
    both.edge = nearer < 0 || (nearer == 0 && facing_[a]) ? a : b;
    emit(both);
}

VECTORLIB_BODY void NearestEdges::emit(const Sector &sector) {
    if (sector.right >= sector.left)
        return;
    if (merged_.size() > first_ && merged_.back().edge == sector.edge &&
        merged_.back().left == sector.right) {
        merged_.back().left = sector.left;
        merged_.back().towardsLeft = sector.towardsLeft;
    } else {
        merged_.push_back(sector);
    }
}

} // namespace vectorlib
