#include "vectorlib/similarity/CriterionMinimizer.h"

#include <Eigen/Eigenvalues>

namespace vectorlib {

VECTORLIB_BODY CriterionMinimum CriterionMinimizer::operator()(const EdgeSetComparator &criterion,
                                                               const Transformation2D &start) const {
    CriterionMinimum best;
    best.transformation = start;
    best.criterion = criterion(start);
    if (!start.isFinite())
        return best;
    while (best.iterations < iterations && !best.converged) {
        ++best.iterations;
        const CriterionExpansion e = criterion.expansion(best.transformation);
        const double lever = leverOf(e.hessian);
        Eigen::Vector3d delta = direction(e, lever);
        delta /= std::max(1.0, std::abs(delta(2)));
        best.converged = !descend(criterion, delta, lever, best);
        if (best.converged)
            polish(criterion, e, delta, lever, best);
    }
    return best;
}

VECTORLIB_BODY double CriterionMinimizer::leverOf(const Eigen::Matrix3d &hessian) {
    const double shift = hessian(0, 0) + hessian(1, 1), turn = std::abs(hessian(2, 2));
    return shift > 0 && turn > 0 ? std::sqrt(turn / shift) : 1;
}

VECTORLIB_BODY Eigen::Vector3d CriterionMinimizer::direction(const CriterionExpansion &e, double lever) {
    constexpr double flat = 1e-10; // relative curvature that is rounding
    const Eigen::Vector3d scale(1, 1, 1 / lever);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scale.asDiagonal() * e.hessian *
                                                               scale.asDiagonal());
    const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
    Eigen::Vector3d delta = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
        const double curvature = std::abs(eigen.eigenvalues()(i));
        const Eigen::Vector3d axis = scale.asDiagonal() * eigen.eigenvectors().col(i);
        if (curvature > flat * largest)
            delta -= axis * (axis.dot(e.gradient) / curvature);
    }
    return delta;
}

VECTORLIB_BODY bool CriterionMinimizer::descend(const EdgeSetComparator &criterion, Eigen::Vector3d delta,
                                                double lever, CriterionMinimum &best) const {
    const Transformation2D from = best.transformation;
    for (; std::hypot(delta(0), delta(1), delta(2) * lever) > step; delta /= 2) {
        const Transformation2D to(from.x() + delta(0), from.y() + delta(1), from.alpha() + delta(2));
        const double value = criterion(to);
        if (value < best.criterion) {
            best.transformation = to;
            best.criterion = value;
            return true;
        }
    }
    return false;
}

VECTORLIB_BODY void CriterionMinimizer::polish(const EdgeSetComparator &criterion,
                                               const CriterionExpansion &e, const Eigen::Vector3d &delta,
                                               double lever, CriterionMinimum &best) {
    constexpr double small = 1e-5; // metres
    const Eigen::Vector3d scale(1, 1, 1 / lever);
    const Transformation2D &from = best.transformation;
    const Transformation2D to(from.x() + delta(0), from.y() + delta(1), from.alpha() + delta(2));
    const CriterionExpansion there = criterion.expansion(to);
    if (delta.cwiseQuotient(scale).norm() < small &&
        there.gradient.cwiseProduct(scale).norm() < e.gradient.cwiseProduct(scale).norm()) {
        best.transformation = to;
        best.criterion = there.value;
    }
}

} // namespace vectorlib
