#pragma once

#include "vectorlib/vectorization/VectorizedLine.h"

#include <Eigen/Core>

#include <vector>

namespace vectorlib {

/// Moves the break points between the lines of one cluster, one at a time, while the error E (thesis 6.27)
/// falls. A move changes the two lines beside the break point only, whose sums follow by adding and taking
/// away the points between: no prefix sums, and no point is touched but those near a break point. Every line
/// keeps at least two points (erratum 4). E never grows.
class BreakPointDescent {
public:
    int rounds = 2; ///< over all break points, at most

    /// Lines that partition the points; afterwards their intervals and sums are the better ones, their lines
    /// and segments still those of before.
    template <typename Scalar>
    void operator()(PointSpan<Scalar> points, std::vector<VectorizedLine> &lines) {
        if (lines.size() < 2)
            return;
        moved_.assign(lines.size() + 1, 1); // moved_[i]: the break point before line i, when last looked at
        for (int round = 0; round < rounds; ++round) {
            bool any = false;
            for (std::size_t i = 1; i < lines.size(); ++i) {
                // Only what changed beside a break point can move it again.
                if (round > 0 && !moved_[i - 1] && !moved_[i + 1])
                    continue;
                VectorizedLine &left = lines[i - 1], &right = lines[i];
                const std::size_t smaller = std::min(left.last - left.first, right.last - right.first) + 1;
                const std::size_t before = right.first;
                improve(points, left, right, round == 0 ? std::max<std::size_t>(smaller / 16, 5) : 1);
                const std::size_t move = std::max(before, right.first) - std::min(before, right.first);
                moved_[i] = move * 10 > smaller; // less hardly turns a line
                any = any || moved_[i];
            }
            moved_[0] = moved_[lines.size()] = 0;
            if (!any)
                return;
        }
    }

private:
    using Pair = Eigen::Array2d;
    // The plain sums of the two lines beside a break point, about a point there (erratum 3): one SIMD
    // register holds the same sum of both.
    struct Sides {
        Pair n, x, y, xx, xy, yy;

        Sides(const TlsSums &left, const TlsSums &right, Vector2D<double> origin) {
            const Vector2D<double> l = left.mean - origin, r = right.mean - origin;
            const Pair mx(l.x, r.x), my(l.y, r.y);
            n = Pair(left.n, right.n);
            x = n * mx;
            y = n * my;
            xx = Pair(left.xx, right.xx) + x * mx;
            xy = Pair(left.xy, right.xy) + x * my;
            yy = Pair(left.yy, right.yy) + y * my;
        }
        // Gives the points first .. end - 1 to the left line (side 1) or to the right one (side -1).
        template <typename Scalar>
        void give(PointSpan<Scalar> points, std::size_t first, std::size_t end, Vector2D<double> origin,
                  double side) {
            // Two chains of additions, of which neither waits for the other.
            const Pair shift(origin.x, origin.y);
            Pair sum1 = Pair::Zero(), sum2 = sum1, squares1 = sum1, squares2 = sum1;
            double xy1 = 0, xy2 = 0;
            std::size_t i = first;
            for (; i + 1 < end; i += 2) {
                const Pair p = Pair(points[i].x, points[i].y) - shift;
                const Pair q = Pair(points[i + 1].x, points[i + 1].y) - shift;
                sum1 += p;
                sum2 += q;
                squares1 += p * p;
                squares2 += q * q;
                xy1 += p.x() * p.y();
                xy2 += q.x() * q.y();
            }
            if (i < end) {
                const Pair p = Pair(points[i].x, points[i].y) - shift;
                sum1 += p;
                squares1 += p * p;
                xy1 += p.x() * p.y();
            }
            sum1 += sum2;
            squares1 += squares2;
            const Pair sign(side, -side);
            n += sign * static_cast<double>(end - first);
            x += sign * sum1.x();
            y += sign * sum1.y();
            xx += sign * squares1.x();
            xy += sign * (xy1 + xy2);
            yy += sign * squares1.y();
        }
        // The sum of the squared distances of all points from their line; see sumOfSquares().
        double squares() const {
            const Pair inverse = 1 / n;
            const Pair a = xx - x * x * inverse, b = yy - y * y * inverse, c = xy - x * y * inverse;
            const Pair difference = a - b;
            return 0.5 * (a + b - (difference * difference + 4 * c * c).sqrt()).sum();
        }
        TlsSums line(int side, Vector2D<double> origin) const {
            return TlsSums::fromPlain(n[side], x[side], y[side], xx[side], xy[side], yy[side], origin);
        }
    };
    struct Place {
        std::size_t at; // index of the right line's first point
        double squares;
        Sides sides;
    };

    // Looks at places on both sides, `stride` points apart, goes to the best, and again with a smaller
    // stride. More places backwards at first: a search for the longest line runs past the corner.
    template <typename Scalar>
    static void improve(PointSpan<Scalar> points, VectorizedLine &left, VectorizedLine &right,
                        std::size_t stride) {
        const std::size_t lowest = left.first + 2, highest = right.last - 1, start = right.first;
        const Vector2D<double> origin(points[start]);
        const Sides sides(left.sums, right.sums, origin);
        Place best{start, sides.squares(), sides};
        std::size_t back = stride == 1 ? 2 : 3, forth = stride == 1 ? 2 : 1;
        for (;;) {
            const Place middle = best;
            std::size_t first = middle.at, last = middle.at;
            for (Sides s = middle.sides; last - first < back * stride && first >= lowest + stride;) {
                s.give(points, first - stride, first, origin, -1);
                first -= stride;
                if (const double squares = s.squares(); squares < best.squares)
                    best = {first, squares, s};
            }
            const std::size_t end = middle.at + forth * stride;
            for (Sides s = middle.sides; last < end && last + stride <= highest;) {
                s.give(points, last, last + stride, origin, 1);
                last += stride;
                if (const double squares = s.squares(); squares < best.squares)
                    best = {last, squares, s};
            }
            if (best.at != middle.at && (best.at == first || best.at == last))
                continue; // the best is at the border of what was looked at
            if (stride == 1)
                break;
            const std::size_t finer = std::max<std::size_t>(stride / 3, 1);
            back = forth = (stride - 1) / finer;
            stride = finer;
        }
        if (best.at == start)
            return;
        left.last = best.at - 1;
        right.first = best.at;
        left.sums = best.sides.line(0, origin);
        right.sums = best.sides.line(1, origin);
    }

    std::vector<char> moved_;
};

} // namespace vectorlib
