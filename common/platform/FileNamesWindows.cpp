#include "common/platform/FileNames.h"

#include <algorithm>
#include <cwctype>
#include <windows.h>

namespace hermes {

bool isSameName(const std::filesystem::path &one, const std::filesystem::path &other) {
    const std::wstring left = one.wstring(), right = other.wstring();
    return ::CompareStringOrdinal(left.data(), int(left.size()), right.data(), int(right.size()), TRUE) ==
           CSTR_EQUAL;
}

// Also with endings and blanks behind it, as NUL.tar.gz: so do all versions before Windows 11.
bool isDeviceName(const std::filesystem::path &path) {
    std::wstring name = path.filename().wstring();
    name.erase(std::min(name.find(L'.'), name.size()));
    name.erase(name.find_last_not_of(L' ') + 1);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](wchar_t c) { return wchar_t(std::towupper(c)); });
    const bool isNumbered = name.size() == 4 && (name.rfind(L"COM", 0) == 0 || name.rfind(L"LPT", 0) == 0) &&
                            name[3] >= L'1' && name[3] <= L'9';
    const auto names = {L"NUL", L"CON", L"AUX", L"PRN", L"CONIN$", L"CONOUT$"};
    return isNumbered || std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace hermes
