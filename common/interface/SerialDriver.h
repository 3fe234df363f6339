#pragma once

#include <QMap>
#include <QSerialPort>
#include <QString>
#include <utility>

namespace hermes {

// What QSerialPort does not tell of the driver of a port that is open.

/// QSerialPort's own name for it is private.
using SerialHandle = decltype(std::declval<QSerialPort &>().handle());

/// The device that a path means, links followed; empty where there is none. On Windows the name of the port.
QString serialDevice(const QString &path);

/// Errors since the driver was loaded: "overrun" (bytes that came too fast), "buffer_overrun", "framing",
/// "parity", "break". Empty where it does not count, as a pseudo-terminal and Windows.
QMap<QString, quint64> serialErrors(SerialHandle port);

/// Bytes that the system has, but has not sent as yet.
qint64 serialBytesWaiting(SerialHandle port);

enum class SerialLine { Rts, Dtr };
/// Raises or lowers one; gives what went wrong, or an empty text. Not by QSerialPort: for it a port without
/// such lines is a failure of the whole port.
QString setSerialLine(SerialHandle port, SerialLine line, bool on);

} // namespace hermes
