#pragma once

#include <QtGlobal>
#include <optional>

namespace hermes::supervisor {

/// What a process has used so far, from /proc (proc(5)).
struct ProcessUsage {
    double cpu_s = 0;        ///< user and system time of all its threads
    qint64 memory_bytes = 0; ///< resident

    /// Absent: there is no such process.
    static std::optional<ProcessUsage> of(qint64 pid);
};

} // namespace hermes::supervisor
