#pragma once

#include <QString>

namespace hermes {

/// How long a USB serial adapter (FTDI) holds received bytes before it hands them on: its latency timer, by
/// default 16 ms, which every answer of a device then takes.
struct AdapterLatency {
    int milliseconds =
        0;          ///< 0: the device has no such timer, as real ports, CDC-ACM devices and pseudo-terminals
    QString advice; ///< why it is not 1 and what to do; empty when it is, or there is none

    /// Reads that of a device ("/dev/ttyUSB0", links are followed) and sets it to 1 ms where that is
    /// permitted. system: where sysfs is.
    static AdapterLatency lower(const QString &device, const QString &system = QStringLiteral("/sys"));
};

} // namespace hermes
