#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>
#include <vector>

namespace vectorlib {

/// How the rotation is averaged.
enum class Rotation {
    Mitsuta, ///< mean of the unwrapped angles; paper Algorithm 1
    Wahba    ///< least squares of direction vectors; paper eq. (15)
};

/// Stiffness coefficients of the ambiguity: k_alpha in m^2/rad^2, k_xy without unit. Thesis 7.3.3; the
/// published 1000 cm^2/rad^2 is 0.1 m^2/rad^2.
struct Stiffness {
    double alpha = 0.1;
    double xy = 1;
};

/// The ambiguity and its two parts; m^2. Thesis (7.44).
struct Ambiguity {
    double alpha = 0;
    double xy = 0;
    double total() const { return alpha + xy; }
};

/// One-step registration of two sets of line segments with known correspondences: thesis 7.3, registration
/// paper 3. The result moves the dynamic set onto the static one. Pairs, or the sums of whole sets of pairs,
/// are added and removed in constant time, and every answer takes constant time whatever the number of pairs.
///
/// Lines far from the origin couple an error of rotation into translation (erratum 13): give segments in a
/// frame near them. RegistrationCovariance.h tells how sure the result is.
class LineSegmentRegistration {
public:
    Rotation rotation = Rotation::Mitsuta;
    Stiffness stiffness;

    /// Adds a pair; false (and nothing added) when a segment has no direction or is not finite, the weight is
    /// not a positive number, or the sums would be beyond what a double holds.
    bool add(const SegmentPair &pair) {
        if (!isUsable(pair))
            return false;
        if (pairs_ == 0) {
            frame_ = pair.fixed.direction();
            turn_ = turnOf(pair);
        }
        const Sums sum = sums_ + sumsOf(pair);
        if (!std::isfinite(sum.pp) || !std::isfinite(sum.w))
            return false;
        sums_ = sum;
        ++pairs_;
        return true;
    }
    /// The same for two segments.
    bool add(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving, double weight = 1) {
        return add({fixed, moving, weight});
    }
    /// Adds all that are usable; returns how many those are.
    std::size_t add(const std::vector<SegmentPair> &pairs) {
        std::size_t added = 0;
        for (const SegmentPair &pair : pairs)
            added += add(pair);
        return added;
    }
    /// Adds all pairs of another set.
    void add(const LineSegmentRegistration &o) {
        if (pairs_ == 0) {
            frame_ = o.frame_;
            turn_ = o.turn_;
        }
        sums_ = sums_ + inFrameOfThis(o);
        pairs_ += o.pairs_;
    }
    /// Takes away a pair that was added with the same weight; false for what cannot have been added.
    bool remove(const SegmentPair &pair) {
        if (pairs_ == 0 || !isUsable(pair))
            return false;
        drop(1, sumsOf(pair));
        return true;
    }
    /// The same for two segments.
    bool remove(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving, double weight = 1) {
        return remove({fixed, moving, weight});
    }
    /// Takes away all pairs of another set; false when it has more than there are.
    bool remove(const LineSegmentRegistration &o) {
        if (o.pairs_ > pairs_)
            return false;
        drop(o.pairs_, inFrameOfThis(o));
        return true;
    }
    void clear() {
        sums_ = Sums();
        pairs_ = 0;
    }
    int pairs() const { return pairs_; }
    double weight() const { return sums_.w; }

    /// Whether the translation is determined: false for no pairs and for collinear ones.
    bool isSolvable() const { return determinant() > 1e-12 * sums_.w * sums_.w; }

    /// The optimal transformation. Where the translation is not determined, its part along the lines is 0:
    /// only the shift across them is made. Paper (5) to (9) with erratum 7. Identity without pairs.
    Transformation2D transformation() const {
        if (pairs_ == 0)
            return {};
        const Vector2D<double> t = fromFrame(translation());
        return {t.x, t.y, turnAngle() + meanAngle()};
    }
    /// In [0, 1]; 0 means that the translation is not determined, 1 that directions are spread evenly. Paper
    /// (28), erratum 9.
    double reliability() const {
        return isSolvable() ? std::min(1.0, 2 * std::sqrt(determinant()) / sums_.w) : 0;
    }
    /// How much compromise the optimum needed; m^2. Paper (17) to (20).
    Ambiguity ambiguity() const { return pairs_ ? ambiguityAt(translation(), meanAngle()) : Ambiguity(); }
    /// The same for any transformation: the full expansion thesis (7.40) with the stiffness coefficients
    /// (erratum 10).
    Ambiguity ambiguity(const Transformation2D &t) const {
        return pairs_ ? ambiguityAt(toFrame(t.translation()), t.alpha() - turnAngle()) : Ambiguity();
    }

private:
    // Directions and translations are those in the frame of frame_, angles those beside turn_. There, lines
    // that are nearly parallel have small numbers across, which keep all their digits: the error of the
    // result grows with 1 / reliability instead of its square.
    struct Sums {
        double w = 0;                     // sum of weights, S_w
        double vxx = 0, vxy = 0, vyy = 0; // S_x2, S_xy, S_y2 of the static directions
        double px = 0, py = 0;            // S_Px, S_Py
        double pp = 0;                    // sum w (P_x v_y - P_y v_x)^2 = sum w |P|^2
        double a = 0, aa = 0;             // of the angles
        double sine = 0, cosine = 0;      // sum w sin, w cos of the angles: Wahba

        Sums plus(const Sums &o, double k) const {
            return {w + k * o.w,   vxx + k * o.vxx,   vxy + k * o.vxy,      vyy + k * o.vyy,
                    px + k * o.px, py + k * o.py,     pp + k * o.pp,        a + k * o.a,
                    aa + k * o.aa, sine + k * o.sine, cosine + k * o.cosine};
        }
        Sums operator+(const Sums &o) const { return plus(o, 1); }
    };

    static Vector2D<double> turned(Vector2D<double> v, Vector2D<double> by) {
        return {v.x * by.x - v.y * by.y, v.x * by.y + v.y * by.x};
    }
    Vector2D<double> toFrame(Vector2D<double> v) const { return {frame_.dot(v), frame_.cross(v)}; }
    Vector2D<double> fromFrame(Vector2D<double> v) const { return turned(v, frame_); }

    // Cosine and sine of the pair's own rotation.
    static Vector2D<double> turnOf(const SegmentPair &p) {
        const Vector2D<double> v = p.fixed.direction(), d = p.moving.direction();
        return {d.dot(v), d.cross(v)};
    }
    Sums sumsOf(const SegmentPair &pair) const {
        const double w = pair.weight;
        const Vector2D<double> v = toFrame(pair.fixed.direction()), turn = turnOf(pair);
        // Erratum 6: with each line's own left normal the dynamic line moves by (p_S - p_D) along n_S.
        const double shift =
            pair.fixed.begin().dot(pair.fixed.normal()) - pair.moving.begin().dot(pair.moving.normal());
        // Erratum 8: the sums take the unwrapped angle itself. Unwrapping near the first angle, and not near
        // the previous one, lets pairs be removed in any order.
        const double sine = turn_.cross(turn), cosine = turn_.dot(turn), alpha = std::atan2(sine, cosine);
        return {w,
                w * v.x * v.x,
                w * v.x * v.y,
                w * v.y * v.y,
                -w * shift * v.y,
                w * shift * v.x,
                w * shift * shift,
                w * alpha,
                w * alpha * alpha,
                w * sine,
                w * cosine};
    }
    // The sums of another set as if its pairs had been added here.
    Sums inFrameOfThis(const LineSegmentRegistration &o) const {
        Sums s = o.sums_;
        if (o.pairs_ == 0)
            return s;
        const Vector2D<double> f = toFrame(o.frame_), p = turned({s.px, s.py}, f);
        const double xx = s.vxx, xy = s.vxy, yy = s.vyy;
        s.vxx = f.x * f.x * xx - 2 * f.x * f.y * xy + f.y * f.y * yy;
        s.vxy = f.x * f.y * (xx - yy) + (f.x * f.x - f.y * f.y) * xy;
        s.vyy = f.y * f.y * xx + 2 * f.x * f.y * xy + f.x * f.x * yy;
        s.px = p.x;
        s.py = p.y;
        // Its angles lie beside another one; its mean is brought next to the angle of this set.
        const Vector2D<double> turn(turn_.dot(o.turn_), turn_.cross(o.turn_));
        const double beside = std::atan2(turn.y, turn.x), mean = s.a / s.w + beside;
        const double more = beside - 2 * pi * std::round(mean / (2 * pi));
        s.aa += 2 * more * s.a + more * more * s.w;
        s.a += more * s.w;
        const Vector2D<double> sum = turned({s.cosine, s.sine}, turn);
        s.cosine = sum.x;
        s.sine = sum.y;
        return s;
    }
    void drop(int count, const Sums &sums) {
        sums_ = sums_.plus(sums, -1);
        pairs_ -= count;
        if (pairs_ == 0)
            clear();
    }
    double determinant() const { return sums_.vxx * sums_.vyy - sums_.vxy * sums_.vxy; }
    Vector2D<double> translation() const { // in the frame
        const Sums &s = sums_;
        if (isSolvable()) {
            const double d = determinant();
            return {(s.px * s.vxx + s.vxy * s.py) / d, (s.py * s.vyy + s.vxy * s.px) / d}; // erratum 7
        }
        // One direction only: the mean shift across it.
        return s.w > 0 ? Vector2D<double>(s.px / s.w, s.py / s.w) : Vector2D<double>();
    }
    double turnAngle() const { return std::atan2(turn_.y, turn_.x); }
    double meanAngle() const { // beside turn_
        return rotation == Rotation::Mitsuta ? sums_.a / sums_.w : std::atan2(sums_.sine, sums_.cosine);
    }
    Ambiguity ambiguityAt(Vector2D<double> t, double alpha) const { // t in the frame, alpha beside turn_
        const Sums &s = sums_;
        Ambiguity result;
        if (rotation == Rotation::Mitsuta) {
            const double mean = s.a / s.w, offset = wrapAngle(alpha - mean);
            result.alpha = std::max(0.0, s.aa - mean * s.a) + s.w * offset * offset;
        } else {
            result.alpha =
                std::max(0.0, 2 * (s.w - std::sin(alpha) * s.sine - std::cos(alpha) * s.cosine)); // (13)
        }
        result.alpha *= stiffness.alpha;
        // The P are perpendicular to the v, so that sum w P v_y^2 - ... of (7.40) is just sum w P.
        result.xy = s.pp - 2 * (t.x * s.px + t.y * s.py) + t.x * t.x * s.vyy - 2 * t.x * t.y * s.vxy +
                    t.y * t.y * s.vxx;
        result.xy = stiffness.xy * std::max(0.0, result.xy);
        return result;
    }

    Sums sums_;
    Vector2D<double> frame_{1, 0}; // direction of the first static segment
    Vector2D<double> turn_{1, 0};  // cosine and sine of the first pair's rotation
    int pairs_ = 0;
};

} // namespace vectorlib
