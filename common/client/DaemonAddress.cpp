#include "common/client/DaemonAddress.h"

#include "common/Project.h"

#include <QStringList>

namespace hermes {

Result<QString> daemonAddress(const QString &word, const QString &host) {
    if (word.contains(QLatin1Char(':')))
        return word;
    const quint16 port = defaultPort(word);
    if (port == 0) {
        return Error(ErrorCode::InvalidParams,
                     QStringLiteral("unknown daemon \"%1\", expected one of %2, or HOST:PORT, or a URL")
                         .arg(word, daemonNames().join(QStringLiteral(", "))));
    }
    const QString bracketed = host.contains(QLatin1Char(':')) ? QStringLiteral("[%1]").arg(host) : host;
    return QStringLiteral("%1:%2").arg(bracketed).arg(port);
}

} // namespace hermes
