#pragma once

#include <QString>

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
    int held_ = -1; ///< descriptor
};

} // namespace hermes::desktop
