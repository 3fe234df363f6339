#include "vectorlib/registration/LineSegmentRegistration.h"

namespace vectorlib {

VECTORLIB_BODY bool LineSegmentRegistration::add(const SegmentPair &pair) {
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

VECTORLIB_BODY std::size_t LineSegmentRegistration::add(const std::vector<SegmentPair> &pairs) {
    std::size_t added = 0;
    for (const SegmentPair &pair : pairs)
        added += add(pair);
    return added;
}

VECTORLIB_BODY void LineSegmentRegistration::add(const LineSegmentRegistration &o) {
    if (pairs_ == 0) {
        frame_ = o.frame_;
        turn_ = o.turn_;
    }
    sums_ = sums_ + inFrameOfThis(o);
    pairs_ += o.pairs_;
}

VECTORLIB_BODY bool LineSegmentRegistration::remove(const SegmentPair &pair) {
    if (pairs_ == 0 || !isUsable(pair))
        return false;
    drop(1, sumsOf(pair));
    return true;
}

VECTORLIB_BODY bool LineSegmentRegistration::remove(const LineSegmentRegistration &o) {
    if (o.pairs_ > pairs_)
        return false;
    drop(o.pairs_, inFrameOfThis(o));
    return true;
}

VECTORLIB_BODY void LineSegmentRegistration::clear() {
    sums_ = Sums();
    pairs_ = 0;
}

VECTORLIB_BODY Transformation2D LineSegmentRegistration::transformation() const {
    if (pairs_ == 0)
        return {};
    const Vector2D<double> t = fromFrame(translation());
    return {t.x, t.y, turnAngle() + meanAngle()};
}

VECTORLIB_BODY LineSegmentRegistration::Sums LineSegmentRegistration::Sums::plus(const Sums &o,
                                                                                 double k) const {
    return {w + k * o.w,   vxx + k * o.vxx,   vxy + k * o.vxy,      vyy + k * o.vyy,
            px + k * o.px, py + k * o.py,     pp + k * o.pp,        a + k * o.a,
            aa + k * o.aa, sine + k * o.sine, cosine + k * o.cosine};
}

VECTORLIB_BODY Vector2D<double> LineSegmentRegistration::turnOf(const SegmentPair &p) {
    const Vector2D<double> v = p.fixed.direction(), d = p.moving.direction();
    return {d.dot(v), d.cross(v)};
}

VECTORLIB_BODY LineSegmentRegistration::Sums LineSegmentRegistration::sumsOf(const SegmentPair &pair) const {
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

VECTORLIB_BODY LineSegmentRegistration::Sums
LineSegmentRegistration::inFrameOfThis(const LineSegmentRegistration &o) const {
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

VECTORLIB_BODY void LineSegmentRegistration::drop(int count, const Sums &sums) {
    sums_ = sums_.plus(sums, -1);
    pairs_ -= count;
    if (pairs_ == 0)
        clear();
}

VECTORLIB_BODY Vector2D<double> LineSegmentRegistration::translation() const { // in the frame
    const Sums &s = sums_;
    if (isSolvable()) {
        const double d = determinant();
        return {(s.px * s.vxx + s.vxy * s.py) / d, (s.py * s.vyy + s.vxy * s.px) / d}; // erratum 7
    }
    // One direction only: the mean shift across it.
    return s.w > 0 ? Vector2D<double>(s.px / s.w, s.py / s.w) : Vector2D<double>();
}

VECTORLIB_BODY Ambiguity LineSegmentRegistration::ambiguityAt(
    Vector2D<double> t, double alpha) const { // t in the frame, alpha beside turn_
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
    result.xy =
        s.pp - 2 * (t.x * s.px + t.y * s.py) + t.x * t.x * s.vyy - 2 * t.x * t.y * s.vxy + t.y * t.y * s.vxx;
    result.xy = stiffness.xy * std::max(0.0, result.xy);
    return result;
}

} // namespace vectorlib
