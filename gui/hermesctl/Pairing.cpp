#include "gui/hermesctl/Pairing.h"

namespace hermes::ctl {

Result<PairingAddress> PairingAddress::parse(const QString &text) {
    PairingAddress made;
    QString port;
    if (text.startsWith(QLatin1Char('['))) {
        made.host = text.mid(1).section(QLatin1Char(']'), 0, 0);
        port = text.section(QLatin1Char(']'), 1);
    } else if (text.count(QLatin1Char(':')) == 1) {
        made.host = text.section(QLatin1Char(':'), 0, 0);
        port = QLatin1Char(':') + text.section(QLatin1Char(':'), 1);
    } else {
        made.host = text;
    }
    bool isPort = port.isEmpty();
    if (!isPort && port.startsWith(QLatin1Char(':'))) {
        made.port = port.mid(1).toUShort(&isPort);
        isPort = isPort && made.port > 0;
    }
    if (made.host.isEmpty() || !isPort)
        return Error(ErrorCode::InvalidParams,
                     QStringLiteral("\"%1\", expected HOST or HOST:PORT").arg(text.left(80)));
    return made;
}

QString PairingAddress::text() const {
    const bool isSix = host.contains(QLatin1Char(':'));
    if (port == usualPairingPort)
        return host;
    return (isSix ? QStringLiteral("[%1]:%2") : QStringLiteral("%1:%2")).arg(host).arg(port);
}

} // namespace hermes::ctl
