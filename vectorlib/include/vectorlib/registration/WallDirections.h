#pragma once

#include "vectorlib/geometry/Angle.h"
#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <algorithm>
#include <cmath>

namespace vectorlib {

/// In which directions walls fix the position of a sensor, by sums over their normals.
class WallDirections {
public:
    WallDirections() = default;
    /// Of sums that are known.
    WallDirections(double xx, double xy, double yy)
        : xx_(xx)
        , xy_(xy)
        , yy_(yy) {}
    /// A wall with this normal, or a point on it; the weight is its length, or 1.
    template <typename Scalar>
    void add(Vector2D<Scalar> normal, Scalar weight = 1) {
        xx_ += weight * normal.x * normal.x;
        xy_ += weight * normal.x * normal.y;
        yy_ += weight * normal.y * normal.y;
    }
    /// The walls as seen from another frame.
    void turn(const Transformation2D &pose) {
        const double c = pose.cos(), s = pose.sin(), xx = xx_, xy = xy_, yy = yy_;
        xx_ = c * c * xx - 2 * c * s * xy + s * s * yy;
        yy_ = s * s * xx + 2 * c * s * xy + c * c * yy;
        xy_ = c * s * (xx - yy) + (c * c - s * s) * xy;
    }
    /// In [0, 1], as that of lines (paper (28)): small along a corridor, 0 without a wall.
    double reliability() const {
        const double sum = xx_ + yy_;
        return sum > 0 ? 2 * std::sqrt(std::max(0.0, xx_ * yy_ - xy_ * xy_)) / sum : 0;
    }
    /// The direction in which the walls say least, of unit length.
    Vector2D<double> weakest() const {
        const double angle = 0.5 * std::atan2(2 * xy_, xx_ - yy_) + pi / 2;
        return {std::cos(angle), std::sin(angle)};
    }
    /// The share of the walls that face that way, in [0, 0.5].
    double weakestShare() const {
        const double sum = xx_ + yy_, apart = std::hypot(xx_ - yy_, 2 * xy_);
        return sum > 0 ? 0.5 * (1 - apart / sum) : 0;
    }
    /// Of all walls together.
    double weight() const { return xx_ + yy_; }
    bool isEmpty() const { return !(weight() > 0); }

private:
    double xx_ = 0, xy_ = 0, yy_ = 0;
};

} // namespace vectorlib
