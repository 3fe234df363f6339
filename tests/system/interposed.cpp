// Loaded before the C library (LD_PRELOAD) by tests of what befalls programs that know nothing of it:
// HERMES_CLOCK names a file of one 64-bit number, the seconds by which the wall clock is ahead from now on;
// HERMES_KILL_AT=N kills the program when it gives a file a name for the Nth time.
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

const volatile std::int64_t *mapped(const char *path) {
    static const std::int64_t none = 0;
    const int file = path ? ::open(path, O_RDONLY | O_CLOEXEC) : -1;
    if (file < 0)
        return &none;
    void *const memory = ::mmap(nullptr, sizeof(std::int64_t), PROT_READ, MAP_SHARED, file, 0);
    ::close(file);
    return memory == MAP_FAILED ? &none : static_cast<const std::int64_t *>(memory);
}

std::int64_t ahead_s() {
    static const volatile std::int64_t *const seconds = mapped(std::getenv("HERMES_CLOCK"));
    return *seconds;
}

void name() {
    static const char *const at = std::getenv("HERMES_KILL_AT");
    static long left = at ? std::atol(at) : 0;
    if (left > 0 && --left == 0)
        ::raise(SIGKILL);
}

} // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec *time) noexcept {
    const long failed = ::syscall(SYS_clock_gettime, clock, time);
    if (failed == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
        time->tv_sec += ahead_s();
    return int(failed);
}

int gettimeofday(timeval *time, void *zone) noexcept {
    const long failed = ::syscall(SYS_gettimeofday, time, zone);
    if (failed == 0)
        time->tv_sec += ahead_s();
    return int(failed);
}

time_t time(time_t *result) noexcept {
    timespec now{};
    clock_gettime(CLOCK_REALTIME_COARSE, &now);
    return result ? *result = now.tv_sec : now.tv_sec;
}

int rename(const char *from, const char *to) noexcept {
    name();
    return int(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

int linkat(int fromFolder, const char *from, int toFolder, const char *to, int flags) noexcept {
    name();
    return int(::syscall(SYS_linkat, fromFolder, from, toFolder, to, flags));
}

} // extern "C"
