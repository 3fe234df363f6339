#pragma once

#include "vectorlib/segmentation/ScanOrder.h"
#include "vectorlib/simd/NearestOfEight.h"

#include <cmath>
#include <vector>

namespace vectorlib {

/// The points of one scan, found by their direction: which of them lies nearest to a point of another scan
/// that was moved into this one's frame, and how the wall runs there. Metres. Keeps its buffers between
/// scans.
class ScanIndex {
public:
    /// Takes a scan in its sensor's frame, in the order of ScanOrder; of a scan of more than `most` points
    /// only every n-th. Points that are not finite or farther away than 1,000 km are left out, and those that
    /// repeat the one before.
    void build(PointSpan<float> given, std::size_t most) {
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
    int size() const { return size_; }
    /// A point by its number; sensor frame, metres.
    Vector2D<float> point(int i) const { return {x_[at(i)], y_[at(i)]}; }
    /// Of the wall through the point and its neighbours, of unit length; zero for a point that stands alone.
    Vector2D<float> normal(int i) const { return normals_[static_cast<std::size_t>(i)]; }

    /// The point nearest to p of all that are nearer than the root of `squaredGate`, or -1. Looks along the
    /// rays on both sides until these themselves are farther away than what was found.
    int nearest(Vector2D<float> p, float squaredGate) const {
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
    /// The same among the eight points in about the direction of p only: fast, and enough where p is nearly
    /// right.
    int nearestAhead(Vector2D<float> p, float squaredGate) const {
        const int first = ahead(p) - window / 2; // what lies outside is padding, far away
        const simd::NearestOfEight nearest(x_.data() + at(first), y_.data() + at(first), p.x, p.y);
        return nearest.squared < squaredGate ? first + nearest.number : -1;
    }
    /// Whether the scanner looked past p: both points beside its direction lie well behind it.
    bool looksPast(Vector2D<float> p) const {
        const int k = ahead(p);
        if (k <= 0 || k >= size_)
            return false;
        const float range = 1.05f * p.norm() + 0.1f;
        return std::min(point(k).squaredNorm(), point(k - 1).squaredNorm()) > range * range;
    }

private:
    static constexpr int window = 8;
    static constexpr int bins = 1024;
    static constexpr float far = 1e9f;

    static std::size_t at(int i) { return static_cast<std::size_t>(i + window); }
    // Grows with the angle from -pi to pi, without trigonometry; in [0, bins].
    static std::size_t binOf(Vector2D<float> p) {
        const float sum = std::abs(p.x) + std::abs(p.y);
        const float t = sum > 0 && sum < far ? p.y / sum : 0;
        const float turn = p.x >= 0 ? t : (p.y >= 0 ? 2 - t : -2 - t);
        return static_cast<std::size_t>((turn + 2) * (bins / 4));
    }
    // The first point in about the direction of p, or beyond.
    int ahead(Vector2D<float> p) const { return first_[binOf(p)]; }

    void findDirections() {
        first_.assign(bins + 1, -1);
        for (int i = size_; i-- > 0;)
            first_[binOf(point(i))] = i;
        int next = size_;
        for (std::size_t b = bins + 1; b-- > 0;)
            next = first_[b] = first_[b] < 0 ? next : first_[b];
    }
    // The wall runs from the fourth neighbour before a point to the fourth behind it, as far as no gap is
    // between.
    void findNormals() {
        constexpr int reach = 4;
        constexpr float gap = 0.15f, gapByRange = 0.06f; // metres, and metres for each metre of range
        normals_.resize(static_cast<std::size_t>(size_));
        for (int i = 0; i < size_; ++i) {
            const float limit = std::max(gap * gap, gapByRange * gapByRange * point(i).squaredNorm());
            int from = i, to = i;
            while (from > 0 && i - from < reach && (point(from - 1) - point(from)).squaredNorm() < limit)
                --from;
            while (to + 1 < size_ && to - i < reach && (point(to + 1) - point(to)).squaredNorm() < limit)
                ++to;
            normals_[static_cast<std::size_t>(i)] = (point(to) - point(from)).normalized().left();
        }
    }

    ScanOrder order_;
    std::vector<float> x_, y_; // with padding at both ends
    int size_ = 0;
    std::vector<Vector2D<float>> normals_;
    std::vector<int> first_; // by bin: the first point in it or in a later one
};

} // namespace vectorlib
