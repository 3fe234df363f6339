#pragma once

#include <QString>
#include <QStringList>
#include <vector>

namespace hermes::supervisor {

/// A serial line that may lead to a device.
struct SerialCandidate {
    QString path;              ///< that stays the same, where there is such a one
    QString device;            ///< the real one
    QString about;             ///< what the system knows of the adapter
    bool isController = false; ///< on USB it says that it is a RoboClaw
};

/// The serial lines of this computer, and those of others that exist: paths such as the links of simulated
/// devices.
std::vector<SerialCandidate> serialCandidates(const QStringList &others);

/// The name of a device that stays the same: its link in /dev/hermes, /dev/serial/by-path or
/// /dev/serial/by-id; else the device.
QString stableName(const QString &device);

} // namespace hermes::supervisor
