#include "vectorlib/registration/PointRefinement.h"

namespace vectorlib {

VECTORLIB_BODY void PointToLineRefinement::accumulate(const LineSegment2D<double> &line, const TlsSums &sums,
                                                      double weight, double sign) {
    const Vector2D<double> n = line.normal(), w(n.y, -n.x); // n . x' = w . x
    const double u = w.dot(sums.mean), r = n.dot(sums.mean - line.begin());
    const double uu = w.x * w.x * sums.xx + 2 * w.x * w.y * sums.xy + w.y * w.y * sums.yy;
    const double ur = w.x * n.x * sums.xx + (w.x * n.y + w.y * n.x) * sums.xy + w.y * n.y * sums.yy;
    const Eigen::Vector3d j(n.x, n.y, u);
    h_ += square(weight * sums.n, j);
    h_(2, 2) += weight * uu;
    g_ += (sign * weight * sums.n * r) * j;
    g_(2) += sign * weight * ur;
}

VECTORLIB_BODY Transformation2D PointRefinement::operator()(Transformation2D pose,
                                                            const Expectation &expected, double firstGate) {
    int sample = std::max(1, settings.sample);
    double gate = std::max(firstGate, settings.gate);
    for (int i = 0; i < settings.iterations; ++i) {
        const bool narrow = gate <= settings.gate;
        pairUp(pose, gate, sample);
        const Transformation2D next = improved(pose, gate, expected);
        const Transformation2D step = pose.inverse() * next;
        const double size = std::max(step.translation().norm(), std::abs(step.sin()));
        pose = next;
        if (narrow && sample == 1 && size < settings.lastStep)
            break;
        if (narrow && size < settings.smallStep)
            sample = 1;
        gate = std::max(settings.gate, gate * settings.gateFactor);
    }
    return pose;
}

VECTORLIB_BODY PointAgreement PointRefinement::agreement(const Transformation2D &pose) const {
    PointAgreement a;
    const int sample = std::max(1, settings.sample);
    a.add(moving_, pose, fixed_, settings.gate, sample);
    a.add(fixed_, pose.inverse(), moving_, settings.gate, sample);
    return a;
}

VECTORLIB_BODY void PointRefinement::pairUp(const Transformation2D &pose, double gate, int sample) {
    const bool wide = gate > settings.gate;
    const float squaredGate = float(gate * gate);
    const auto partner = [&](const ScanIndex &scan, Vector2D<float> p) {
        return wide ? scan.nearest(p, squaredGate) : scan.nearestAhead(p, squaredGate);
    };
    pairs_.clear();
    forEachPair(fixed_, moving_, pose, sample, partner,
                [this](const PointPair &pair) { pairs_.push_back(pair); });
}

VECTORLIB_BODY PointRefinement::Sums PointRefinement::sumsAt(const Transformation2D &pose,
                                                             double gate) const {
    const FloatMotion motion(pose);
    const float inverse = float(1 / (settings.scale * settings.scale * gate * gate));
    Sums s;
    for (const PointPair &pair : pairs_) {
        const Vector2D<float> n = pair.normal, turned = motion.rotate(pair.moving);
        const float r = pair.residual(turned, motion), u = turned.cross(n);
        const float q = 1 / (1 + r * r * inverse), w = q * q; // Geman and McClure
        s.xx += w * n.x * n.x;
        s.xy += w * n.x * n.y;
        s.xa += w * n.x * u;
        s.yy += w * n.y * n.y;
        s.ya += w * n.y * u;
        s.aa += w * u * u;
        s.x += w * n.x * r;
        s.y += w * n.y * r;
        s.a += w * u * r;
    }
    return s;
}

VECTORLIB_BODY Transformation2D PointRefinement::improved(const Transformation2D &pose, double gate,
                                                          const Expectation &expected) const {
    const Sums s = sumsAt(pose, gate);
    const double kXY = std::pow(settings.deviation / expected.deviationXY, 2);
    const double kAlpha = std::pow(settings.deviation / expected.deviationAlpha, 2);
    const Vector2D<double> off = pose.translation() - expected.pose.translation();
    const double turn = (expected.pose.inverse() * pose).alpha();
    Eigen::Matrix3d h;
    h << s.xx + kXY, s.xy, s.xa, s.xy, s.yy + kXY, s.ya, s.xa, s.ya, s.aa + kAlpha;
    const Eigen::Vector3d g(s.x + kXY * off.x, s.y + kXY * off.y, s.a + kAlpha * turn);
    const std::optional<Eigen::Vector3d> back = solveSymmetric(h, g);
    if (!back)
        return pose;
    return {pose.x() - (*back)(0), pose.y() - (*back)(1), pose.alpha() - (*back)(2)};
}

} // namespace vectorlib
