#include "common/platform/BootClock.h"

#include <ctime>

namespace hermes {

// Of Linux: the monotonic clock of POSIX stands still meanwhile.
double bootNow() {
    timespec now{};
    ::clock_gettime(CLOCK_BOOTTIME, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

} // namespace hermes
