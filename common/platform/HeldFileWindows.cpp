#include "common/platform/HeldFile.h"

#include "common/platform/WindowsError.h"

#include <fcntl.h>
#include <filesystem>
#include <io.h>
#include <random>
#include <vector>

namespace hermes {

namespace {

namespace fs = std::filesystem;

/// Marked for deletion as long as it is not complete: it ends with the last handle, whatever ends the
/// process.
class MarkedFile : public HeldFile {
public:
    explicit MarkedFile(const fs::path &path)
        : path_(fs::absolute(path)) {
        std::random_device random;
        for (int attempt = 0; attempt < 100 && !isThere(); ++attempt) {
            const fs::path name = path_.wstring() + L".part-" + std::to_wstring(random());
            file_ = ::CreateFileW(name.c_str(), GENERIC_WRITE | DELETE, FILE_SHARE_DELETE, nullptr,
                                  CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr);
            if (!isThere() && ::GetLastError() != ERROR_FILE_EXISTS)
                return;
        }
        mark(true);
    }
    ~MarkedFile() override {
        if (isThere())
            ::CloseHandle(file_);
    }

    bool isThere() const { return file_ != INVALID_HANDLE_VALUE; }
    std::FILE *open() override {
        HANDLE copy = nullptr;
        const HANDLE process = ::GetCurrentProcess();
        if (!::DuplicateHandle(process, file_, process, &copy, 0, FALSE, DUPLICATE_SAME_ACCESS))
            return nullptr;
        const int descriptor = ::_open_osfhandle(reinterpret_cast<std::intptr_t>(copy), _O_BINARY);
        if (descriptor < 0)
            ::CloseHandle(copy);
        return descriptor < 0 ? nullptr : ::_fdopen(descriptor, "wb");
    }
    Outcome<void> putInPlace(bool replace) override {
        if (mark(false) && rename(replace))
            return {};
        std::string why = lastErrorText();
        mark(true);
        return why;
    }

private:
    bool mark(bool deleted) const {
        FILE_DISPOSITION_INFO info{};
        info.DeleteFile = BOOLEAN(deleted);
        return ::SetFileInformationByHandle(file_, FileDispositionInfo, &info, sizeof info) != 0;
    }
    bool rename(bool replace) const {
        const std::wstring name = path_.wstring();
        std::vector<unsigned char> memory(sizeof(FILE_RENAME_INFO) + name.size() * sizeof(wchar_t));
        auto *info = reinterpret_cast<FILE_RENAME_INFO *>(memory.data());
        info->ReplaceIfExists = BOOLEAN(replace);
        info->FileNameLength = DWORD(name.size() * sizeof(wchar_t));
        name.copy(info->FileName, name.size());
        return ::SetFileInformationByHandle(file_, FileRenameInfo, info, DWORD(memory.size())) != 0;
    }

    const fs::path path_;
    HANDLE file_ = INVALID_HANDLE_VALUE;
};

} // namespace

Outcome<std::unique_ptr<HeldFile>> HeldFile::make(const std::string &path) {
    auto file = std::make_unique<MarkedFile>(fs::u8path(path));
    if (!file->isThere())
        return lastErrorText();
    return std::unique_ptr<HeldFile>(std::move(file));
}

} // namespace hermes
