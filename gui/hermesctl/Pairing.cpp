#include "gui/hermesctl/Pairing.h"

namespace hermes::ctl {

Result<PairingAddress> PairingAddress::parse(const QString &text) {
    PairingAddress made;
    QString port;
    if (text.startsWith('[')) {
        made.host = text.mid(1).section(']', 0, 0);
        port = text.section(']', 1);
    } else if (text.count(':') == 1) {
        made.host = text.section(':', 0, 0);
        port = ':' + text.section(':', 1);
    } else {
        made.host = text;
    }
    bool isPort = port.isEmpty();
    if (!isPort && port.startsWith(':')) {
        made.port = port.mid(1).toUShort(&isPort);
        isPort = isPort && made.port > 0;
    }
    if (made.host.isEmpty() || !isPort)
        return Error(ErrorCode::InvalidParams,
                     QString("\"%1\", expected HOST or HOST:PORT").arg(text.left(80)));
    return made;
}

QString PairingAddress::text() const {
    const bool isSix = host.contains(':');
    if (port == usualPairingPort)
        return host;
    return QString(isSix ? "[%1]:%2" : "%1:%2").arg(host).arg(port);
}

} // namespace hermes::ctl
