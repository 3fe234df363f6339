#include "common/platform/Console.h"

#include <cstdlib>
#include <fcntl.h>
#include <initializer_list>
#include <io.h>
#include <windows.h>

namespace hermes {

namespace {

HANDLE handleOf(StandardStream stream) {
    return ::GetStdHandle(stream == StandardStream::Input    ? STD_INPUT_HANDLE
                          : stream == StandardStream::Output ? STD_OUTPUT_HANDLE
                                                             : STD_ERROR_HANDLE);
}

} // namespace

// Not isatty(): that takes the device NUL for a terminal.
bool isTerminal(StandardStream stream) {
    DWORD mode = 0;
    return ::GetConsoleMode(handleOf(stream), &mode) != 0;
}

int terminalWidth() {
    const char *const columns = std::getenv("COLUMNS");
    if (const int told = columns != nullptr ? std::atoi(columns) : 0; told > 0)
        return told;
    CONSOLE_SCREEN_BUFFER_INFO info{};
    return ::GetConsoleScreenBufferInfo(handleOf(StandardStream::Output), &info) != 0
               ? info.srWindow.Right - info.srWindow.Left + 1
               : 80;
}

void prepareConsole() {
    for (const int descriptor : {0, 1, 2})
        ::_setmode(descriptor, _O_BINARY);
    ::SetConsoleOutputCP(CP_UTF8);
    for (const StandardStream stream : {StandardStream::Output, StandardStream::Errors}) {
        DWORD mode = 0;
        if (::GetConsoleMode(handleOf(stream), &mode) != 0)
            ::SetConsoleMode(handleOf(stream), mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
    }
}

} // namespace hermes
