#pragma once

#include "common/Result.h"
#include "common/interface/Interface.h"
#include "common/interface/InterfaceUrl.h"

#include <QSerialPort>

namespace hermes {

/// A serial line. The URL names the device and its settings: `serial:///dev/ttyS1?baud=115200` with
/// `data_bits=8` (5 to 8), `parity=none` (even, odd), `stop_bits=1` (or 2), `flow=none` (hardware, software).
/// A radio that sends more slowly than its line says so: `pace=19200`, in bits a second.
/// A link such as those in /dev/serial/by-path is followed at each opening, so that with reconnecting on a
/// device that was pulled is found again under its new name. What came before the opening is dropped.
class SerialInterface : public Interface {
    Q_OBJECT
public:
    SerialInterface(const InterfaceUrl &address, QObject *parent);

    QString name() const override { return url_.toString(); }
    void flush() override { port_.flush(); }
    qint64 bytesToWrite() const override { return port_.bytesToWrite(); }
    qint64 bytesInSystem() const override;
    double bytesPerSecond() const override;
    /// Of the driver: "overrun" (bytes that came too fast), "buffer_overrun", "framing", "parity", "break".
    QMap<QString, quint64> systemErrors() const override;

    /// The lines of the port that a program may drive by itself.
    enum class Signal { Rts, Dtr };
    /// Raises or lowers one at once. NotReady when the port is not open, DeviceFault when it has no such
    /// line.
    Result<void> setSignal(Signal signal, bool on);

protected:
    void doOpen() override;
    void doClose() override;
    bool doWrite(const QByteArray &bytes) override { return port_.write(bytes) == bytes.size(); }

private:
    /// Takes the settings from the URL; gives what is wrong with them, or an empty text.
    QString configure();
    void fail(QSerialPort::SerialPortError error);
    QMap<QString, quint64> driverErrors() const;

    InterfaceUrl url_;
    mutable QSerialPort port_; // handle() is not const
    QMap<QString, quint64> errorsAtOpening_;
};

} // namespace hermes
