#include "gui/setup/SetupText.h"

#include "common/settings/DottedPath.h"
#include "protocol/wire/JsonText.h"

namespace hermes {

std::vector<QStringList> rowsOf(const Findings &found, const QString &howToAsk) {
    std::vector<QStringList> rows;
    for (const FoundSerial &line : found.serial) {
        QStringList details{line.text};
        if (line.baud > 0)
            details.append(QString("%1 baud").arg(line.baud));
        if (line.anyAddress)
            details.append("any address");
        else
            for (const int address : line.addresses)
                details.append(QString("address %1").arg(address));
        if (line.kind == "not_asked")
            details.append(QString("silent; %1 asks it what it is, wheels off the ground").arg(howToAsk));
        if (line.simulated)
            details.append("of the simulator");
        details.append(line.about);
        details.removeAll(QString());
        rows.push_back({line.kind, line.path, details.join(", ")});
    }
    for (const FoundLidar &lidar : found.lidars)
        rows.push_back({"lidar", lidar.address,
                        QString("%1, %2 packets a second at UDP port %3%4")
                            .arg(lidar.model.isEmpty() ? "unknown model" : lidar.model)
                            .arg(lidar.rate_hz)
                            .arg(lidar.port)
                            .arg(lidar.simulated ? ", of the simulator" : "")});
    for (const QString &problem : found.problems)
        rows.push_back({"problem", "-", problem});
    return rows;
}

std::vector<SettingChange> changesOf(const QJsonObject &settings) {
    std::vector<SettingChange> changes;
    for (const QString &daemon : settings.keys())
        for (const QString &path : leafPaths(settings[daemon].toObject()))
            changes.push_back({daemon,
                               path,
                               {},
                               QString::fromUtf8(compactJson(valueAt(settings[daemon].toObject(), path)))});
    return changes;
}

} // namespace hermes
