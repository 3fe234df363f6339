#include "daemons/softwaretrigger/GpioLines.h"

#include <cerrno>
#include <cstring>
#include <gpiod.h>

namespace hermes::softwaretrigger {

bool GpioLines::isAvailable() {
    return true;
}

Result<GpioLines::Line> GpioLines::take(const QString &chip, int offset) {
    const auto failed = [&](const char *what) {
        return Error(ErrorCode::DeviceFault, QString("GPIO chip %1, line %2: %3: %4")
                                                 .arg(chip)
                                                 .arg(offset)
                                                 .arg(what, QString::fromLocal8Bit(std::strerror(errno))));
    };
    Line result;
    result.chip = ::gpiod_chip_open_lookup(chip.toLocal8Bit().constData());
    if (!result.chip)
        return failed("cannot open the chip");
    result.line = ::gpiod_chip_get_line(result.chip, unsigned(offset));
    if (!result.line || ::gpiod_line_request_output(result.line, "hermes", 0) != 0) {
        const Error error = failed(result.line ? "cannot take the line" : "there is no such line");
        ::gpiod_chip_close(result.chip);
        return error;
    }
    return result;
}

Result<void> GpioLines::set(const QString &chip, int offset, bool on) {
    const QString key = QString("%1 %2").arg(chip).arg(offset);
    if (!lines_.contains(key)) {
        auto taken = take(chip, offset);
        if (!taken)
            return taken.error();
        lines_.insert(key, *taken);
    }
    if (::gpiod_line_set_value(lines_.value(key).line, on) != 0)
        return Error(ErrorCode::DeviceFault, QString("GPIO chip %1, line %2: cannot set: %3")
                                                 .arg(chip)
                                                 .arg(offset)
                                                 .arg(QString::fromLocal8Bit(std::strerror(errno))));
    return {};
}

void GpioLines::close() {
    for (const Line &line : qAsConst(lines_)) {
        ::gpiod_line_set_value(line.line, 0);
        ::gpiod_chip_close(line.chip);
    }
    lines_.clear();
}

} // namespace hermes::softwaretrigger
