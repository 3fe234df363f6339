#pragma once

#include "vectorlib/geometry/Line2D.h"
#include "vectorlib/tls/TlsSums.h"

namespace vectorlib {

/// A total least squares line and how well it fits. The line is invalid when the points have no direction:
/// fewer than two distinct, or isotropic, or apart by less than 1e-70 m or more than 1e70 m.
struct TlsLine {
    Line2D line;
    double variance = 0; ///< mean squared distance of the points from the line; m^2. Thesis (6.22)
};

/// The line through the mean that minimises the squared distances, with c >= 0. Thesis (6.16) to (6.22), with
/// erratum 2: 1/sqrt(4n^2+1) is computed as |q|/sqrt(4p^2+q^2), and p = q = 0 is reported by an invalid line.
inline TlsLine fitLine(const TlsSums &s) {
    TlsLine fit;
    const double p = -s.xy;       // numerator of (6.16), over N
    const double q = s.xx - s.yy; // its denominator, over N
    const double root = std::sqrt(4 * p * p + q * q);
    // Below the rounding of the moments themselves a direction would be noise; and the root of an extreme one
    // leaves the range of numbers below.
    if (!(root > 1e-14 * (s.xx + s.yy)) || !(root > 1e-150 && root < 1e150) || !(s.n >= 2))
        return fit;
    // (6.19) without its cancellation: the larger is sqrt(h / root), the smaller |p| / sqrt(h root).
    const double h = 0.5 * (root + std::abs(q)), inverse = 1 / std::sqrt(h * root);
    const double large = h * inverse;
    const double small = std::abs(p) * inverse;
    double a = q > 0 ? small : large;
    double b = q > 0 ? large : small;
    if (p <= 0)
        b = -b; // (6.20)
    double c = -(a * s.mean.x + b * s.mean.y);
    if (c < 0) {
        a = -a;
        b = -b;
        c = -c;
    }
    fit.line = {a, b, c};
    fit.variance = std::max(0.0, (a * a * s.xx + 2 * a * b * s.xy + b * b * s.yy) / s.n);
    return fit;
}

/// The sum of the squared distances of the points from their line, that is N times the variance (6.22),
/// without the line: the smaller eigenvalue of the moments. The search for break points needs nothing else.
inline double sumOfSquares(const TlsSums &s) {
    const double difference = s.xx - s.yy;
    const double root = std::sqrt(difference * difference + 4 * s.xy * s.xy);
    return std::max(0.0, 0.5 * (s.xx + s.yy - root));
}

/// Whether the sums are of finite points.
inline bool isFinite(const TlsSums &s) {
    return s.mean.isFinite() && std::isfinite(s.xx) && std::isfinite(s.xy) && std::isfinite(s.yy);
}

/// Whether the standard deviation of the points from their line is at most sigma. Neither root nor division:
/// the smaller eigenvalue of the moments exceeds n sigma^2 exactly when the moments less n sigma^2 are
/// positive definite.
inline bool fitsWithin(const TlsSums &s, double sigma) {
    const double limit = s.n * sigma * sigma;
    const double xx = s.xx - limit, yy = s.yy - limit;
    return !(xx > 0 && yy > 0 && xx * yy > s.xy * s.xy);
}

} // namespace vectorlib
