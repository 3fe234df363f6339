#include "common/Project.h"

#include <QStringList>

namespace hermes {
namespace {

struct KnownDaemon {
    const char *name;
    quint16 port;
};

// docs/protocol.md, default ports.
const KnownDaemon knownDaemons[] = {
    {"supervisor", 7400},   {"motorcontrol", 7410},    {"velodynelogger", 7420},
    {"seriallogger", 7430}, {"softwaretrigger", 7440}, {"scanmatcher", 7450},
    {"recorder", 7460},     {"scanner", 7470},         {"web", 7475},
    {"ros2", 7480},         {"simulator", 7490},
};

} // namespace

QString projectVersion() {
    return QStringLiteral(HERMES_VERSION);
}

QString protocolVersion() {
    return QStringLiteral("1.0");
}

quint16 defaultPort(const QString &daemonName) {
    for (const KnownDaemon &known : knownDaemons) {
        if (daemonName == QLatin1String(known.name))
            return known.port;
    }
    return 0;
}

QStringList daemonNames() {
    QStringList names;
    for (const KnownDaemon &known : knownDaemons)
        names.append(QLatin1String(known.name));
    return names;
}

} // namespace hermes
