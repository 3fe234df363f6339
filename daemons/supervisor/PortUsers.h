#pragma once

#include <QString>

namespace hermes::supervisor {

/// Who uses a device or a UDP port, as far as the system tells this user (proc(5)).
namespace PortUsers {

/// "hermes-motorcontrol (process 123)" of who has the device open or has locked it, "the console of this
/// computer"; empty: nobody that is known. device: its real path. Of a pseudo-terminal the far end does not
/// count.
QString ofDevice(const QString &device);

/// The same of who receives at a UDP port.
QString ofUdpPort(quint16 port);

/// Whether this process is at the far end of a pseudo-terminal, as a simulator is.
bool holdsFarEnd(qint64 pid, const QString &device);

/// Whether this process has a serial line open, or receives at one of these UDP ports.
bool usesPorts(qint64 pid, const QList<quint16> &udpPorts);

} // namespace PortUsers

} // namespace hermes::supervisor
