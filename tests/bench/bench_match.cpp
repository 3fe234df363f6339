#include "gui/vector/Failure.h"
#include "tests/bench/Logs.h"
#include "tests/bench/PoseFree.h"

#include <iostream>

#include <vectorlib/mapping/ScanPairMatcher.h>

#ifdef BENCH_MRPT
#include "tests/bench/MrptIcp.h"
#endif

using namespace bench;

namespace {

/// Points to lines to motion, segmentation and vectorization of both scans included.
struct WithOdometry {
    vectorlib::ScanPairMatcher match;

    void prepare(const ScanPair &) {}
    Answer operator()(const ScanPair &pair) {
        match.extract.segment.settings = vectorlib::EarSettings::forScanner(pair.fieldOfView, pair.rays);
        const vectorlib::ScanPairMatch &found = match(pair.fixed, pair.moving, pair.expected);
        return {found.pose, found.accepted};
    }
};

void add(const std::string &what, const SharedPairs &pairs) {
    addRow<WithOdometry>("vectorlib", what, pairs);
#ifdef BENCH_MRPT
    addRow<MrptIcp<true>>("MRPT CICP", what, pairs);
#endif
}
void addWithoutGuess(const std::string &what, const SharedPairs &pairs) {
    addRow<ByGlobalPairMatcher>("vectorlib, no guess", what, pairs);
#ifdef BENCH_MRPT
    addRow<MrptIcp<false>>("MRPT CICP, no guess", what, pairs);
#endif
}

} // namespace

int main(int argc, char **argv) {
    if (!haveLogs()) {
        std::cerr << "skipped: the logs of real scanners are not here; HERMES_DATA names their folder\n";
        return 77;
    }
#ifndef BENCH_MRPT
    std::cerr << "MRPT (libmrpt-dev) was not installed when this was built: no rival\n";
#endif
    benchmark::AddCustomContext("compiler", BENCH_COMPILER);
    benchmark::Initialize(&argc, argv);
    try {
        const SharedPairs intel = shared(pairsOf(readLog("intel"), 1, 1000));
        const vectorlib::CarmenLog freiburg = readLog("freiburg-079");
        const SharedPairs fifth = shared(pairsOf(freiburg, 5, 1000));
        add("intel, consecutive", intel);
        add("freiburg-079, first 1000", shared(pairsOf(freiburg, 1, 1000)));
        add("freiburg-079, every 5th", fifth);
        addWithoutGuess("intel, consecutive", intel);
        addWithoutGuess("freiburg-079, every 5th", fifth);
        for (const char *name : {"fhw", "belgioioso", "orebro"})
            addWithoutGuess(std::string(name) + ", consecutive", shared(pairsOf(readLog(name), 1, 1000)));
    } catch (const hermes::vector::Failure &failure) {
        std::cerr << failure.what() << '\n';
        return 1;
    }
    benchmark::RunSpecifiedBenchmarks();
}
