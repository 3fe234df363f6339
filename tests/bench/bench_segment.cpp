#include "tests/bench/Room.h"

#include <vectorlib/segmentation/EarSegmenter.h>
#include <vectorlib/vectorization/FtlsVectorizer.h>

#include <benchmark/benchmark.h>

using namespace vectorlib;

namespace {

/// A scan of the room; with `strays` every 40th ray meets something at half the range.
std::vector<Vector2D<float>> scan(const benchmark::State &state, bool strays) {
    auto points = roomScan(int(state.range(0)));
    for (std::size_t i = 0; strays && i < points.size(); i += 40)
        points[i] = points[i] * 0.5f;
    return points;
}

void ftls(benchmark::State &state) {
    const auto points = scan(state, false);
    FtlsVectorizer<float> vectorize;
    vectorize.settings.polyline = false;
    for (auto _ : state) {
        benchmark::DoNotOptimize(vectorize(points).size());
        benchmark::ClobberMemory();
    }
}

void cartesian(benchmark::State &state, bool strays) {
    const auto points = scan(state, strays);
    EarSegmenter<float> segment;
    for (auto _ : state) {
        benchmark::DoNotOptimize(segment(points).size());
        benchmark::ClobberMemory();
    }
    state.counters["clusters"] = double(segment(points).size());
}

void polar(benchmark::State &state) {
    const auto points = scan(state, false);
    std::vector<std::uint16_t> millimetres;
    for (const auto &p : points)
        millimetres.push_back(std::uint16_t(p.norm() * 1000));
    const double step = 2 * pi / double(points.size());
    const PolarScan<std::uint16_t> ranges{millimetres.data(), millimetres.size(), -pi, step, 0.001, 0.05, 60};
    EarSegmenter<float> segment;
    for (auto _ : state) {
        benchmark::DoNotOptimize(segment(ranges).size());
        benchmark::ClobberMemory();
    }
    state.counters["clusters"] = double(segment(ranges).size());
}

void sizes(benchmark::internal::Benchmark *b) {
    for (int n : {500, 2000, 5000, 20000, 50000, 200000})
        b->Arg(n);
}

BENCHMARK(ftls)->Apply(sizes);
BENCHMARK_CAPTURE(cartesian, one room, false)->Apply(sizes);
BENCHMARK_CAPTURE(cartesian, with strays, true)->Apply(sizes);
BENCHMARK(polar)->Apply(sizes);

} // namespace

int main(int argc, char **argv) {
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
