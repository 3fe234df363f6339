#include "vectorlib/registration/ScanIndex.h"

namespace vectorlib {

VECTORLIB_BODY void ScanIndex::build(PointSpan<float> given, std::size_t most) {
    const PointSpan<float> scan = order_(given);
    x_.assign(window, far);
    y_.assign(window, far);
    const std::size_t step = 1 + scan.size() / (std::max<std::size_t>(1, most) + 1);
    for (std::size_t i = 0; i < scan.size(); i += step)
        if (const Vector2D<float> &p = scan[i];
            std::abs(p.x) < 1e6f && std::abs(p.y) < 1e6f && (p.x != x_.back() || p.y != y_.back())) {
            x_.push_back(p.x);
            y_.push_back(p.y);
        }
    size_ = static_cast<int>(x_.size()) - window;
    x_.insert(x_.end(), window, far);
    y_.insert(y_.end(), window, far);
    findNormals();
    findDirections();
}

VECTORLIB_BODY int ScanIndex::nearest(Vector2D<float> p, float squaredGate) const {
    int best = -1;
    const auto isBeyond = [&](int k, float side) {
        const Vector2D<float> f = point(k);
        if (const float d = (f - p).squaredNorm(); d < squaredGate) {
            squaredGate = d;
            best = k;
        }
        const float across = side * p.cross(f);
        return across > 0 && across * across > squaredGate * f.squaredNorm();
    };
    const int start = ahead(p);
    for (int k = start; k < size_ && !isBeyond(k, 1); ++k) {
    }
    for (int k = start - 1; k >= 0 && !isBeyond(k, -1); --k) {
    }
    return best;
}

VECTORLIB_BODY bool ScanIndex::looksPast(Vector2D<float> p) const {
    const int k = ahead(p);
    if (k <= 0 || k >= size_)
        return false;
    const float range = 1.05f * p.norm() + 0.1f;
    return std::min(point(k).squaredNorm(), point(k - 1).squaredNorm()) > range * range;
}

VECTORLIB_BODY std::size_t ScanIndex::binOf(Vector2D<float> p) {
    const float sum = std::abs(p.x) + std::abs(p.y);
    const float t = sum > 0 && sum < far ? p.y / sum : 0;
    const float turn = p.x >= 0 ? t : (p.y >= 0 ? 2 - t : -2 - t);
    return static_cast<std::size_t>((turn + 2) * (bins / 4));
}

VECTORLIB_BODY void ScanIndex::findDirections() {
    first_.assign(bins + 1, -1);
    for (int i = size_; i-- > 0;)
        first_[binOf(point(i))] = i;
    int next = size_;
    for (std::size_t b = bins + 1; b-- > 0;)
        next = first_[b] = first_[b] < 0 ? next : first_[b];
}

VECTORLIB_BODY void ScanIndex::findNormals() {
    constexpr int reach = 4, farthest = 20;
    constexpr float gap = 0.15f, gapByRange = 0.06f; // metres, and metres for each metre of range
    constexpr float least =
        0.12f * 0.12f; // squared metres: of nearer points the noise tells more than the wall
    normals_.resize(static_cast<std::size_t>(size_));
    for (int i = 0; i < size_; ++i) {
        const float limit = std::max(gap * gap, gapByRange * gapByRange * point(i).squaredNorm());
        const auto isNeighbour = [&](int end, int next) {
            const int steps = std::abs(next - i);
            return next >= 0 && next < size_ && (point(next) - point(end)).squaredNorm() < limit &&
                   (steps <= reach || (steps <= farthest && (point(end) - point(i)).squaredNorm() < least));
        };
        int from = i, to = i;
        while (isNeighbour(from, from - 1))
            --from;
        while (isNeighbour(to, to + 1))
            ++to;
        normals_[static_cast<std::size_t>(i)] = (point(to) - point(from)).normalized().left();
    }
}

VECTORLIB_BODY void PointAgreement::add(const ScanIndex &points, const Transformation2D &motion,
                                        const ScanIndex &other, double gate, int sample) {
    const FloatMotion move(motion);
    const float squaredGate = static_cast<float>(gate * gate);
    for (int i = 0; i < points.size(); i += sample) {
        const Vector2D<float> p = move * points.point(i);
        ++points_;
        if (const int k = other.nearestAhead(p, squaredGate); k >= 0) {
            const Vector2D<float> n = other.normal(k);
            const float d = n.dot(p - other.point(k));
            ++explained_;
            distances_ += d * d / squaredGate;
            walls_.add(n);
            localizability_.add(p, n, move.rotate(points.normal(i)));
        } else if (other.looksPast(p))
            ++contradicted_;
    }
}

} // namespace vectorlib
