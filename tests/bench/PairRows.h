#pragma once

#include "tests/bench/ScanPair.h"

#include <benchmark/benchmark.h>

#include <time.h>

#include <cstdlib>
#include <memory>
#include <string>

namespace bench {

/// What a method makes of two scans.
struct Answer {
    vectorlib::Transformation2D motion; ///< the best there is; no motion where there is none
    bool isBelieved = false;            ///< the method says itself that this is it
};

using SharedPairs = std::shared_ptr<const ScanPairs>;

inline SharedPairs shared(ScanPairs pairs) {
    return std::make_shared<const ScanPairs>(std::move(pairs));
}

/// So many cases, or fewer where HERMES_BENCH_CASES says so: to see that a benchmark still runs.
inline std::size_t casesOf(std::size_t usual) {
    const char *most = std::getenv("HERMES_BENCH_CASES");
    return most ? std::min<std::size_t>(usual, std::strtoul(most, nullptr, 10)) : usual;
}

inline double processorMicroseconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) * 1e6 + double(t.tv_nsec) * 1e-3;
}

/// One iteration matches all pairs. The counters hold the median and the 99th percentile of the time of a
/// pair, the shares that are right, and those that the method believes though they are far wrong.
template <typename Method>
void matchAll(benchmark::State &state, const ScanPairs &pairs) {
    Method method;
    std::vector<double> times;
    double near = 0, nearer = 0, believed = 0, deceived = 0;
    for (auto _ : state) {
        times.clear();
        near = nearer = believed = deceived = 0;
        for (const ScanPair &pair : pairs) {
            method.prepare(pair);
            const double begin = processorMicroseconds();
            const Answer found = method(pair);
            times.push_back(processorMicroseconds() - begin);
            near += pair.isNear(found.motion, 0.10, 2);
            nearer += pair.isNear(found.motion, 0.05, 2);
            believed += found.isBelieved;
            deceived += found.isBelieved && !pair.isNear(found.motion, 0.5, 10);
        }
    }
    std::sort(times.begin(), times.end());
    const double count = double(pairs.size());
    state.counters["pairs"] = count;
    state.counters["median_us"] = times[times.size() / 2];
    state.counters["p99_us"] = times[times.size() * 99 / 100];
    state.counters["within_10cm_2deg"] = near / count;
    state.counters["within_5cm_2deg"] = nearer / count;
    state.counters["believed"] = believed / count;
    state.counters["far_wrong_believed"] = deceived / count;
}

/// The row "METHOD/WHAT".
template <typename Method>
void addRow(const std::string &method, const std::string &what, const SharedPairs &pairs) {
    benchmark::RegisterBenchmark((method + "/" + what).c_str(), [=](benchmark::State &state) {
        matchAll<Method>(state, *pairs);
    })->Iterations(1);
}

} // namespace bench
