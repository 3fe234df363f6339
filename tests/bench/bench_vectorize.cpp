#include "tests/bench/Library.h"
#include "tests/bench/Rivals.h"
#include "tests/bench/Room.h"

#include <vectorlib/segmentation/EarSegmenter.h>
#include <vectorlib/vectorization/AftlsVectorizer.h>

#include <benchmark/benchmark.h>

using namespace vectorlib;

namespace {

/// The room (by its number of lines), the points of a scan, and how many scans.
std::vector<std::vector<Vector2D<float>>> scans(const benchmark::State &state) {
    const Corners room = state.range(0) > 20 ? foldedHall() : plainRoom();
    const int points = int(state.range(1)), count = int(state.range(2));
    if (count == 1)
        return {roomScan(points, room)};
    return roomScans(count, points, room);
}

/// Runs a vectorizer that returns how many lines it found, on one scan again and again or on many in turn.
template <typename Method>
void run(benchmark::State &state, Method method) {
    const auto all = scans(state);
    std::size_t at = 0, lines = 0;
    for (auto _ : state) {
        lines += method(PointSpan<float>(all[at]));
        at = at + 1 == all.size() ? 0 : at + 1;
        benchmark::DoNotOptimize(lines);
        benchmark::ClobberMemory();
    }
    state.counters["lines"] = double(lines) / double(state.iterations());
}

template <bool polyline>
class Ftls {
public:
    Ftls() { vectorize_.settings.polyline = polyline; }
    std::size_t operator()(PointSpan<float> points) { return vectorize_(points).size(); }

private:
    FtlsVectorizer<float> vectorize_;
};

struct Aftls {
    Aftls() { vectorize.settings.polyline = false; }
    std::size_t operator()(PointSpan<float> points) { return vectorize(points).size(); }
    AftlsVectorizer<float> vectorize;
};

struct Segment {
    std::size_t operator()(PointSpan<float> points) { return segment(points).size(); }
    EarSegmenter<float> segment;
};

template <typename Method>
void add(const char *name) {
    benchmark::RegisterBenchmark(name, [](benchmark::State &state) { run(state, Method()); })
        ->ArgsProduct({{10, 50}, {180, 2000, 20000}, {1}})
        ->ArgsProduct({{10, 50}, {2000}, {64}});
}

} // namespace

int main(int argc, char **argv) {
    add<Ftls<false>>("FTLS");
    add<Ftls<true>>("FTLS, polyline");
    add<Aftls>("AFTLS");
    add<rivals::PlainSums>("five prefix sums");
    add<rivals::DouglasPeucker<rivals::farthestPlain>>("Douglas-Peucker");
    add<rivals::DouglasPeucker<rivals::farthestAvx2>>("Douglas-Peucker, SIMD");
    add<rivals::ReumannWitkam<false>>("Reumann-Witkam");
    add<rivals::ReumannWitkam<true>>("Reumann-Witkam, adjacent");
    add<rivals::Inc<true>>("INC");
    add<rivals::Inc<false>>("INC without root");
#ifdef BENCH_BOOST
    add<rivals::BoostSimplify>("Boost.Geometry simplify");
#endif
#ifdef BENCH_OPENCV
    add<rivals::OpenCvApprox>("OpenCV approxPolyDP");
#endif
    add<Segment>("EarSegmenter");
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
