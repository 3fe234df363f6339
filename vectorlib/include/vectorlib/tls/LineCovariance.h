#pragma once

#include "vectorlib/tls/TlsFit.h"

#include <Eigen/Core>

namespace vectorlib {

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
