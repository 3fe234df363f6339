#include "common/platform/Console.h"

#include <cstdlib>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace hermes {

bool isTerminal(StandardStream stream) {
    const int descriptor = stream == StandardStream::Input    ? STDIN_FILENO
                           : stream == StandardStream::Output ? STDOUT_FILENO
                                                              : STDERR_FILENO;
    return ::isatty(descriptor) != 0;
}

int terminalWidth() {
    const char *const columns = std::getenv("COLUMNS");
    if (const int told = columns != nullptr ? std::atoi(columns) : 0; told > 0)
        return told;
    winsize size{};
    return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? int(size.ws_col) : 80;
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
