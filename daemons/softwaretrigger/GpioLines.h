#pragma once

#include "common/Result.h"

#include <QHash>
#include <QString>

struct gpiod_chip;
struct gpiod_line;

namespace hermes::softwaretrigger {

/// Lines of GPIO chips as outputs, by libgpiod, which is optional at build time. A line is taken, and low,
/// from the first use on.
class GpioLines {
public:
    static bool isAvailable();

    /// chip: name, number or path; offset: of its line. DeviceFault names both.
    Result<void> set(const QString &chip, int offset, bool on);
    void close();
    ~GpioLines() { close(); }

private:
    struct Line {
        gpiod_chip *chip = nullptr;
        gpiod_line *line = nullptr;
    };
    Result<Line> take(const QString &chip, int offset);
    QHash<QString, Line> lines_;
};

} // namespace hermes::softwaretrigger
