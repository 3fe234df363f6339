#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/Localizability.h"
#include "vectorlib/registration/WallDirections.h"
#include "vectorlib/segmentation/ScanOrder.h"
#include "vectorlib/simd/Lanes.h"

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
    int nearestAhead(Vector2D<float> p, float squaredGate) const {
        const int first = ahead(p) - window / 2; // what lies outside is padding, far away
        const simd::NearestOfEight nearest(x_.data() + at(first), y_.data() + at(first), p.x, p.y);
        return nearest.squared < squaredGate ? first + nearest.number : -1;
    }
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

/// A rigid transformation in the scalars of points, for loops over many of them.
struct FloatMotion {
    float cos, sin;
    Vector2D<float> translation;

    explicit FloatMotion(const Transformation2D &t)
        : cos(static_cast<float>(t.cos()))
        , sin(static_cast<float>(t.sin()))
        , translation(t.translation()) {}
    /// A direction, turned.
    Vector2D<float> rotate(Vector2D<float> v) const { return {cos * v.x - sin * v.y, sin * v.x + cos * v.y}; }
    /// A point, moved.
    Vector2D<float> operator*(Vector2D<float> p) const { return rotate(p) + translation; }
};

/// How well the points of two scans lie on each other.
class PointAgreement {
public:
    /// Judges every n-th of the points, moved into the frame of the other scan.
    void add(const ScanIndex &points, const Transformation2D &motion, const ScanIndex &other, double gate,
             int sample);
    /// How many points have one of the other scan beside them.
    double explainedPoints() const { return explained_; }
    /// Share of the points with one of the other scan beside them.
    double explained() const { return points_ > 0 ? explained_ / points_ : 0; }
    /// Of the points that can be judged, the share where the other scan saw something farther away. Points
    /// outside its view or behind what it saw cannot be judged.
    double contradicted() const {
        const double judged = explained_ + contradicted_;
        return judged > 0 ? contradicted_ / judged : 0;
    }
    /// Share of all points where the other scan saw something farther away.
    double contradictedOfAll() const { return points_ > 0 ? contradicted_ / points_ : 0; }
    /// In [-1, 1]: explained less contradicted points, and less the farther apart they are; 1 is perfect.
    double score() const { return points_ > 0 ? (explained_ - distances_ - contradicted_) / points_ : 0; }
    /// How well the walls fix the motion, in the frame of the last scan that was judged against.
    const WallDirections &walls() const { return walls_; }
    /// The same where the heading is free, too.
    const Localizability &localizability() const { return localizability_; }

private:
    double points_ = 0, explained_ = 0, contradicted_ = 0;
    double distances_ = 0; // squared, in units of the gate
    WallDirections walls_;
    Localizability localizability_;
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/registration/ScanIndex.cpp")
