#include "vectorlib/registration/PointAgreement.h"

namespace vectorlib {

VECTORLIB_BODY FloatMotion::FloatMotion(const Transformation2D &t)
    : cos(static_cast<float>(t.cos()))
    , sin(static_cast<float>(t.sin()))
    , translation(t.translation()) {}

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
            xx_ += n.x * n.x;
            xy_ += n.x * n.y;
            yy_ += n.y * n.y;
        } else if (other.looksPast(p))
            ++contradicted_;
    }
}

VECTORLIB_BODY double PointAgreement::contradicted() const {
    const double judged = explained_ + contradicted_;
    return judged > 0 ? contradicted_ / judged : 0;
}

VECTORLIB_BODY double PointAgreement::reliability() const {
    const double sum = xx_ + yy_;
    return sum > 0 ? 2 * std::sqrt(std::max(0.0, xx_ * yy_ - xy_ * xy_)) / sum : 0;
}

} // namespace vectorlib
