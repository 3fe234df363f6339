#include "common/interface/Descriptors.h"

#include <algorithm>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace hermes {
namespace {

rlimit descriptorLimit() {
    rlimit limit{};
    return ::getrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit : rlimit{1024, 1024};
}

} // namespace

void raiseDescriptorLimit(int clients) {
    constexpr rlim_t ofOthers = 256;
    rlimit limit = descriptorLimit();
    const rlim_t wanted = std::min(limit.rlim_max, rlim_t(clients) + ofOthers);
    if (limit.rlim_cur >= wanted)
        return;
    limit.rlim_cur = wanted;
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

int descriptorsLeft() {
    const int next = ::open("/", O_PATH | O_CLOEXEC);
    if (next < 0)
        return 0;
    ::close(next);
    return descriptorsLeftAfter(next) + 1;
}

int descriptorsLeftAfter(qintptr descriptor) {
    constexpr rlim_t many = 1 << 20; // of one without a limit
    return int(std::min(descriptorLimit().rlim_cur, many)) - 1 - int(descriptor);
}

} // namespace hermes
