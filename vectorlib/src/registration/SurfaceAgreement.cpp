#include "vectorlib/registration/SurfaceAgreement.h"

namespace vectorlib {

VECTORLIB_BODY SurfaceAgreement::SurfaceAgreement(Scan fixed, Scan moving, const Transformation2D &pose,
                                                  double deviation, int sample) {
    add(fixed, pose.inverse(), moving.points, deviation, sample);
    turnDirections(pose);
    add(moving, pose, fixed.points, deviation, sample);
}

VECTORLIB_BODY double SurfaceAgreement::reliability() const {
    const double sum = xx_ + yy_;
    return sum > 0 ? 2 * std::sqrt(std::max(0.0, xx_ * yy_ - xy_ * xy_)) / sum : 0;
}

VECTORLIB_BODY Vector2D<double> SurfaceAgreement::openDirection() const {
    const double angle = 0.5 * std::atan2(2 * xy_, xx_ - yy_) + pi / 2;
    return {std::cos(angle), std::sin(angle)};
}

VECTORLIB_BODY double SurfaceAgreement::balance(double hidden) const {
    const double judged = explained_ + contradicted_, all = judged + hidden * (length_ - judged);
    return all > 0 ? (explained_ - contradicted_) / all : 0;
}

VECTORLIB_BODY void SurfaceAgreement::add(Scan scan, const Transformation2D &motion, const ScanIndex &other,
                                          double deviation, int sample) {
    constexpr float gate = 0.3f, beside = 0.2f, sameWay = 0.7f; // metres, metres, cosine
    const FloatMotion move(motion);
    const float inverse = static_cast<float>(1 / (4 * deviation * deviation));
    for (int i = 0; i < scan.points.size(); i += sample) {
        const Vector2D<float> p = move * scan.points.point(i), own = move.rotate(scan.points.normal(i));
        const float length = scan.surface.lengthOf(i);
        length_ += length;
        if (const int k = other.nearestAhead(p, gate * gate); k >= 0) {
            const Vector2D<float> n = other.normal(k), off = p - other.point(k);
            const bool alone = n.squaredNorm() * own.squaredNorm() < 0.5f; // without a normal
            if (alone || n.dot(own) > sameWay) {
                const float across = n.dot(off), square = off.squaredNorm();
                const float q = 1 / (1 + (alone ? square : across * across) * inverse);
                const float part = length * q * q * (square > beside * beside ? 0.5f : 1.0f);
                explained_ += part;
                xx_ += part * n.x * n.x;
                xy_ += part * n.x * n.y;
                yy_ += part * n.y * n.y;
                continue;
            }
        }
        if (other.looksPast(p))
            contradicted_ += length;
    }
}

VECTORLIB_BODY void SurfaceAgreement::turnDirections(const Transformation2D &pose) {
    const double c = pose.cos(), s = pose.sin(), xx = xx_, xy = xy_, yy = yy_;
    xx_ = c * c * xx - 2 * c * s * xy + s * s * yy;
    yy_ = s * s * xx + 2 * c * s * xy + c * c * yy;
    xy_ = c * s * (xx - yy) + (c * c - s * s) * xy;
}

} // namespace vectorlib
