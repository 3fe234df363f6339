#include "common/platform/Threads.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace hermes {

namespace {

constexpr int backgroundNiceness = 5;

} // namespace

// Of Linux: POSIX knows only the niceness of a process.
void lowerThreadPriority() {
    ::setpriority(PRIO_PROCESS, id_t(::syscall(SYS_gettid)), backgroundNiceness);
}

} // namespace hermes
