#include "common/platform/Program.h"

#include "common/platform/WindowsError.h"

#include <algorithm>
#include <cstdlib>
#include <shellapi.h>
#include <sstream>
#include <stdexcept>

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

/// A file that another process can have as a standard stream, gone when it is closed. Not tmpfile(): that
/// wants to write to the root of the drive.
class TemporaryFile {
public:
    TemporaryFile() {
        wchar_t name[MAX_PATH] = L"";
        const fs::path folder = fs::temp_directory_path();
        SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
        if (::GetTempFileNameW(folder.c_str(), L"her", 0, name) != 0)
            file_ = ::CreateFileW(name, GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE,
                                  &inherited, CREATE_ALWAYS, FILE_FLAG_DELETE_ON_CLOSE, nullptr);
        if (file_ == INVALID_HANDLE_VALUE)
            throw std::runtime_error("a temporary file cannot be made: " + lastErrorText());
    }
    ~TemporaryFile() { ::CloseHandle(file_); }
    TemporaryFile(const TemporaryFile &) = delete;
    TemporaryFile &operator=(const TemporaryFile &) = delete;

    HANDLE handle() const { return file_; }
    void rewind() const { ::SetFilePointer(file_, 0, nullptr, FILE_BEGIN); }
    void write(const std::string &text) const {
        DWORD done = 0;
        if (!::WriteFile(file_, text.data(), DWORD(text.size()), &done, nullptr) || done != text.size())
            throw std::runtime_error("a temporary file cannot be written: " + lastErrorText());
        rewind();
    }
    std::string contents() const {
        std::string text;
        rewind();
        char buffer[4096];
        DWORD count = 0;
        while (::ReadFile(file_, buffer, sizeof buffer, &count, nullptr) && count > 0)
            text.append(buffer, count);
        return text;
    }

private:
    HANDLE file_ = INVALID_HANDLE_VALUE;
};

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

std::optional<ProgramEnd> runProgram(const std::string &name, const std::string &argument,
                                     const std::string &input) {
    const fs::path program = findProgram(name);
    if (program.empty())
        return std::nullopt;
    const TemporaryFile in, out, err;
    in.write(input);
    STARTUPINFOW start{};
    start.cb = sizeof start;
    start.dwFlags = STARTF_USESTDHANDLES;
    start.hStdInput = in.handle();
    start.hStdOutput = out.handle();
    start.hStdError = err.handle();
    std::wstring line = quoted(program.wstring()) + L' ' + quoted(fs::u8path(argument).wstring());
    PROCESS_INFORMATION child{};
    if (!::CreateProcessW(program.c_str(), line.data(), nullptr, nullptr, TRUE, CREATE_NO_WINDOW, nullptr,
                          nullptr, &start, &child))
        return std::nullopt;
    ::WaitForSingleObject(child.hProcess, INFINITE);
    DWORD status = 1;
    ::GetExitCodeProcess(child.hProcess, &status);
    ::CloseHandle(child.hThread);
    ::CloseHandle(child.hProcess);
    return ProgramEnd{status != 0, out.contents(), err.contents()};
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
