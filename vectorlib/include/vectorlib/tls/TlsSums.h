#pragma once

#include "vectorlib/geometry/Transformation2D.h"

namespace vectorlib {

/// The sums of a set of points from which its total least squares line follows, kept as count, mean and
/// second moments about the mean. That carries the same information as the five plain sums of thesis (6.23)
/// and, unlike them, loses nothing when the points lie far from the origin (erratum 3). Metres.
///
/// Adding two sums gives exactly the sums of the union of their points; a transformed sum is exactly the sum
/// of the transformed points. That is what makes merging edges of a map exact.
struct TlsSums {
    double n = 0;          ///< number of points
    Vector2D<double> mean; ///< of the points
    double xx = 0;         ///< sum of (x - mean.x)^2
    double xy = 0;         ///< sum of (x - mean.x)(y - mean.y)
    double yy = 0;         ///< sum of (y - mean.y)^2

    /// From the five plain sums (6.23), taken relative to `origin`.
    static TlsSums fromPlain(double n, double sx, double sy, double sxx, double sxy, double syy,
                             Vector2D<double> origin = {}) {
        TlsSums s;
        if (n <= 0)
            return s;
        s.n = n;
        const double inverse = 1 / n, mx = sx * inverse, my = sy * inverse;
        s.mean = origin + Vector2D<double>(mx, my);
        s.xx = std::max(sxx - sx * mx, 0.0); // in this order NaN stays NaN
        s.xy = sxy - sx * my;
        s.yy = std::max(syy - sy * my, 0.0);
        return s;
    }
    /// Of the points first .. last, shifted by the first one while summing (erratum 3).
    template <typename Iterator>
    static TlsSums of(Iterator first, Iterator last) {
        if (first == last)
            return {};
        const Vector2D<double> origin(*first);
        double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
        for (; first != last; ++first) {
            const Vector2D<double> p = Vector2D<double>(*first) - origin;
            n += 1;
            sx += p.x;
            sy += p.y;
            sxx += p.x * p.x;
            sxy += p.x * p.y;
            syy += p.y * p.y;
        }
        return fromPlain(n, sx, sy, sxx, sxy, syy, origin);
    }

    /// The sums of the union of both point sets.
    TlsSums &operator+=(const TlsSums &o) {
        if (o.n == 0)
            return *this;
        const double total = n + o.n;
        const Vector2D<double> d = o.mean - mean;
        const double k = n * o.n / total;
        mean += d * (o.n / total);
        xx += o.xx + k * d.x * d.x;
        xy += o.xy + k * d.x * d.y;
        yy += o.yy + k * d.y * d.y;
        n = total;
        return *this;
    }
    friend TlsSums operator+(TlsSums a, const TlsSums &b) { return a += b; }

    /// The sums of the transformed points.
    friend TlsSums operator*(const Transformation2D &t, const TlsSums &s) {
        const double c = t.cos(), i = t.sin();
        TlsSums r;
        r.n = s.n;
        r.mean = t * s.mean;
        // Points on one line have no moment across it; rounding must not make it negative.
        r.xx = std::max(c * c * s.xx - 2 * c * i * s.xy + i * i * s.yy, 0.0);
        r.xy = c * i * (s.xx - s.yy) + (c * c - i * i) * s.xy;
        r.yy = std::max(i * i * s.xx + 2 * c * i * s.xy + c * c * s.yy, 0.0);
        return r;
    }
};

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
