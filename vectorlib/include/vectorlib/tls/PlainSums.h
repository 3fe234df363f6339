#pragma once

#include "vectorlib/tls/TlsSums.h"

namespace vectorlib {

/// The five sums of thesis (6.23) relative to an origin near the points (erratum 3), for those who add and
/// take away single points. The coordinates given are relative to that origin.
struct PlainSums {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    /// Adds a point.
    void add(double px, double py) {
        n += 1;
        x += px;
        y += py;
        xx += px * px;
        xy += px * py;
        yy += py * py;
    }
    /// The same sums as count, mean and moments, in the frame of `origin`.
    TlsSums about(Vector2D<double> origin) const { return TlsSums::fromPlain(n, x, y, xx, xy, yy, origin); }
    /// Whether the standard deviation of the points from their line is at most the root of `variance`; like
    /// fitsWithin() of TlsFit.h, multiplied through by the count: no division and no root.
    bool fitWithin(double variance) const {
        const double limit = n * n * variance;
        const double a = n * xx - x * x - limit, b = n * yy - y * y - limit, c = n * xy - x * y;
        return !(a > 0 && b > 0 && a * b > c * c);
    }
};

} // namespace vectorlib
