#include "common/platform/Program.h"

#include "common/platform/WindowsError.h" // the header of Windows, which the next needs

#include <algorithm>
#include <cstdlib>
#include <shellapi.h>
#include <sstream>

namespace hermes {

namespace {

namespace fs = std::filesystem;

std::string utf8(const wchar_t *text) {
    const int size = ::WideCharToMultiByte(CP_UTF8, 0, text, -1, nullptr, 0, nullptr, nullptr);
    if (size <= 1)
        return {};
    std::string result(std::size_t(size), '\0');
    ::WideCharToMultiByte(CP_UTF8, 0, text, -1, result.data(), size, nullptr, nullptr);
    result.pop_back(); // the null
    return result;
}

/// Of the folders of PATH that are told from the root on; empty: it is in none. CreateProcess() would take
/// one of the current folder first.
fs::path findProgram(const std::string &name) {
    const wchar_t *const path = ::_wgetenv(L"PATH");
    std::wistringstream folders(path ? path : L"");
    for (std::wstring folder; std::getline(folders, folder, L';');) {
        folder.erase(std::remove(folder.begin(), folder.end(), L'"'), folder.end());
        fs::path file = folder;
        file /= fs::u8path(name + ".exe");
        std::error_code ignored;
        if (file.is_absolute() && fs::is_regular_file(file, ignored))
            return file;
    }
    return {};
}

/// As one word of a command line, of which CommandLineToArgvW() makes the same text.
std::wstring quoted(const std::wstring &text) {
    std::wstring result = L"\"";
    std::size_t backslashes = 0; // before this character; they count twice before a quotation mark
    for (const wchar_t c : text) {
        if (c == L'"')
            result.append(backslashes + 1, L'\\');
        backslashes = c == L'\\' ? backslashes + 1 : 0;
        result += c;
    }
    return result.append(backslashes, L'\\') + L'"';
}

} // namespace

std::vector<std::string> programArguments(int, char **) {
    std::vector<std::string> result;
    int count = 0;
    wchar_t **const arguments = ::CommandLineToArgvW(::GetCommandLineW(), &count);
    for (int i = 1; i < count; ++i)
        result.push_back(utf8(arguments[i]));
    ::LocalFree(arguments);
    return result;
}

fs::path programFile() {
    std::wstring name(32768, L'\0'); // the longest there is
    name.resize(::GetModuleFileNameW(nullptr, name.data(), DWORD(name.size())));
    return name;
}

void becomeProgram(const std::string &name, const std::vector<std::string> &arguments) {
    const fs::path own = fs::u8path(name);
    const fs::path program = own.has_parent_path() ? fs::u8path(name + ".exe") : findProgram(name);
    std::wstring line = quoted(program.wstring());
    for (const std::string &argument : arguments)
        line += L' ' + quoted(fs::u8path(argument).wstring());
    STARTUPINFOW start{};
    start.cb = sizeof start;
    PROCESS_INFORMATION child{};
    if (program.empty() || !::CreateProcessW(program.c_str(), line.data(), nullptr, nullptr, TRUE, 0, nullptr,
                                             nullptr, &start, &child))
        return;
    ::WaitForSingleObject(child.hProcess, INFINITE);
    DWORD status = 1;
    ::GetExitCodeProcess(child.hProcess, &status);
    ::ExitProcess(status);
}

} // namespace hermes
