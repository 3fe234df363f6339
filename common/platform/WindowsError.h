#pragma once

#include <string>
#include <windows.h>

namespace hermes {

/// What GetLastError() means, without the full stop.
inline std::string lastErrorText() {
    const DWORD code = ::GetLastError();
    char text[512] = "";
    DWORD size = ::FormatMessageA(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS, nullptr, code,
                                  MAKELANGID(LANG_ENGLISH, SUBLANG_ENGLISH_US), text, sizeof text, nullptr);
    while (size > 0 && (text[size - 1] == '\n' || text[size - 1] == '\r' || text[size - 1] == '.'))
        --size;
    return size > 0 ? std::string(text, size) : "error " + std::to_string(code);
}

} // namespace hermes
