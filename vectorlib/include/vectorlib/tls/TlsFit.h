#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/tls/TlsSums.h"

#include <Eigen/Core>

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

/// How sure the parameters of a total least squares line are. The angle is that of its normal, atan2(b, a);
/// the offset is the c of ax + by + c = 0. First order, for noise that is the same in every direction.
struct LineCovariance {
    /// Rows and columns: angle (radians), offset (metres). With an offset about a far origin the two are
    /// strongly correlated: the line turns about the mean of its points.
    Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
    Vector2D<double> normal; ///< (a, b) of the line, which says what the signs mean
    bool valid = false;      ///< false when the line has no direction or the noise is unknown

    /// Of a line that is known exactly, as in a given map.
    static LineCovariance exact() {
        LineCovariance c;
        c.valid = true;
        return c;
    }
    /// Of the angle and of p = B.n, for a segment on the line and its own normal n: the offset c of the line
    /// is -p where both normals agree, else p.
    Eigen::Matrix2d ofSegment(const LineSegment2D<double> &segment) const {
        Eigen::Matrix2d m = matrix;
        if (normal.dot(segment.normal()) > 0)
            m(0, 1) = m(1, 0) = -m(0, 1);
        return m;
    }
};

/// The covariance of fitLine(sums), when each coordinate of a point has the standard deviation `noise`
/// (metres). With a noise of 0 or less the scatter of the points about the line is taken, which needs three
/// points or more.
///
/// Noise e turns the line by the mixed moment of the noise and the points over the difference of the two
/// eigenvalues L > l of the moments: var(angle) = e^2 (L + l) / (L - l)^2; across, the mean has e^2 / N. Both
/// are independent, because the points' positions along the line sum to zero about their mean.
inline LineCovariance lineCovariance(const TlsSums &sums, double noise = 0) {
    LineCovariance result;
    const Line2D line = isFinite(sums) ? fitLine(sums).line : Line2D();
    if (!line.isValid())
        return result;
    result.normal = line.normal();
    const double difference = std::hypot(sums.xx - sums.yy, 2 * sums.xy); // L - l
    double variance = noise * noise;
    if (!(noise > 0)) {
        if (!(sums.n > 2))
            return result;
        variance = sumOfSquares(sums) / (sums.n - 2);
    }
    const double angle = variance * (sums.xx + sums.yy) / (difference * difference);
    const double lever =
        line.normal().left().dot(sums.mean); // c = -normal.mean changes by -lever for an angle
    result.matrix(0, 0) = angle;
    result.matrix(0, 1) = result.matrix(1, 0) = -lever * angle;
    result.matrix(1, 1) = lever * lever * angle + variance / sums.n;
    result.valid = result.matrix.allFinite();
    if (!result.valid)
        result.matrix.setZero();
    return result;
}

} // namespace vectorlib
