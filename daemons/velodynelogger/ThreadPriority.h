#pragma once

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace hermes::velodynelogger {

/// The calling thread comes before others of the host, as receiving and writing must on a busy board. Without
/// the privilege (CAP_SYS_NICE, or LimitNICE of the service) it stays as it is.
inline void preferThisThread() {
    ::setpriority(PRIO_PROCESS, id_t(::syscall(SYS_gettid)), -15);
}

} // namespace hermes::velodynelogger
