#pragma once

#include <QByteArray>
#include <QMap>
#include <QStringList>
#include <optional>

namespace hermes::web {

/// The head of an HTTP request.
struct HttpRequest {
    QByteArray method, path;
    QMap<QByteArray, QByteArray> headers; ///< by name in small letters; of a name that comes twice "A, B"

    /// Of the bytes up to the empty line, with it; nothing where they are no head of HTTP/1.1.
    static std::optional<HttpRequest> parse(const QByteArray &head);

    QByteArray header(const char *name) const { return headers.value(name); }
    bool wantsWebSocket() const;
    /// The first subprotocol of Foxglove that is offered; empty: none.
    QByteArray subprotocol() const;
    /// Whether the page that asks, if it is a page that asks, may: it comes from this server, called by an
    /// address or by this computer's name, or from one of these origins. A page of a stranger could have its
    /// own name lead here, so other names do not count as this server's.
    bool isFromOwnPage(const QStringList &origins) const;
};

} // namespace hermes::web
