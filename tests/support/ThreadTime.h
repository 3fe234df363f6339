#pragma once

#include <ctime>

namespace hermes {

/// Time that the processor has spent on this thread, in milliseconds.
inline double threadTime_ms() {
    timespec now{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
}

} // namespace hermes
