#include "tests/fuzz/FuzzPoints.h"

#include <vectorlib/vectorization/AftlsVectorizer.h>
#include <vectorlib/vectorization/DouglasPeuckerVectorizer.h>
#include <vectorlib/vectorization/FtlsVectorizer.h>
#include <vectorlib/vectorization/IncVectorizer.h>
#include <vectorlib/vectorization/OptimalVectorizer.h>
#include <vectorlib/vectorization/ReumannWitkamVectorizer.h>
#include <vectorlib/vectorization/SplitAndMergeVectorizer.h>

using namespace vectorlib;

namespace {

using Lines = std::vector<VectorizedLine>;

void requireSound(const VectorizedLine &line) {
    const auto &[a, b, c] = line.line;
    FUZZ_REQUIRE(std::isfinite(a) && std::isfinite(b) && std::isfinite(c) && c >= 0);
    FUZZ_REQUIRE(!line.line.isValid() || std::abs(a * a + b * b - 1) < 1e-6);
    FUZZ_REQUIRE(std::isfinite(line.sigma) && line.sigma >= 0 && isFinite(line.sums));
    FUZZ_REQUIRE(line.segment.isFinite() && line.segment.direction().isFinite());
}

/// Intervals follow each other from the first to the last point, each of at least two points (`least`).
void requirePartition(const Lines &lines, std::size_t count, std::size_t least) {
    FUZZ_REQUIRE(lines.empty() == (count < 2));
    std::size_t next = 0;
    for (const VectorizedLine &line : lines) {
        FUZZ_REQUIRE(line.first == next && line.last + 1 >= line.first + least && line.last < count);
        next = line.last + 1;
    }
    FUZZ_REQUIRE(lines.empty() || next == count);
}

bool isSame(const Lines &a, const Lines &b) {
    const auto same = [](const VectorizedLine &l, const VectorizedLine &m) {
        return l.first == m.first && l.last == m.last && l.line.a == m.line.a && l.line.b == m.line.b &&
               l.line.c == m.line.c && l.sigma == m.sigma && l.segment.begin() == m.segment.begin() &&
               l.segment.end() == m.segment.end();
    };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

/// Twice with the same buffers: what they held must not matter.
template <typename Scalar, typename Vectorizer>
Lines run(Vectorizer &vectorize, const std::vector<Vector2D<Scalar>> &points,
          const VectorizerSettings &settings, std::size_t least = 2) {
    static_cast<VectorizerSettings &>(vectorize.settings) = settings;
    const Lines lines = vectorize(points);
    for (const VectorizedLine &line : lines)
        requireSound(line);
    requirePartition(lines, points.size(), least);
    FUZZ_REQUIRE(isSame(lines, vectorize(points)));
    return lines;
}

template <typename Vectorizer, typename Scalar>
void runOne(const std::vector<Vector2D<Scalar>> &points, const VectorizerSettings &settings) {
    Vectorizer vectorize;
    run(vectorize, points, settings);
}

// Those that eliminate points count the point between two lines with the second: a line may have but one.
template <typename Vectorizer, typename Scalar>
void eliminate(const std::vector<Vector2D<Scalar>> &points, const PointEliminationSettings &settings) {
    Vectorizer vectorize;
    vectorize.settings = settings;
    run(vectorize, points, settings, 1);
}

// The same lines on every instruction set, and none of four points or more beyond sigma.
template <typename Scalar>
void runFtls(const std::vector<Vector2D<Scalar>> &points, const VectorizerSettings &settings) {
    FtlsVectorizer<Scalar> ftls, plain;
    plain.level = simd::Level::Scalar;
    const Lines lines = run(ftls, points, settings);
    FUZZ_REQUIRE(isSame(lines, run(plain, points, settings)));
    for (const Vector2D<Scalar> &p : points)
        if (!(p.squaredNorm() < 1e6)) // rounding counts
            return;
    for (const VectorizedLine &line : lines)
        FUZZ_REQUIRE(line.sums.n < 4 || line.sigma <= std::sqrt(settings.variance()) * (1 + 1e-6) + 1e-4);
}

/// As many as large clusters have, which are summed up by blocks.
template <typename Scalar>
std::vector<Vector2D<Scalar>> repeated(const std::vector<Vector2D<Scalar>> &points) {
    std::vector<Vector2D<Scalar>> many;
    while (!points.empty() && many.size() < 600)
        many.insert(many.end(), points.begin(), points.end());
    return many;
}

template <typename Scalar>
void runAll(FuzzInput &in) {
    PointEliminationSettings settings;
    settings.sigma = in.setting(settings.sigma);
    settings.delta = in.setting(settings.delta);
    settings.sigmas = in.setting(settings.sigmas);
    settings.polyline = in.flag();
    settings.measure = in.flag();
    const auto lines = in.take<std::uint8_t>();
    const int algorithm = in.take<std::uint8_t>() % 9;
    const bool slow = algorithm == 3 || algorithm == 8;
    const auto points = takePoints<Scalar>(in, slow ? 60 : 500);
    if (algorithm == 0) {
        runOne<TlsVectorizer<Scalar>>(points, settings);
    } else if (algorithm == 1) {
        runFtls(points, settings);
        runOne<FtlsVectorizer<Scalar>>(repeated(points), settings);
    } else if (algorithm == 2) {
        runOne<AftlsVectorizer<Scalar>>(points, settings);
        runOne<AftlsVectorizer<Scalar>>(repeated(points), settings);
    } else if (algorithm == 3) {
        AftlsVectorizer<Scalar> aftls;
        aftls.search = AftlsVectorizer<Scalar>::Search::NelderMead;
        run(aftls, points, settings);
    } else if (algorithm == 4) {
        runOne<IncVectorizer<Scalar>>(points, settings);
    } else if (algorithm == 5) {
        eliminate<DouglasPeuckerVectorizer<Scalar>>(points, settings);
    } else if (algorithm == 6) {
        eliminate<ReumannWitkamVectorizer<Scalar>>(points, settings);
    } else if (algorithm == 7) {
        SplitAndMergeVectorizer<Scalar> sam;
        sam.settings.sigmas = settings.sigmas;
        run(sam, points, settings);
    } else {
        OptimalVectorizer<Scalar> optimal;
        optimal.lines = lines;
        run(optimal, points, settings);
        FUZZ_REQUIRE(!(optimal.error() < 0));
    }
}

} // namespace

/// Every vectorizer ends, on whatever points and settings, with lines without NaN that share out the points.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    if (in.flag())
        runAll<double>(in);
    else
        runAll<float>(in);
    return 0;
}
