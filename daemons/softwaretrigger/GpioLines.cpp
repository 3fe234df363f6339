#include "daemons/softwaretrigger/GpioLines.h"

#include <QFileInfo>
#include <QTimer>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace hermes::softwaretrigger {

void Pulses::start(const QString &line, double length_s, const Set &set, const Done &done) {
    if (active_.contains(line))
        return done(Error(ErrorCode::NotReady, line + ": a pulse is under way"));
    const auto on = set(true);
    if (!on)
        return done(on.error());
    active_.insert(line);
    QTimer::singleShot(std::chrono::milliseconds(qint64(std::ceil(length_s * 1000))), Qt::PreciseTimer, this,
                       [this, line, set, done] {
                           active_.remove(line);
                           const auto off = set(false);
                           done(off ? Result<QJsonValue>(QJsonValue()) : Result<QJsonValue>(off.error()));
                       });
}

namespace {

QString chipPath(const QString &chip) {
    bool isNumber = false;
    chip.toUInt(&isNumber);
    return chip.startsWith('/') ? chip : (isNumber ? "/dev/gpiochip" : "/dev/") + chip;
}

/// A descriptor, or -1. What is no GPIO chip is not opened: that alone may start a device, as a watchdog.
int openChip(const QByteArray &path) {
    struct stat status {};
    if (::stat(path.constData(), &status) != 0)
        return -1;
    const auto subsystem =
        QString("/sys/dev/char/%1:%2/subsystem").arg(major(status.st_rdev)).arg(minor(status.st_rdev));
    if (!S_ISCHR(status.st_mode) ||
        QFileInfo(QFileInfo(subsystem).canonicalFilePath()).fileName() != "gpio") {
        errno = ENODEV;
        return -1;
    }
    return ::open(path.constData(), O_RDWR | O_CLOEXEC);
}

bool setLine(int line, bool on) {
    gpio_v2_line_values values{};
    values.bits = on;
    values.mask = 1;
    return ::ioctl(line, GPIO_V2_LINE_SET_VALUES_IOCTL, &values) == 0;
}

} // namespace

Result<void> GpioLines::set(const QString &chip, int offset, bool on) {
    const auto failed = [&](const char *what) {
        return Error(ErrorCode::DeviceFault, QString("GPIO chip %1, line %2: %3: %4")
                                                 .arg(chip)
                                                 .arg(offset)
                                                 .arg(what, QString::fromLocal8Bit(std::strerror(errno))));
    };
    const QString key = QString("%1 %2").arg(chip).arg(offset);
    if (!lines_.contains(key)) {
        const int device = openChip(chipPath(chip).toLocal8Bit());
        if (device < 0)
            return failed("cannot open the chip");
        gpio_v2_line_request request{};
        request.offsets[0] = unsigned(offset);
        request.num_lines = 1;
        request.config.flags = GPIO_V2_LINE_FLAG_OUTPUT;
        std::strcpy(request.consumer, "hermes");
        const bool isTaken = ::ioctl(device, GPIO_V2_GET_LINE_IOCTL, &request) == 0;
        const Error error = failed(errno == EINVAL ? "there is no such line" : "cannot take the line");
        ::close(device);
        if (!isTaken)
            return error;
        lines_.insert(key, request.fd);
    }
    return setLine(lines_.value(key), on) ? Result<void>() : failed("cannot set");
}

void GpioLines::close() {
    for (const int line : qAsConst(lines_)) {
        setLine(line, false);
        ::close(line);
    }
    lines_.clear();
}

} // namespace hermes::softwaretrigger
