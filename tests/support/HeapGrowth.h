#pragma once

#include <QtTest>
#include <cstdint>
#include <functional>
#include <malloc.h>

/// Lets a minute of simulated traffic settle the heap; then hours of it ($HERMES_TRAFFIC_HOURS, half of one
/// where it is not set) must not make it grow. run: makes traffic of so many seconds; bytes: how much it
/// made.
inline void verifyTrafficNeedsNoMoreMemory(const std::function<void(double)> &run,
                                           const std::function<std::uint64_t()> &bytes) {
    const double hours = qEnvironmentVariable("HERMES_TRAFFIC_HOURS", "0.5").toDouble();
    run(60);
    const std::size_t before = mallinfo2().uordblks;
    if (before == 0)
        QSKIP("a sanitizer has a heap of its own");
    run(hours * 3600);
    const std::size_t after = mallinfo2().uordblks;
    qInfo("%.1f h, %llu bytes on the line: heap %zu bytes before, %zu after", hours, bytes() + 0ULL, before,
          after);
    QVERIFY(after <= before + 4096);
}
