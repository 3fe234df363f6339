#include "common/client/DaemonAddress.h"

#include "common/Project.h"
#include "common/interface/InterfaceRegistry.h"

#include <QStringList>

namespace hermes {

Result<QString> daemonAddress(const QString &word, const QString &host) {
    if (word.contains(QLatin1Char(':')))
        return word;
    const quint16 port = defaultPort(word);
    if (port == 0) {
        return Error(ErrorCode::InvalidParams,
                     QString("unknown daemon \"%1\", expected one of %2, or HOST:PORT, or a URL")
                         .arg(word, daemonNames().join(", ")));
    }
    const QString bracketed = host.contains(QLatin1Char(':')) ? QString("[%1]").arg(host) : host;
    return QString("%1:%2").arg(bracketed).arg(port);
}

QString asOwner(const QString &address) {
    const bool isTcp = !address.contains("://") || address.startsWith("tcp://");
    if (!isTcp)
        return address;
    const QLatin1Char joint(address.contains(QLatin1Char('?')) ? '&' : '?');
    return address + joint + "own=1";
}

Result<void> checkAddress(const QString &address) {
    const Result<InterfaceUrl> url = InterfaceUrl::parse(address);
    if (!url)
        return Error(ErrorCode::InvalidParams, "HOST:PORT or a URL, as tcp://127.0.0.1:7420");
    if (!interfaceSchemes().contains(url->scheme))
        return Error(ErrorCode::InvalidParams, "an address with one of " + interfaceSchemes().join(", "));
    if ((url->scheme == "tcp" || url->scheme == "tls") && url->port == 0)
        return Error(ErrorCode::InvalidParams, "an address with a port");
    return {};
}

} // namespace hermes
