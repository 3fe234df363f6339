#pragma once

#include <QString>
#include <cstdint>

namespace hermes::desktop {

/// Which of the windows writes a file: it holds a lock beside the file, which ends with its process at the
/// latest.
class LayoutLock {
public:
    explicit LayoutLock(const QString &file)
        : file_(file + ".window") {} // QSettings has a ".lock" of its own
    ~LayoutLock();

    LayoutLock(const LayoutLock &) = delete;
    LayoutLock &operator=(const LayoutLock &) = delete;

    /// False: another window holds it. Where nothing can be locked, nobody does.
    bool take();

private:
    const QString file_;
    std::intptr_t held_ = -1; ///< descriptor, or handle of Windows
};

} // namespace hermes::desktop
