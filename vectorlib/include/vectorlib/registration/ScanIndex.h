#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/PointSpan.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/segmentation/ScanOrder.h"

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
    void build(PointSpan<float> given, std::size_t most);
    int size() const { return size_; }
    /// A point by its number; sensor frame, metres.
    Vector2D<float> point(int i) const { return {x_[at(i)], y_[at(i)]}; }
    /// Of the wall through the point and its neighbours, of unit length; zero for a point that stands alone.
    Vector2D<float> normal(int i) const { return normals_[static_cast<std::size_t>(i)]; }

    /// The point nearest to p of all that are nearer than the root of `squaredGate`, or -1. Looks along the
    /// rays on both sides until these themselves are farther away than what was found.
    int nearest(Vector2D<float> p, float squaredGate) const;
    /// The same among the eight points in about the direction of p only: fast, and enough where p is nearly
    /// right.
    int nearestAhead(Vector2D<float> p, float squaredGate) const;
    /// Whether the scanner looked past p: both points beside its direction lie well behind it.
    bool looksPast(Vector2D<float> p) const;

private:
    static constexpr int window = 8;
    static constexpr int bins = 1024;
    static constexpr float far = 1e9f;

    static std::size_t at(int i) { return static_cast<std::size_t>(i + window); }
    // Grows with the angle from -pi to pi, without trigonometry; in [0, bins].
    static std::size_t binOf(Vector2D<float> p);
    // The first point in about the direction of p, or beyond.
    int ahead(Vector2D<float> p) const { return first_[binOf(p)]; }

    void findDirections();
    // The wall runs from the fourth neighbour before a point to the fourth behind it, as far as no gap is
    // between.
    void findNormals();

    ScanOrder order_;
    std::vector<float> x_, y_; // with padding at both ends
    int size_ = 0;
    std::vector<Vector2D<float>> normals_;
    std::vector<int> first_; // by bin: the first point in it or in a later one
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/ScanIndex.cpp")
