#include "daemons/web/HttpRequest.h"

#include <QHostAddress>
#include <QSysInfo>
#include <QUrl>

namespace hermes::web {
namespace {

const QByteArrayList subprotocols{"foxglove.websocket.v1", "foxglove.sdk.v1"};

QByteArrayList listed(const QByteArray &value) {
    QByteArrayList words;
    for (const QByteArray &word : value.split(','))
        words.append(word.trimmed());
    return words;
}

bool isSafeName(const QString &host) {
    const QString own = QSysInfo::machineHostName().toLower();
    return !QHostAddress(host).isNull() || host == "localhost" || host == own || host == own + ".local";
}

} // namespace

std::optional<HttpRequest> HttpRequest::parse(const QByteArray &head) {
    QByteArrayList lines = head.split('\n');
    for (QByteArray &line : lines)
        line = line.endsWith('\r') ? line.chopped(1) : line;
    const QByteArrayList first = lines.takeFirst().split(' ');
    if (first.size() != 3 || first[1].isEmpty() || first[2] != "HTTP/1.1")
        return {};
    HttpRequest request{first[0], first[1], {}};
    for (const QByteArray &line : lines) {
        if (line.isEmpty())
            continue;
        const int colon = line.indexOf(':');
        const QByteArray name = line.left(colon).toLower(), value = line.mid(colon + 1).trimmed();
        if (colon <= 0 || name.contains(' ') || name.contains('\t') || line.contains('\0'))
            return {};
        QByteArray &known = request.headers[name];
        known = known.isEmpty() ? value : known + ", " + value;
    }
    return request;
}

bool HttpRequest::wantsWebSocket() const {
    return header("upgrade").toLower() == "websocket";
}

QByteArray HttpRequest::subprotocol() const {
    for (const QByteArray &offered : listed(header("sec-websocket-protocol")))
        if (subprotocols.contains(offered))
            return offered;
    return {};
}

bool HttpRequest::isFromOwnPage(const QStringList &origins) const {
    const QString origin = QString::fromLatin1(header("origin")).toLower();
    if (origin.isEmpty() || origins.contains(origin, Qt::CaseInsensitive))
        return true;
    const QString host = QString::fromLatin1(header("host")).toLower();
    return origin == "http://" + host && isSafeName(QUrl("http://" + host).host());
}

} // namespace hermes::web
