#include "common/platform/Pipes.h"

#include <csignal>
#include <poll.h>

namespace hermes {

void outliveClosedPipes() {
    std::signal(SIGPIPE, SIG_IGN);
}

bool isOtherEndGone(std::FILE *stream) {
    pollfd end{::fileno(stream), 0, 0};
    return ::poll(&end, 1, 0) > 0 && (end.revents & (POLLERR | POLLHUP)) != 0;
}

bool takesMore(std::FILE *stream) {
    pollfd end{::fileno(stream), POLLOUT, 0};
    return ::poll(&end, 1, 0) > 0;
}

std::FILE *streamInto(int descriptor) {
    return ::fdopen(descriptor, "wb");
}

} // namespace hermes
