#pragma once

#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace vectorlib {

/// The area between two segments that the older criterion takes (overview paper 2.2, figure 3); m^2. Seen
/// along the axis that halves the angle between the two lines, the quadrangle reaches from the first of the
/// four end points to the last (the largest of the six), between the lines; where they cross inside it, both
/// triangles count.
inline double quadrangleArea(const LineSegment2D<double> &p, const LineSegment2D<double> &q) {
    const Vector2D<double> d = p.direction(), e = d.dot(q.direction()) < 0 ? -q.direction() : q.direction();
    const Vector2D<double> axis = (d + e).normalized(); // at most 45 degrees from both
    const double slope = axis.cross(d) / axis.dot(d);   // of p over the axis; that of q is the opposite
    const Vector2D<double> origin = p.middle();
    double first = 0, last = 0; // p's middle lies between its ends
    for (const Vector2D<double> &end : {p.begin(), p.end(), q.begin(), q.end()}) {
        first = std::min(first, axis.dot(end - origin));
        last = std::max(last, axis.dot(end - origin));
    }
    const Vector2D<double> other = q.middle() - origin;
    const double gap = axis.cross(other) + slope * axis.dot(other); // from p to q at the origin
    const double left = gap - 2 * slope * first, right = gap - 2 * slope * last;
    if (left * right >= 0)
        return std::abs(left + right) / 2 * (last - first);
    return (left * left + right * right) / (2 * std::abs(left - right)) * (last - first);
}

/// The older criterion for a set of pairs: the weighted sum of squared areas; m^4. Every evaluation goes
/// through all pairs, and it is not smooth: the baseline that EdgeSetComparator is measured against.
class QuadrangleCriterion {
public:
    /// False (and nothing added) when the pair is not usable.
    bool add(const SegmentPair &pair) {
        if (!isUsable(pair))
            return false;
        pairs_.push_back(pair);
        return true;
    }
    void clear() { pairs_.clear(); }

    /// 0 without pairs.
    double operator()(const Transformation2D &t) const {
        double sum = 0;
        for (const SegmentPair &pair : pairs_) {
            const double area = quadrangleArea(pair.fixed, t * pair.moving);
            sum += pair.weight * area * area;
        }
        return sum;
    }

private:
    std::vector<SegmentPair> pairs_;
};

/// Finds a transformation with a small criterion by the Nelder-Mead simplex, as overview paper 2.2 did: no
/// derivatives, many evaluations, and no promise that it is the global minimum. The criterion is any callable
/// that takes a Transformation2D and gives a number.
class NelderMeadFitter {
public:
    double stepXY = 0.1;       ///< size of the first simplex; metres
    double stepAlpha = 0.1;    ///< the same for the rotation; radians
    double tolerance = 1e-9;   ///< size of the simplex, metres and radians, at which the search ends
    int maxEvaluations = 2000; ///< of the criterion

    /// The best transformation that was found, beginning at `start`. A criterion that is NaN counts as
    /// infinite.
    template <typename Criterion>
    Transformation2D operator()(const Criterion &criterion, const Transformation2D &start) {
        evaluations_ = 0;
        const auto at = [&](const Point &p) {
            ++evaluations_;
            const double value = criterion(Transformation2D(p[0], p[1], p[2]));
            return Vertex{p, std::isnan(value) ? std::numeric_limits<double>::infinity() : value};
        };
        const Point first{start.x(), start.y(), start.alpha()}, steps{stepXY, stepXY, stepAlpha};
        std::array<Vertex, 4> simplex;
        for (std::size_t i = 0; i < simplex.size(); ++i) {
            Point p = first;
            if (i > 0)
                p[i - 1] += steps[i - 1];
            simplex[i] = at(p);
        }
        for (sort(simplex); !hasCollapsed(simplex) && evaluations_ < maxEvaluations; sort(simplex))
            iterate(simplex, at);
        const Point &p = simplex.front().at;
        return {p[0], p[1], p[2]};
    }
    /// Of the criterion in the last call.
    int evaluations() const { return evaluations_; }

private:
    using Point = std::array<double, 3>; // x, y, alpha
    struct Vertex {
        Point at{};
        double value = 0;
    };

    template <typename At>
    static void iterate(std::array<Vertex, 4> &simplex, const At &at) {
        Vertex &worst = simplex[3];
        Point middle{}; // of all but the worst
        for (std::size_t v = 0; v < 3; ++v)
            for (std::size_t i = 0; i < 3; ++i)
                middle[i] += simplex[v].at[i] / 3;
        const Vertex reflected = at(along(middle, worst.at, -1));
        if (reflected.value < simplex[0].value) {
            const Vertex expanded = at(along(middle, worst.at, -2));
            worst = expanded.value < reflected.value ? expanded : reflected;
        } else if (reflected.value < simplex[2].value) {
            worst = reflected;
        } else {
            const bool outside = reflected.value < worst.value;
            const Vertex contracted = at(along(middle, worst.at, outside ? -0.5 : 0.5));
            if (contracted.value < std::min(worst.value, reflected.value))
                worst = contracted;
            else
                for (std::size_t v = 1; v < 4; ++v)
                    simplex[v] = at(along(simplex[0].at, simplex[v].at, 0.5));
        }
    }
    static Point along(const Point &from, const Point &to, double k) {
        Point p;
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = from[i] + k * (to[i] - from[i]);
        return p;
    }
    static void sort(std::array<Vertex, 4> &simplex) {
        std::sort(simplex.begin(), simplex.end(),
                  [](const Vertex &a, const Vertex &b) { return a.value < b.value; });
    }
    bool hasCollapsed(const std::array<Vertex, 4> &simplex) const {
        double size = 0;
        for (const Vertex &v : simplex)
            for (std::size_t i = 0; i < 3; ++i)
                size = std::max(size, std::abs(v.at[i] - simplex[0].at[i]));
        return size <= tolerance;
    }

    int evaluations_ = 0;
};

} // namespace vectorlib
