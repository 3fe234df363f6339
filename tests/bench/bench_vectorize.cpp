#include "tests/bench/Room.h"

#include <vectorlib/segmentation/EarSegmenter.h>
#include <vectorlib/vectorization/FtlsVectorizer.h>

#include <benchmark/benchmark.h>

using namespace vectorlib;

namespace {

/// The yardstick: five prefix sums in doubles and nothing else.
void fivePrefixSums(benchmark::State &state) {
    const auto points = roomScan(int(state.range(0)));
    struct Row {
        double x, y, xx, xy, yy;
    };
    std::vector<Row> rows(points.size() + 1);
    for (auto _ : state) {
        Row sum{};
        rows[0] = sum;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double x = points[i].x, y = points[i].y;
            sum.x += x;
            sum.y += y;
            sum.xx += x * x;
            sum.xy += x * y;
            sum.yy += y * y;
            rows[i + 1] = sum;
        }
        benchmark::DoNotOptimize(rows.data());
        benchmark::ClobberMemory();
    }
}

void ftls(benchmark::State &state, bool polyline) {
    const auto points = roomScan(int(state.range(0)));
    FtlsVectorizer<float> vectorize;
    vectorize.settings.polyline = polyline;
    std::size_t lines = 0;
    for (auto _ : state) {
        lines = vectorize(points).size();
        benchmark::DoNotOptimize(lines);
        benchmark::ClobberMemory();
    }
    state.counters["lines"] = double(lines);
}

void segment(benchmark::State &state) {
    const auto points = roomScan(int(state.range(0)));
    EarSegmenter<float> segmenter;
    for (auto _ : state) {
        benchmark::DoNotOptimize(segmenter(points).size());
        benchmark::ClobberMemory();
    }
}

void sizes(benchmark::internal::Benchmark *b) {
    b->Arg(2000)->Arg(20000);
}

BENCHMARK(fivePrefixSums)->Apply(sizes);
BENCHMARK_CAPTURE(ftls, intervals, false)->Apply(sizes);
BENCHMARK_CAPTURE(ftls, polyline, true)->Apply(sizes);
BENCHMARK(segment)->Apply(sizes);

} // namespace

BENCHMARK_MAIN();
