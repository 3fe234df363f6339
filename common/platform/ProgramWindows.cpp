#include "common/platform/Program.h"

#include "common/platform/WindowsError.h"

#include <shellapi.h>
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
    const TemporaryFile in, out, err;
    in.write(input);
    STARTUPINFOW start{};
    start.cb = sizeof start;
    start.dwFlags = STARTF_USESTDHANDLES;
    start.hStdInput = in.handle();
    start.hStdOutput = out.handle();
    start.hStdError = err.handle();
    std::wstring line = fs::u8path(name + ' ' + argument).wstring();
    PROCESS_INFORMATION child{};
    if (!::CreateProcessW(nullptr, line.data(), nullptr, nullptr, TRUE, CREATE_NO_WINDOW, nullptr, nullptr,
                          &start, &child))
        return std::nullopt;
    ::WaitForSingleObject(child.hProcess, INFINITE);
    DWORD status = 1;
    ::GetExitCodeProcess(child.hProcess, &status);
    ::CloseHandle(child.hThread);
    ::CloseHandle(child.hProcess);
    return ProgramEnd{status != 0, out.contents(), err.contents()};
}

} // namespace hermes
