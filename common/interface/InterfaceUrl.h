#pragma once

#include "common/Result.h"

#include <QMap>
#include <QString>

namespace hermes {

/// The address of one end of a channel, as in settings and on command lines:
/// `SCHEME://HOST:PORT/PATH?protocol=json&option=value`. A bare `HOST:PORT` or `[::1]:PORT` means tcp.
struct InterfaceUrl {
    QString scheme;
    QString host;
    quint16 port = 0;
    QString path; ///< device or socket file, for schemes that have one
    QMap<QString, QString> options;

    /// Error names the text and what is wrong with it.
    static Result<InterfaceUrl> parse(const QString &text);

    QString option(const QString &name, const QString &fallback = QString()) const;
    QString protocol() const { return option(QStringLiteral("protocol"), QStringLiteral("json")); }
    /// Without the options: for messages.
    QString toString() const;
};

} // namespace hermes
