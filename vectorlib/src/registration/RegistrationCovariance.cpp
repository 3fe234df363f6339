#include "vectorlib/registration/RegistrationCovariance.h"
#include "vectorlib/geometry/SmallMatrix.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace vectorlib {

VECTORLIB_BODY Eigen::Matrix3d PointCovariance::operator()(const PointRefinement &refine,
                                                           const Transformation2D &pose) const {
    const Sums s = sumsAt(refine, pose);
    const double alongX = s.information(0, 0), alongY = s.information(1, 1);
    if (!(alongX + alongY > 0))
        return Eigen::Matrix3d::Identity() * (farthest * farthest);
    // With the rotation as the way of a point at the usual lever, all three are metres.
    const double lever = std::max(leastLever, std::sqrt(s.information(2, 2) / (alongX + alongY)));
    const double step = leastStep + stepByScatter * std::sqrt(s.squares / s.weight);
    const Eigen::Matrix3d toUnits = Eigen::Vector3d(1, 1, 1 / lever).asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(
        toUnits * changeOfPull(refine, pose, step, step / lever) * toUnits);
    const Eigen::Matrix3d ways = toUnits * eigen.eigenvectors();
    const double gate = refine.settings.gate;
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero(), open = inverse;
    for (int i = 0; i < 3; ++i)
        if (const double held = eigen.eigenvalues()(i); held > leastHold * s.weight)
            inverse += square(1 / held, Eigen::Vector3d(ways.col(i)));
        else
            open += square(gate * gate, Eigen::Vector3d(ways.col(i)));
    constexpr double bothWays = 2; // most pairs are there twice, and tell no more than once
    return bothWays / sampleOf(refine) * product(inverse, s.scatter, inverse) + open;
}

template <typename Each>
void PointCovariance::forEachTerm(const PointRefinement &refine, const Transformation2D &pose, Each each) {
    const PointRefinementSettings &s = refine.settings;
    const FloatMotion motion(pose);
    const float squaredGate = static_cast<float>(s.gate * s.gate);
    const double inverse = 1 / (s.scale * s.scale * s.gate * s.gate);
    const auto partner = [squaredGate](const ScanIndex &scan, Vector2D<float> p) {
        return scan.nearestAhead(p, squaredGate);
    };
    forEachPair(refine.fixed(), refine.moving(), pose, sampleOf(refine), partner, [&](const PointPair &pair) {
        const Vector2D<float> n = pair.normal, turned = motion.rotate(pair.moving);
        const double r = pair.residual(turned, motion), q = 1 / (1 + r * r * inverse);
        each(Term{{n.x, n.y, turned.cross(n)}, r, q * q});
    });
}

VECTORLIB_BODY PointCovariance::Sums PointCovariance::sumsAt(const PointRefinement &refine,
                                                             const Transformation2D &pose) const {
    Sums s;
    forEachTerm(refine, pose, [&](const Term &t) {
        const double square = t.residual * t.residual;
        const double told = noise ? 2 * *noise * *noise : square + leastResidual * leastResidual;
        s.weight += t.weight;
        s.squares += t.weight * square;
        s.information += t.weight * t.derivative * t.derivative.transpose();
        s.scatter += t.weight * t.weight * told * t.derivative * t.derivative.transpose();
    });
    return s;
}

VECTORLIB_BODY Eigen::Vector3d PointCovariance::pullAt(const PointRefinement &refine,
                                                       const Transformation2D &pose) {
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();
    forEachTerm(refine, pose, [&](const Term &t) { pull += t.weight * t.residual * t.derivative; });
    return pull;
}

VECTORLIB_BODY Eigen::Matrix3d PointCovariance::changeOfPull(const PointRefinement &refine,
                                                             const Transformation2D &pose, double step,
                                                             double turn) {
    const auto pull = [&](double x, double y, double alpha) {
        return pullAt(refine, {pose.x() + x, pose.y() + y, pose.alpha() + alpha});
    };
    Eigen::Matrix3d change;
    change.col(0) = (pull(step, 0, 0) - pull(-step, 0, 0)) / (2 * step);
    change.col(1) = (pull(0, step, 0) - pull(0, -step, 0)) / (2 * step);
    change.col(2) = (pull(0, 0, turn) - pull(0, 0, -turn)) / (2 * turn);
    return (change + change.transpose()) / 2;
}

VECTORLIB_BODY bool RegistrationCovariance::add(const SegmentPair &pair, const LineCovariance &fixed,
                                                const LineCovariance &moving) {
    solvable_ = solvable_ && isUsable(pair) && fixed.valid && moving.valid;
    if (!solvable_)
        return false;
    const Vector2D<double> n = pair.fixed.normal();
    const double lever = pair.fixed.direction().dot(translation_);
    // By the angle and the offset p of the line: what moves (x, y, alpha), before the sums are divided
    // out.
    Eigen::Matrix<double, 3, 2> byFixed, byMoving;
    byFixed << n.x * lever, n.x, n.y * lever, n.y, 1, 0;
    byMoving << 0, -n.x, 0, -n.y, -1, 0;
    const double squared = pair.weight * pair.weight;
    spread_ += squared * product(byFixed, fixed.ofSegment(pair.fixed), byFixed);
    spread_ += squared * product(byMoving, moving.ofSegment(pair.moving), byMoving);
    sums_ += square(pair.weight, Eigen::Vector3d(n.x, n.y, 0));
    sums_(2, 2) += pair.weight;
    return true;
}

VECTORLIB_BODY std::optional<Eigen::Matrix3d> RegistrationCovariance::operator()() const {
    if (!solvable_)
        return std::nullopt;
    const Eigen::Matrix3d inverse = sums_.inverse();
    const Eigen::Matrix3d covariance = product(inverse, spread_, inverse); // the inverse is symmetric
    return covariance.allFinite() ? std::optional<Eigen::Matrix3d>(covariance) : std::nullopt;
}

} // namespace vectorlib
