#include "daemons/supervisor/SerialCandidates.h"

#include <QDir>
#include <QFileInfo>
#include <QSerialPortInfo>
#include <algorithm>

namespace hermes::supervisor {
namespace {

constexpr quint16 controllerVendor = 0x03eb, controllerProduct = 0x2404; // RoboClaws on USB

bool isKnown(const std::vector<SerialCandidate> &known, const QString &device) {
    return std::any_of(known.begin(), known.end(),
                       [&device](const SerialCandidate &one) { return one.device == device; });
}

} // namespace

QString stableName(const QString &device) {
    // By the socket it is plugged into: two adapters may tell one serial number, and share its link.
    for (const char *folder : {"/dev/hermes", "/dev/serial/by-path", "/dev/serial/by-id"})
        for (const QFileInfo &link : QDir(folder).entryInfoList(QDir::Files | QDir::System, QDir::Name))
            if (link.canonicalFilePath() == device)
                return link.filePath();
    return device;
}

std::vector<SerialCandidate> serialCandidates(const QStringList &others) {
    std::vector<SerialCandidate> candidates;
    for (const QSerialPortInfo &port : QSerialPortInfo::availablePorts()) {
        const QString device = QFileInfo(port.systemLocation()).canonicalFilePath();
        if (device.isEmpty() || isKnown(candidates, device))
            continue;
        const QString about = (port.manufacturer() + ' ' + port.description()).simplified();
        const bool isController =
            port.vendorIdentifier() == controllerVendor && port.productIdentifier() == controllerProduct;
        candidates.push_back({stableName(device), device, about, isController});
    }
    for (const QString &other : others) {
        const QString device = QFileInfo(other).canonicalFilePath();
        if (device.isEmpty() || isKnown(candidates, device))
            continue;
        const QString name = stableName(device);
        candidates.push_back({name == device ? other : name, device, {}, false});
    }
    return candidates;
}

} // namespace hermes::supervisor
