#include "gui/desktop/LayoutLock.h"

#include <QDir>
#include <QFileInfo>
#include <windows.h>

namespace hermes::desktop {

LayoutLock::~LayoutLock() {
    if (held_ >= 0)
        ::CloseHandle(reinterpret_cast<HANDLE>(held_));
}

// Who has a file open and shares it with nobody has it for itself.
bool LayoutLock::take() {
    if (held_ >= 0)
        return true;
    QDir().mkpath(QFileInfo(file_).absolutePath());
    const QString name = QDir::toNativeSeparators(file_);
    const HANDLE opened = ::CreateFileW(reinterpret_cast<const wchar_t *>(name.utf16()), GENERIC_WRITE, 0,
                                        nullptr, OPEN_ALWAYS, FILE_ATTRIBUTE_NORMAL, nullptr);
    if (opened == INVALID_HANDLE_VALUE)
        return ::GetLastError() != ERROR_SHARING_VIOLATION;
    held_ = reinterpret_cast<std::intptr_t>(opened);
    return true;
}

} // namespace hermes::desktop
