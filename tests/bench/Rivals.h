#pragma once

#include <vectorlib/geometry/Vector2D.h>
#include <vectorlib/simd/Simd.h>

#include <algorithm>
#include <cmath>
#include <vector>

/// Plain vectorizers, each as short and as fast as straight code gets: the yardsticks of bench_vectorize.
/// Their result is the indices of the points at which lines begin and end. They own their buffers.
namespace rivals {

using Points = vectorlib::PointSpan<float>;

/// The five prefix sums of (6.23) in double, one point after the other, and nothing else.
class PlainSums {
public:
    std::size_t operator()(Points points) {
        rows_.resize(points.size() + 1);
        Row sum{};
        rows_[0] = sum;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double x = points[i].x, y = points[i].y;
            sum.x += x;
            sum.y += y;
            sum.xx += x * x;
            sum.xy += x * y;
            sum.yy += y * y;
            rows_[i + 1] = sum;
        }
        return rows_.size();
    }

private:
    struct Row {
        double x, y, xx, xy, yy;
    };
    std::vector<Row> rows_;
};

/// A line through the key point and the first beyond the tolerance (or, `adjacent`, the next); points join it
/// until one lies farther than the tolerance.
template <bool adjacent>
class ReumannWitkam {
public:
    float tolerance = 0.06f;

    std::size_t operator()(Points p) {
        kept_.clear();
        kept_.push_back(0);
        for (std::size_t key = 0; key + 1 < p.size();) {
            const auto origin = p[key];
            std::size_t next = key + 1;
            auto d = p[next++] - origin;
            while (!adjacent && next < p.size() && d.squaredNorm() <= tolerance * tolerance)
                d = p[next++] - origin;
            const float limit = tolerance * tolerance * d.squaredNorm();
            for (; next < p.size(); ++next)
                if (const float c = d.cross(p[next] - origin); c * c > limit)
                    break;
            key = next - 1;
            kept_.push_back(key);
        }
        return kept_.size() - 1;
    }

private:
    std::vector<std::size_t> kept_;
};

/// The farthest point of first + 1 .. last - 1 from the line through the ends, by its cross product.
struct Farthest {
    float cross = 0;
    std::size_t index = 0;
};
inline Farthest farthestPlain(Points p, std::size_t first, std::size_t last) {
    const auto origin = p[first], d = p[last] - origin;
    Farthest f;
    for (std::size_t i = first + 1; i < last; ++i)
        if (const float c = std::abs(d.cross(p[i] - origin)); c > f.cross)
            f = {c, i};
    return f;
}

#if defined(VECTORLIB_SIMD_AVX2)
VECTORLIB_AVX2 inline Farthest farthestAvx2(Points p, std::size_t first, std::size_t last) {
    const auto origin = p[first], d = p[last] - origin;
    const __m256 ox = _mm256_set1_ps(origin.x), oy = _mm256_set1_ps(origin.y);
    const __m256 dx = _mm256_set1_ps(d.x), dy = _mm256_set1_ps(d.y), sign = _mm256_set1_ps(-0.0f);
    __m256 most = _mm256_setzero_ps();
    __m256i at = _mm256_setzero_si256(), now = at;
    std::size_t i = first + 1;
    const float *q = &p.begin()->x + 2 * i;
    for (; i + 8 <= last; i += 8, q += 16) {
        const __m256 a = _mm256_loadu_ps(q), b = _mm256_loadu_ps(q + 8);
        const __m256 x = _mm256_sub_ps(_mm256_shuffle_ps(a, b, 0x88), ox);
        const __m256 y = _mm256_sub_ps(_mm256_shuffle_ps(a, b, 0xdd), oy);
        const __m256 c = _mm256_andnot_ps(sign, _mm256_sub_ps(_mm256_mul_ps(dx, y), _mm256_mul_ps(dy, x)));
        const __m256i more = _mm256_castps_si256(_mm256_cmp_ps(c, most, _CMP_GT_OQ));
        most = _mm256_max_ps(most, c);
        at = _mm256_blendv_epi8(at, now, more);
        now = _mm256_add_epi32(now, _mm256_set1_epi32(8));
    }
    constexpr std::size_t lane[8] = {0, 1, 4, 5, 2, 3, 6, 7};
    alignas(32) float values[8];
    alignas(32) int indices[8];
    _mm256_store_ps(values, most);
    _mm256_store_si256(reinterpret_cast<__m256i *>(indices), at);
    Farthest f;
    for (std::size_t k = 0; k < 8; ++k)
        if (values[k] > f.cross)
            f = {values[k], first + 1 + lane[k] + static_cast<std::size_t>(indices[k])};
    for (; i < last; ++i)
        if (const float c = std::abs(d.cross(p[i] - origin)); c > f.cross)
            f = {c, i};
    return f;
}
#else
inline Farthest farthestAvx2(Points p, std::size_t first, std::size_t last) {
    return farthestPlain(p, first, last);
}
#endif

/// Splits at the farthest point until none is farther than the tolerance; a stack instead of recursion.
template <Farthest (*farthest)(Points, std::size_t, std::size_t)>
class DouglasPeucker {
public:
    float tolerance = 0.06f;

    std::size_t operator()(Points p) {
        kept_.clear();
        if (p.size() < 2)
            return 0;
        stack_.assign(1, p.size() - 1);
        std::size_t first = 0;
        while (!stack_.empty()) {
            const std::size_t last = stack_.back();
            const Farthest f = farthest(p, first, last);
            const float limit = tolerance * tolerance * (p[last] - p[first]).squaredNorm();
            if (f.cross * f.cross > limit) {
                stack_.push_back(f.index);
                continue;
            }
            kept_.push_back(first);
            first = last;
            stack_.pop_back();
        }
        return kept_.size();
    }

private:
    std::vector<std::size_t> stack_, kept_;
};

/// Adds point after point to a total least squares line until its standard deviation (6.22) exceeds sigma.
/// `withRoot`: the variance by its formula; else the threshold test of vectorlib without root or division.
template <bool withRoot>
class Inc {
public:
    double sigma = 0.02;

    std::size_t operator()(Points p) {
        kept_.clear();
        const double variance = sigma * sigma;
        for (std::size_t first = 0; first < p.size();) {
            kept_.push_back(first);
            double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
            std::size_t i = first;
            for (; i < p.size(); ++i) {
                const double x = p[i].x - p[first].x, y = p[i].y - p[first].y;
                n += 1;
                sx += x;
                sy += y;
                sxx += x * x;
                sxy += x * y;
                syy += y * y;
                const double a = n * sxx - sx * sx, b = n * syy - sy * sy, c = n * sxy - sx * sy;
                if (i < first + 2)
                    continue;
                if constexpr (withRoot) {
                    if ((a + b - std::sqrt((a - b) * (a - b) + 4 * c * c)) / (2 * n * n) > variance)
                        break;
                } else {
                    const double limit = n * n * variance;
                    if (a > limit && b > limit && (a - limit) * (b - limit) > c * c)
                        break;
                }
            }
            first = i;
        }
        return kept_.size();
    }

private:
    std::vector<std::size_t> kept_;
};

} // namespace rivals
