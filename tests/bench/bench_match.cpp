#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"

#include <vectorlib/io/CarmenLog.h>
#include <vectorlib/mapping/GlobalPairMatcher.h>
#include <vectorlib/mapping/ScanPairMatcher.h>

#include <benchmark/benchmark.h>

#ifdef BENCH_MRPT
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/slam/CICP.h>
#endif

#include <time.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>

using namespace vectorlib;

namespace {

using Points = std::vector<Vector2D<float>>;

/// Two scans of a log with what odometry and reference say of the motion between them.
struct Pair {
    Points fixed, moving;
    Transformation2D expected, reference;
    EarSettings scanner;
};

std::vector<Pair> pairsOf(const CarmenLog &log, std::size_t every, std::size_t most) {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i + every < log.scans.size() && pairs.size() < most; i += every) {
        const auto odometry = log.odometryMotion(i, i + every, CarmenOdometryKind::Corrected);
        const CarmenScan &scan = log.scans[i];
        Pair p;
        scan.appendPoints(p.fixed);
        log.scans[i + every].appendPoints(p.moving);
        p.expected = odometry.value_or(Transformation2D());
        p.reference = log.referenceMotion(i, i + every);
        p.scanner = EarSettings::forScanner(scan.angleStep * double(scan.ranges.size()), scan.ranges.size());
        pairs.push_back(std::move(p));
    }
    return pairs;
}

/// Points to lines to motion, segmentation and vectorization of both scans included.
struct Ours {
    ScanPairMatcher match;

    Transformation2D operator()(const Pair &pair) {
        match.extract.segment.settings = pair.scanner;
        return match(pair.fixed, pair.moving, pair.expected).pose;
    }
};

/// From the points alone.
struct OursWithoutGuess {
    GlobalPairMatcher match;

    Transformation2D operator()(const Pair &pair) {
        const GlobalPairMatch &found = match(pair.fixed, pair.moving);
        return found.solutions.empty() ? Transformation2D() : found.solutions[0].pose;
    }
};

#ifdef BENCH_MRPT
/// With its default settings; its maps of points are made within the time measured.
template <bool knowsOdometry>
struct Mrpt {
    mrpt::slam::CICP icp;
    mrpt::maps::CSimplePointsMap fixed, moving;

    Transformation2D operator()(const Pair &pair) {
        fill(fixed, pair.fixed);
        fill(moving, pair.moving);
        const Transformation2D &guess = knowsOdometry ? pair.expected : Transformation2D();
        const mrpt::poses::CPose2D start(guess.x(), guess.y(), guess.alpha());
        mrpt::poses::CPose2D found;
        icp.Align(&fixed, &moving, start)->getMean(found);
        return {found.x(), found.y(), found.phi()};
    }
    static void fill(mrpt::maps::CSimplePointsMap &map, const Points &points) {
        map.clear();
        map.reserve(points.size());
        for (const auto &p : points)
            map.insertPointFast(p.x, p.y);
        map.mark_as_modified();
    }
};
#endif

double processorMicroseconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) * 1e6 + double(t.tv_nsec) * 1e-3;
}

/// One iteration matches all pairs of a log; the counters hold shares and the median time of a pair.
template <typename Method>
void matchAll(benchmark::State &state, const std::vector<Pair> &pairs) {
    Method method;
    std::vector<double> times;
    double near = 0, nearer = 0;
    for (auto _ : state) {
        times.clear();
        near = nearer = 0;
        for (const Pair &pair : pairs) {
            const double begin = processorMicroseconds();
            const Transformation2D found = method(pair);
            times.push_back(processorMicroseconds() - begin);
            const double metres = (found.translation() - pair.reference.translation()).norm();
            const double degrees = std::abs((pair.reference.inverse() * found).alpha()) * 180 / pi;
            near += metres <= 0.10 && degrees <= 2;
            nearer += metres <= 0.05 && degrees <= 2;
        }
    }
    std::nth_element(times.begin(), times.begin() + std::ptrdiff_t(times.size() / 2), times.end());
    state.counters["pairs"] = double(pairs.size());
    state.counters["median_us"] = times[times.size() / 2];
    std::sort(times.begin(), times.end());
    state.counters["p99_us"] = times[times.size() * 99 / 100];
    state.counters["within_10cm_2deg"] = near / double(pairs.size());
    state.counters["within_5cm_2deg"] = nearer / double(pairs.size());
}

using SharedPairs = std::shared_ptr<const std::vector<Pair>>;

SharedPairs shared(std::vector<Pair> pairs) {
    return std::make_shared<const std::vector<Pair>>(std::move(pairs));
}
template <typename Method>
void row(const std::string &method, const std::string &what, const SharedPairs &pairs) {
    benchmark::RegisterBenchmark((method + "/" + what).c_str(), [=](benchmark::State &state) {
        matchAll<Method>(state, *pairs);
    })->Iterations(1);
}
void add(const std::string &what, const SharedPairs &pairs) {
    row<Ours>("vectorlib", what, pairs);
#ifdef BENCH_MRPT
    row<Mrpt<true>>("MRPT CICP", what, pairs);
#endif
}
void addWithoutGuess(const std::string &what, const SharedPairs &pairs) {
    row<OursWithoutGuess>("vectorlib, no guess", what, pairs);
#ifdef BENCH_MRPT
    row<Mrpt<false>>("MRPT CICP, no guess", what, pairs);
#endif
}

} // namespace

int main(int argc, char **argv) {
    const char *given = std::getenv("HERMES_DATA");
    const std::string folder = given ? given : BENCH_SOURCE "/../shared/data/public";
    if (!std::filesystem::exists(folder)) {
        std::cerr << "skipped: the logs of real scanners are not here; HERMES_DATA names their folder\n";
        return 77;
    }
#ifndef BENCH_MRPT
    std::cerr << "MRPT (libmrpt-dev) was not installed when this was built: no rival\n";
#endif
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    const auto log = [&](const char *name) {
        hermes::vector::Input input(folder + "/" + name + "-corrected.log.gz");
        return hermes::vector::valueOrFail(readCarmenLog(input.stream(), input.name()));
    };
    try {
        const SharedPairs intel = shared(pairsOf(log("intel"), 1, 1000));
        const CarmenLog freiburg = log("freiburg-079");
        const SharedPairs fifth = shared(pairsOf(freiburg, 5, 1000));
        add("intel, consecutive", intel);
        add("freiburg-079, first 1000", shared(pairsOf(freiburg, 1, 1000)));
        add("freiburg-079, every 5th", fifth);
        addWithoutGuess("intel, consecutive", intel);
        addWithoutGuess("freiburg-079, every 5th", fifth);
        for (const char *name : {"fhw", "belgioioso", "orebro"})
            addWithoutGuess(std::string(name) + ", consecutive", shared(pairsOf(log(name), 1, 1000)));
    } catch (const hermes::vector::Failure &failure) {
        std::cerr << failure.what() << '\n';
        return 1;
    }
    benchmark::RunSpecifiedBenchmarks();
}
