#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"

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
/// frame near them. Segments must be finite and have a length; others are refused by add().
class LineSegmentRegistration {
public:
    Rotation rotation = Rotation::Mitsuta;
    Stiffness stiffness;

    /// Adds a pair; false (and nothing added) when a segment has no direction or is not finite, or the weight
    /// is not a positive number.
    bool add(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving, double weight = 1) {
        if (!usable(fixed) || !usable(moving) || !(weight > 0) || !std::isfinite(weight))
            return false;
        accumulate(fixed, moving, weight);
        ++pairs_;
        return true;
    }
    /// Takes away a pair that was added with the same weight.
    void remove(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving, double weight = 1) {
        accumulate(fixed, moving, -weight);
        --pairs_;
        if (pairs_ == 0)
            clear();
    }
    /// Adds all pairs of another set.
    void add(const LineSegmentRegistration &o) { combine(o, 1); }
    void remove(const LineSegmentRegistration &o) { combine(o, -1); }
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
        const Vector2D<double> t = translation();
        return {t.x, t.y, angle()};
    }
    /// In [0, 1]; 0 means that all lines are parallel, 1 that directions are spread evenly. Paper (28),
    /// erratum 9.
    double reliability() const {
        return sums_.w > 0 ? 2 * std::sqrt(std::max(0.0, determinant())) / sums_.w : 0;
    }
    /// How much compromise the optimum needed; m^2. Paper (17) to (20).
    Ambiguity ambiguity() const { return pairs_ ? ambiguityAt(translation(), angle()) : Ambiguity(); }
    /// The same for any transformation: the full expansion thesis (7.40) with the stiffness coefficients
    /// (erratum 10).
    Ambiguity ambiguity(const Transformation2D &t) const {
        return pairs_ ? ambiguityAt(t.translation(), t.alpha()) : Ambiguity();
    }

private:
    struct Sums {
        double w = 0;                     // sum of weights, S_w
        double vxx = 0, vxy = 0, vyy = 0; // S_x2, S_xy, S_y2 of the static directions
        double px = 0, py = 0;            // S_Px, S_Py
        double pp = 0;                    // sum w (P_x v_y - P_y v_x)^2 = sum w |P|^2
        double a = 0, aa = 0;             // of the angles, unwrapped near reference_
        double sine = 0, cosine = 0;      // sum w sin, w cos of the angles: Wahba
    };

    static bool usable(const LineSegment2D<double> &s) {
        return s.isFinite() && s.direction().squaredNorm() > 0.5;
    }
    void accumulate(const LineSegment2D<double> &fixed, const LineSegment2D<double> &moving, double w) {
        const Vector2D<double> v = fixed.direction(), n = fixed.normal();
        // Erratum 6: with each line's own left normal the dynamic line moves by (p_S - p_D) along n_S.
        const double shift = fixed.begin().dot(n) - moving.begin().dot(moving.normal());
        const double sine = moving.direction().cross(v), cosine = moving.direction().dot(v);
        const double wrapped = std::atan2(sine, cosine);
        if (pairs_ == 0)
            reference_ = wrapped;
        // Erratum 8: the sums take the unwrapped angle itself. Unwrapping near the first angle, and not near
        // the previous one, lets pairs be removed in any order.
        const double alpha = reference_ + wrapAngle(wrapped - reference_);
        sums_.w += w;
        sums_.vxx += w * v.x * v.x;
        sums_.vxy += w * v.x * v.y;
        sums_.vyy += w * v.y * v.y;
        sums_.px += w * shift * n.x;
        sums_.py += w * shift * n.y;
        sums_.pp += w * shift * shift;
        sums_.a += w * alpha;
        sums_.aa += w * alpha * alpha;
        sums_.sine += w * sine;
        sums_.cosine += w * cosine;
    }
    void combine(const LineSegmentRegistration &o, int sign) {
        if (o.pairs_ == 0)
            return;
        if (pairs_ == 0)
            reference_ = o.reference_;
        // The other set's angles were unwrapped near another reference: bring its mean next to this one's.
        const double turn = 2 * pi * std::round((reference_ - o.sums_.a / o.sums_.w) / (2 * pi));
        const Sums &s = o.sums_;
        sums_.w += sign * s.w;
        sums_.vxx += sign * s.vxx;
        sums_.vxy += sign * s.vxy;
        sums_.vyy += sign * s.vyy;
        sums_.px += sign * s.px;
        sums_.py += sign * s.py;
        sums_.pp += sign * s.pp;
        sums_.a += sign * (s.a + turn * s.w);
        sums_.aa += sign * (s.aa + 2 * turn * s.a + turn * turn * s.w);
        sums_.sine += sign * s.sine;
        sums_.cosine += sign * s.cosine;
        pairs_ += sign * o.pairs_;
        if (pairs_ == 0)
            clear();
    }
    double determinant() const { return sums_.vxx * sums_.vyy - sums_.vxy * sums_.vxy; }
    Vector2D<double> translation() const {
        const Sums &s = sums_;
        if (isSolvable()) {
            const double d = determinant();
            return {(s.px * s.vxx + s.vxy * s.py) / d, (s.py * s.vyy + s.vxy * s.px) / d}; // erratum 7
        }
        // One direction only: the mean shift across it.
        return s.w > 0 ? Vector2D<double>(s.px / s.w, s.py / s.w) : Vector2D<double>();
    }
    double angle() const {
        return rotation == Rotation::Mitsuta ? wrapAngle(sums_.a / sums_.w)
                                             : std::atan2(sums_.sine, sums_.cosine);
    }
    Ambiguity ambiguityAt(Vector2D<double> t, double alpha) const {
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
    double reference_ = 0;
    int pairs_ = 0;
};

} // namespace vectorlib
