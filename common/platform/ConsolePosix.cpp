#include "common/platform/Console.h"

#include <fcntl.h>
#include <unistd.h>

namespace hermes {

bool isTerminal(StandardStream stream) {
    const int descriptor = stream == StandardStream::Input    ? STDIN_FILENO
                           : stream == StandardStream::Output ? STDOUT_FILENO
                                                              : STDERR_FILENO;
    return ::isatty(descriptor) != 0;
}

void prepareConsole() {
    if (::fcntl(STDERR_FILENO, F_GETFD) >= 0)
        return;
    const int nowhere = ::open("/dev/null", O_WRONLY);
    if (nowhere < 0 || nowhere == STDERR_FILENO)
        return;
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
}

} // namespace hermes
