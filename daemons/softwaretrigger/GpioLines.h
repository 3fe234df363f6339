#pragma once

#include "common/Result.h"

#include <QHash>
#include <QString>

namespace hermes::softwaretrigger {

/// Lines of GPIO chips as outputs, by the kernel's own interface. A line is taken, and low, from the first
/// use on.
class GpioLines {
public:
    /// chip: name, number or path; offset: of its line. DeviceFault names both.
    Result<void> set(const QString &chip, int offset, bool on);
    void close();
    ~GpioLines() { close(); }

private:
    QHash<QString, int> lines_; ///< their descriptors, by chip and offset
};

} // namespace hermes::softwaretrigger
