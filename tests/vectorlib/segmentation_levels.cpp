// Segmentation of random scans gives the same at both instruction levels. Needs no Qt, so that it also runs
// where only the compiler of another processor is there.
#include <vectorlib/segmentation/EarSegmenter.h>

#include <cstdio>
#include <random>

using namespace vectorlib;

namespace {

std::size_t clusters = 0;

template <typename Input>
bool agree(EarSegmenter<float> &plain, EarSegmenter<float> &best, const Input &input) {
    const Segmentation &a = plain(input), &b = best(input);
    clusters += a.size();
    return a.labels == b.labels && a.order == b.order && a.starts == b.starts;
}

} // namespace

int main() {
    EarSegmenter<float> plain, best;
    plain.level = simd::Level::Scalar;
    for (unsigned seed = 1; seed <= 400; ++seed) {
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
        if (!agree(plain, best, scan) || !agree(plain, best, PointSpan<float>(points)) ||
            !agree(plain, best, PolarScan<std::uint16_t>{millimetres.data(), count, 0, step, 0.001})) {
            std::printf("seed %u: the levels differ\n", seed);
            return 1;
        }
    }
    const char *names[] = {"plain C++", "NEON", "AVX2"};
    std::printf("%zu clusters, best level: %s\n", clusters, names[int(simd::bestLevel())]);
    return clusters > 1000 ? 0 : 1;
}
