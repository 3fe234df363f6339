#include "common/interface/InterfaceUrl.h"

#include <QRegularExpression>
#include <QUrl>
#include <QUrlQuery>

namespace hermes {

namespace {

Error wrongAddress(const QString &text, const QString &why) {
    return Error(ErrorCode::InvalidParams, QString("address \"%1\": expected HOST:PORT or a URL like "
                                                   "tcp://127.0.0.1:7410?protocol=json (%2)")
                                               .arg(text, why));
}

} // namespace

Result<InterfaceUrl> InterfaceUrl::parse(const QString &text) {
    static const QRegularExpression number("^([a-z]+://)?\\d+([/?]|$)");
    if (number.match(text).hasMatch()) // QUrl takes it for an address: 7490 for 0.0.29.66
        return wrongAddress(text, "a number alone tells no host");
    static const QRegularExpression host("^([a-z]+://)?[^/?]*:(\\d+)([/?]|$)");
    if (const QString port = host.match(text).captured(2); port.size() > 5 || port.toInt() > 65535)
        return wrongAddress(text, QString("the port is %1, at most 65535").arg(port));
    const QUrl url(text.contains("://") ? text : "tcp://" + text, QUrl::StrictMode);
    if (!url.isValid() || url.scheme().isEmpty())
        return wrongAddress(text, url.errorString());
    InterfaceUrl result;
    result.scheme = url.scheme();
    result.host = url.host();
    result.port = quint16(url.port(0));
    result.path = url.path();
    const auto options = QUrlQuery(url).queryItems(QUrl::FullyDecoded);
    for (const auto &option : options)
        result.options.insert(option.first, option.second);
    return result;
}

QString InterfaceUrl::option(const QString &name, const QString &fallback) const {
    return options.value(name, fallback);
}

QString InterfaceUrl::toString() const {
    QString text = scheme + "://";
    text += host.contains(QLatin1Char(':')) ? QLatin1Char('[') + host + QLatin1Char(']') : host;
    if (port != 0)
        text += QLatin1Char(':') + QString::number(port);
    return text + path;
}

} // namespace hermes
