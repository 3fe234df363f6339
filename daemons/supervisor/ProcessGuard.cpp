#include "daemons/supervisor/ProcessGuard.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace hermes::supervisor {
namespace {

constexpr std::size_t maxGroups = 256;
constexpr int maxDescriptors = 4096;
constexpr timespec guardTimeout{2, 0};

/// Runs in the forked process: calls of the system only, for other threads may have held any lock.
[[noreturn]] void watch(int changes) {
    ::setsid(); // what a terminal sends is not for it
    prctl(PR_SET_NAME, "hermes-guard");
    for (const int number : {SIGTERM, SIGINT, SIGHUP})
        ::signal(number, SIG_IGN);
    ::dup2(changes, 0);
    if (::syscall(SYS_close_range, 1U, ~0U, 0U) != 0)
        for (int descriptor = 1; descriptor < maxDescriptors; ++descriptor)
            ::close(descriptor);
    std::array<pid_t, maxGroups> groups{};
    pid_t change = 0;
    for (ssize_t got; (got = ::read(0, &change, sizeof change)) != 0;) {
        if (got != sizeof change)
            continue; // interrupted
        const auto place = std::find(groups.begin(), groups.end(), change > 0 ? 0 : -change);
        if (place != groups.end())
            *place = std::max<pid_t>(change, 0);
    }
    if (std::any_of(groups.begin(), groups.end(), [](pid_t group) { return group > 1; }))
        ::nanosleep(&guardTimeout, nullptr);
    for (const pid_t group : groups)
        if (group > 1)
            ::kill(-group, SIGKILL);
    ::_exit(0);
}

} // namespace

ProcessGuard::ProcessGuard() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
        return;
    guard_ = ::fork();
    if (guard_ == 0)
        watch(ends[0]);
    ::close(ends[0]);
    pipe_ = ends[1];
    ::fcntl(pipe_, F_SETFL, O_NONBLOCK);
}

ProcessGuard::~ProcessGuard() {
    if (pipe_ >= 0)
        ::close(pipe_);
    if (guard_ > 0)
        ::waitpid(guard_, nullptr, 0);
}

void ProcessGuard::tell(pid_t change) const {
    if (pipe_ >= 0) // SIGPIPE is ignored (SignalWatcher), should the guard be killed
        (void)!::write(pipe_, &change, sizeof change);
}

} // namespace hermes::supervisor
