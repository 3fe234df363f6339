#include "common/world/World.h"
#include "tests/bench/FloorPlanPairs.h"
#include "tests/bench/Logs.h"
#include "tests/bench/PlaceRows.h"
#include "tests/bench/PoseFree.h"
#include "tests/support/Hall.h"
#include "vectorlib/experiments/report/ScanPair.h"

#ifdef BENCH_MRPT
#include "tests/bench/MrptGlobal.h"
#endif
#ifdef BENCH_PCL
#include "tests/bench/PclPrerejective.h"
#endif

#include <benchmark/benchmark.h>

#include <iostream>
#include <random>

using namespace vectorlib;

namespace {

using Segments = std::vector<LineSegment2D<double>>;
using Point = Vector2D<double>;

Segments strewn(std::size_t count, double length) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    Segments world;
    for (std::size_t i = 0; i < count; ++i) {
        const Point at(20 * unit(random), 20 * unit(random));
        world.emplace_back(at, at + Point(unit(random), unit(random)) * length);
    }
    return world;
}

Segments foldedWall(std::size_t count) {
    Segments world;
    const auto corner = [count](std::size_t i) {
        const double angle = 2 * pi * double(i) / double(count), radius = i % 2 ? 5.1 : 5;
        return Point(std::cos(angle), std::sin(angle)) * radius;
    };
    for (std::size_t i = 0; i < count; ++i)
        world.emplace_back(corner(i), corner((i + 1) % count));
    return world;
}

void view(benchmark::State &state, const Segments &world) {
    Observer<double> observe;
    for (auto _ : state)
        benchmark::DoNotOptimize(observe(world, {0.1, 0.05, 0.3}).size());
}

void searchMap(benchmark::State &state) {
    Hall hall(static_cast<std::size_t>(state.range(0)));
    const Segments scan = hall.view({hall.middle.x + 0.4, hall.middle.y - 0.3, 0.5});
    CorrespondenceFinder find;
    for (auto _ : state)
        benchmark::DoNotOptimize(
            find(hall.map, scan, Transformation2D(hall.middle.x, hall.middle.y, 0.2)).solutions.size());
}

void searchScans(benchmark::State &state, const hermes::experiments::ScanPair &scans) {
    CorrespondenceFinder find;
    for (auto _ : state)
        benchmark::DoNotOptimize(find(scans.fixed.segments, scans.moving.segments).solutions.size());
}

void addViews(const std::string &name, Segments (*make)(std::size_t)) {
    for (const std::size_t count : {std::size_t(100), std::size_t(1000), std::size_t(10000)})
        benchmark::RegisterBenchmark(name.c_str(), [make](benchmark::State &state) {
            view(state, make(static_cast<std::size_t>(state.range(0))));
        })->Arg(int64_t(count));
}

bool addPillars() {
    const auto world = hermes::readWorld(BENCH_WORLDS "/pillars.json");
    if (!world) {
        std::cerr << world.error() << '\n';
        return false;
    }
    const Segments edges = hermes::experiments::edgesOf(*world);
    for (std::size_t i = 0; i + 1 < world->poses.size(); ++i) {
        const auto pose = [&](std::size_t k) {
            return Pose2D{world->poses[k].x, world->poses[k].y, world->poses[k].theta};
        };
        const hermes::experiments::ScanPair scans =
            hermes::experiments::scanPair(edges, pose(i), pose(i + 1), {});
        benchmark::RegisterBenchmark("search between two scans of pillars", [scans](benchmark::State &state) {
            searchScans(state, scans);
        })->Arg(int64_t(i));
    }
    return true;
}

/// For a rival that takes long.
[[maybe_unused]] bench::SharedPairs everyTenth(const bench::SharedPairs &pairs) {
    bench::ScanPairs some;
    for (std::size_t i = 0; i < pairs->size(); i += 10)
        some.push_back((*pairs)[i]);
    return bench::shared(some);
}

/// Two scans and nothing else: the same pairs for all.
void addPairs(const std::string &what, const bench::SharedPairs &pairs) {
    bench::addRow<bench::ByGlobalPairMatcher>("GlobalPairMatcher", what, pairs);
    bench::addRow<bench::ByRelations>("RelationMatcher", what, pairs);
    bench::addRow<bench::ByRelationsOfEdges>("RelationMatcher, edges given", what, pairs);
    bench::addRow<bench::ByFinder>("CorrespondenceFinder", what, pairs);
    bench::addRow<bench::ByFinderOfEdges>("CorrespondenceFinder, edges given", what, pairs);
#ifdef BENCH_MRPT
    bench::addRow<bench::MrptGridMaps>("MRPT CGridMapAligner", what, pairs);
    bench::addRow<bench::MrptLandmarks>("MRPT se2_l2_robust, then CICP", what, pairs);
#endif
#ifdef BENCH_PCL
    bench::addRow<bench::PclPrerejective>("PCL prerejective, then ICP", what, everyTenth(pairs));
#endif
}

void addRealPairs() {
    if (!bench::haveLogs()) {
        std::cerr << "the logs of real scanners are not here (HERMES_DATA names their folder): simulated "
                     "pairs only\n";
        return;
    }
    const std::size_t most = bench::casesOf(300);
    addPairs("intel, consecutive",
             bench::shared(bench::ofSecondHalf(bench::pairsOf(bench::readLog("intel"), 1, 100000), most)));
    addPairs(
        "freiburg-079, every 5th",
        bench::shared(bench::ofSecondHalf(bench::pairsOf(bench::readLog("freiburg-079"), 5, 100000), most)));
}

} // namespace

int main(int argc, char **argv) {
    addViews("expected view, short edges", [](std::size_t n) { return strewn(n, 0.5); });
    addViews("expected view, long edges", [](std::size_t n) { return strewn(n, 5); });
    addViews("expected view, all edges seen", foldedWall);
    benchmark::RegisterBenchmark("search in a map", searchMap)->Arg(100)->Arg(100000);
    if (!addPillars())
        return 1;
#ifndef BENCH_MRPT
    std::cerr << "MRPT (libmrpt-slam-dev) was not installed when this was built: no rivals of it\n";
#endif
#ifndef BENCH_PCL
    std::cerr << "PCL (libpcl-dev) was not installed when this was built: no rival of it\n";
#endif
    addPairs("floor plans", bench::shared(bench::FloorPlanPairs(1).draw(bench::casesOf(300))));
    try {
        addRealPairs();
    } catch (const hermes::vector::Failure &failure) {
        std::cerr << failure.what() << '\n';
        return 1;
    }
    bench::addPlaceRows();
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
