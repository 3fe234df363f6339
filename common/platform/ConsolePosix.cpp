#include "common/platform/Console.h"

#include <unistd.h>

namespace hermes {

bool isTerminal(StandardStream stream) {
    const int descriptor = stream == StandardStream::Input    ? STDIN_FILENO
                           : stream == StandardStream::Output ? STDOUT_FILENO
                                                              : STDERR_FILENO;
    return ::isatty(descriptor) != 0;
}

void prepareConsole() {}

} // namespace hermes
