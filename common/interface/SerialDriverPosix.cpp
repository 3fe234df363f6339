#include "common/interface/SerialDriver.h"

#include <QFileInfo>
#include <cerrno>
#include <cstring>
#include <linux/serial.h>
#include <sys/ioctl.h>

namespace hermes {

QString serialDevice(const QString &path) {
    return QFileInfo(path).canonicalFilePath();
}

// Of Linux.
QMap<QString, quint64> serialErrors(SerialHandle port) {
    serial_icounter_struct driver{};
    if (::ioctl(port, TIOCGICOUNT, &driver) != 0)
        return {};
    return {{QStringLiteral("overrun"), quint64(driver.overrun)},
            {QStringLiteral("buffer_overrun"), quint64(driver.buf_overrun)},
            {QStringLiteral("framing"), quint64(driver.frame)},
            {QStringLiteral("parity"), quint64(driver.parity)},
            {QStringLiteral("break"), quint64(driver.brk)}};
}

qint64 serialBytesWaiting(SerialHandle port) {
    int bytes = 0;
    return ::ioctl(port, TIOCOUTQ, &bytes) == 0 ? bytes : 0;
}

QString setSerialLine(SerialHandle port, SerialLine line, bool on) {
    const int bit = line == SerialLine::Rts ? TIOCM_RTS : TIOCM_DTR;
    const bool done = ::ioctl(port, on ? TIOCMBIS : TIOCMBIC, &bit) == 0;
    return done ? QString() : QString::fromLocal8Bit(std::strerror(errno));
}

} // namespace hermes
