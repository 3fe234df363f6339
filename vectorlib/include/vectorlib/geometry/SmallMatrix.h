#pragma once

#include <Eigen/Core>

#include <cmath>
#include <optional>

namespace vectorlib {

// Products of small matrices in plain loops. Eigen's expressions of them are as fast when they run, but cost
// every file that includes one seconds of the compiler's time.

/// a b
template <int Rows, int Inner, int Columns>
Eigen::Matrix<double, Rows, Columns> product(const Eigen::Matrix<double, Rows, Inner> &a,
                                             const Eigen::Matrix<double, Inner, Columns> &b) {
    Eigen::Matrix<double, Rows, Columns> p;
    for (int c = 0; c < Columns; ++c)
        for (int r = 0; r < Rows; ++r) {
            double sum = 0;
            for (int i = 0; i < Inner; ++i)
                sum += a(r, i) * b(i, c);
            p(r, c) = sum;
        }
    return p;
}

/// a m b', where b' is b transposed
template <int Rows, int Inner>
Eigen::Matrix<double, Rows, Rows> product(const Eigen::Matrix<double, Rows, Inner> &a,
                                          const Eigen::Matrix<double, Inner, Inner> &m,
                                          const Eigen::Matrix<double, Rows, Inner> &b) {
    const Eigen::Matrix<double, Rows, Inner> am = product(a, m);
    Eigen::Matrix<double, Rows, Rows> p;
    for (int c = 0; c < Rows; ++c)
        for (int r = 0; r < Rows; ++r) {
            double sum = 0;
            for (int i = 0; i < Inner; ++i)
                sum += am(r, i) * b(c, i);
            p(r, c) = sum;
        }
    return p;
}

/// factor v v'
template <int Rows>
Eigen::Matrix<double, Rows, Rows> square(double factor, const Eigen::Matrix<double, Rows, 1> &v) {
    Eigen::Matrix<double, Rows, Rows> p;
    for (int c = 0; c < Rows; ++c)
        for (int r = 0; r < Rows; ++r)
            p(r, c) = factor * v(r) * v(c);
    return p;
}

/// The x of h x = g, where h is symmetric; nothing where it is not positive definite, or not finite.
inline std::optional<Eigen::Vector3d> solveSymmetric(const Eigen::Matrix3d &h, const Eigen::Vector3d &g) {
    // h = L D L' with ones in the diagonal of L.
    const double d0 = h(0, 0), l10 = h(1, 0) / d0, l20 = h(2, 0) / d0;
    const double d1 = h(1, 1) - l10 * h(1, 0), e = h(2, 1) - l20 * h(1, 0), l21 = e / d1;
    const double d2 = h(2, 2) - l20 * h(2, 0) - l21 * e;
    const double y1 = g(1) - l10 * g(0), y2 = g(2) - l20 * g(0) - l21 * y1;
    const double x2 = y2 / d2, x1 = y1 / d1 - l21 * x2, x0 = g(0) / d0 - l10 * x1 - l20 * x2;
    if (!(d0 > 0 && d1 > 0 && d2 > 0 && std::isfinite(x0 + x1 + x2)))
        return std::nullopt;
    return Eigen::Vector3d(x0, x1, x2);
}

} // namespace vectorlib
