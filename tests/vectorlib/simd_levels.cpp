// Segmentation and vectorization of random scans give the same at both instruction levels. Needs no Qt, so
// that it also runs where only the compiler of another processor is there.
#include <vectorlib/segmentation/EarSegmenter.h>
#include <vectorlib/vectorization/FtlsVectorizer.h>

#include <cstdio>
#include <random>

using namespace vectorlib;

namespace {

std::size_t clusters = 0, found = 0;

template <typename Input>
bool agree(EarSegmenter<float> &plain, EarSegmenter<float> &best, const Input &input) {
    const Segmentation &a = plain(input), &b = best(input);
    clusters += a.size();
    return a.labels == b.labels && a.order == b.order && a.starts == b.starts;
}

bool segmentationAgrees(unsigned seed) {
    EarSegmenter<float> plain, best;
    plain.level = simd::Level::Scalar;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> u(0, 1);
    const std::size_t count = random() % 500;
    const float stray = u(random) < 0.5f ? 0.02f : 0.4f, jump = u(random) < 0.5f ? 0 : 0.02f;
    std::vector<std::uint16_t> millimetres;
    std::vector<float> metres;
    float wall = 2;
    for (std::size_t i = 0; i < count; ++i) {
        wall = u(random) < jump ? 0.3f + 5 * u(random) : wall * (0.99f + 0.02f * u(random));
        const float range = wall * (u(random) < stray ? 0.5f + u(random) : 1);
        millimetres.push_back(random() % 40 ? std::uint16_t(range * 1000) : std::uint16_t(0));
        metres.push_back(float(millimetres.back()) / 1000);
    }
    plain.settings.closed = random() % 2;
    plain.settings.neighbours = 1 + int(random() % 20);
    plain.settings.minPoints = 1 + int(random() % 15);
    best.settings = plain.settings;
    const double step = 2 * pi / double(count + 1);
    const PolarScan<float> scan{metres.data(), count, 0, step};
    std::vector<Vector2D<float>> points;
    for (std::size_t i = 0; i < count; ++i)
        points.emplace_back(scan.point(i));
    return agree(plain, best, scan) && agree(plain, best, PointSpan<float>(points)) &&
           agree(plain, best, PolarScan<std::uint16_t>{millimetres.data(), count, 0, step, 0.001});
}

bool sameRows(const BlockSums &a, const BlockSums &b) {
    for (std::ptrdiff_t i = 0; i <= a.lastRow(); ++i) {
        const SumRow s = a.table().row(i), t = b.table().row(i);
        if (!(s.x == t.x && s.y == t.y && s.xx == t.xx && s.yy == t.yy && s.xy == t.xy))
            return false;
    }
    return a.lastRow() == b.lastRow() && a.localError(0, a.size()) == b.localError(0, b.size());
}

bool vectorizationAgrees(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> u(0, 1);
    std::normal_distribution<float> noise(0, 0.01f);
    std::vector<Vector2D<float>> points;
    float x = 5, y = -3, heading = 0;
    for (std::size_t count = 2 + random() % 3000; points.size() < count;) {
        heading = u(random) < 0.01f ? 7 * u(random) : heading;
        x += 0.02f * std::cos(heading);
        y += 0.02f * std::sin(heading);
        const float aside = noise(random);
        points.emplace_back(x + aside, y - aside);
    }
    BlockSums plainSums, bestSums;
    FtlsVectorizer<float> plain, best;
    plain.level = plainSums.level = simd::Level::Scalar;
    plainSums.assign(points);
    bestSums.assign(points);
    const auto &a = plain(points), &b = best(points);
    found += a.size();
    bool same = sameRows(plainSums, bestSums) && a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i)
        same = a[i].first == b[i].first && a[i].last == b[i].last;
    return same;
}

} // namespace

int main() {
    for (unsigned seed = 1; seed <= 400; ++seed)
        if (!segmentationAgrees(seed) || !vectorizationAgrees(seed)) {
            std::printf("seed %u: the levels differ\n", seed);
            return 1;
        }
    const char *names[] = {"plain C++", "NEON", "AVX2"};
    std::printf("%zu clusters, %zu lines, best level: %s\n", clusters, found, names[int(simd::bestLevel())]);
    return clusters > 1000 && found > 1000 ? 0 : 1;
}
