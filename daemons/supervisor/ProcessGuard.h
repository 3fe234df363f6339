#pragma once

#include <sys/types.h>

namespace hermes::supervisor {

/// A process of its own that outlives the supervisor when that is killed: it then kills the process groups
/// that are left after 2 s. SIGTERM, which they got with the death of the supervisor, they may ignore.
class ProcessGuard {
public:
    /// Where it cannot begin, there is none.
    ProcessGuard();
    /// The groups that are left are the business of others.
    ~ProcessGuard();
    ProcessGuard(const ProcessGuard &) = delete;
    ProcessGuard &operator=(const ProcessGuard &) = delete;

    void add(pid_t group) { tell(group); }
    void remove(pid_t group) { tell(-group); }

private:
    void tell(pid_t change) const;

    pid_t guard_ = -1;
    int pipe_ = -1;
};

} // namespace hermes::supervisor
