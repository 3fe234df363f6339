#pragma once

#include <algorithm>
#include <chrono>

namespace hermes::experiments {

/// Microseconds that a function takes, the best of three measurements of enough repetitions each.
template <typename Function>
double timeOf(Function function) {
    using Clock = std::chrono::steady_clock;
    double best = 1e300;
    int repetitions = 1;
    for (int measurement = 0; measurement < 3;) {
        const auto begin = Clock::now();
        for (int i = 0; i < repetitions; ++i)
            function();
        const double us = std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
        if (us < 200 && repetitions < 10000) {
            repetitions *= 4;
            continue;
        }
        best = std::min(best, us / repetitions);
        ++measurement;
    }
    return best;
}

} // namespace hermes::experiments
