#pragma once

#include <time.h>

namespace hermes::experiments {

/// Processor time of this thread so far, which other programs do not lengthen; microseconds.
inline double processorMicroseconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) * 1e6 + double(t.tv_nsec) * 1e-3;
}

} // namespace hermes::experiments
