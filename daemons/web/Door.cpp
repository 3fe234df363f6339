#include "daemons/web/Door.h"

#include "common/platform/Sockets.h"
#include "daemons/web/HttpRequest.h"

#include <QTcpSocket>
#include <QTimer>
#include <QWebSocket>
#include <chrono>

namespace hermes::web {
namespace {

constexpr int acceptedAtOnce = 4;
constexpr int maxHead = 8192;                 // bytes
constexpr std::chrono::seconds forRequest{5}; // and for its answer

} // namespace

/// A connection, at first without a WebSocket. QWebSocketServer does not tell which subprotocol was chosen;
/// browsers close without it, so it is put into the answer that passes here.
class DoorSocket : public QTcpSocket {
public:
    /// all: those that are there; Qt disconnects every signal, so that none could tell the end.
    DoorSocket(std::shared_ptr<std::set<DoorSocket *>> all, QObject *parent)
        : QTcpSocket(parent)
        , all_(std::move(all)) {
        all_->insert(this);
        patience.setSingleShot(true);
        connect(&patience, &QTimer::timeout, this, [this] {
            abort();
            deleteLater();
        });
        patience.start(forRequest);
    }

    ~DoorSocket() override { all_->erase(this); }

    QTimer patience;
    QByteArray subprotocol;

protected:
    qint64 writeData(const char *data, qint64 length) override {
        const QByteArray block = QByteArray::fromRawData(data, int(length));
        if (subprotocol.isEmpty() || !block.startsWith("HTTP/1.1 101"))
            return QTcpSocket::writeData(data, length);
        const int end = block.indexOf("\r\n") + 2;
        const QByteArray line = "Sec-WebSocket-Protocol: " + std::exchange(subprotocol, {}) + "\r\n";
        const QByteArray whole = block.left(end) + line + block.mid(end);
        return QTcpSocket::writeData(whole.constData(), whole.size()) == whole.size() ? length : -1;
    }

private:
    const std::shared_ptr<std::set<DoorSocket *>> all_;
};

Door::Door(const InterfaceUrl &address, QMap<QByteArray, Document> documents, QStringList origins, int places,
           QObject *parent)
    : TcpListener(address, acceptedAtOnce, 0, parent)
    , documents_(std::move(documents))
    , origins_(std::move(origins))
    , places_(places) {
    connect(&server_, &QWebSocketServer::newConnection, this, [this] {
        while (QWebSocket *const client = server_.nextPendingConnection()) {
            follow(client);
            Q_EMIT entered(client);
        }
    });
}

/// Qt leaves the connection below a WebSocket to whoever made it, and needs it until the end.
void Door::follow(QWebSocket *client) {
    for (DoorSocket *socket : *open_) {
        if (socket->peerPort() != client->peerPort() || socket->peerAddress() != client->peerAddress())
            continue;
        socket->patience.stop();
        disconnect(socket, &QTcpSocket::disconnected, this, nullptr);
        connect(client, &QObject::destroyed, socket, &QObject::deleteLater);
    }
}

bool Door::isHeard(qintptr descriptor) const {
    return sockets::hasUnread(descriptor);
}

void Door::take(qintptr descriptor) {
    if (int(open_->size()) >= places_) {
        ++refused_;
        lastRefusal_ = QString("%1 connections are open already").arg(open_->size());
        return sockets::close(descriptor);
    }
    auto *const socket = new DoorSocket(open_, this);
    connect(socket, &QTcpSocket::disconnected, this, [socket] { socket->deleteLater(); });
    connect(socket, &QTcpSocket::readyRead, this, [this, socket] { look(socket); });
    socket->setReadBufferSize(maxHead + 1);
    socket->setSocketDescriptor(descriptor);
    socket->setSocketOption(QAbstractSocket::LowDelayOption, 1);
}

void Door::look(DoorSocket *socket) {
    const QByteArray seen = socket->peek(maxHead + 1);
    const int end = seen.indexOf("\r\n\r\n");
    if (end < 0 && seen.size() <= maxHead)
        return; // more comes, or the time ends
    disconnect(socket, &QTcpSocket::readyRead, this, nullptr);
    if (end < 0)
        return refuse(socket, "431 Request Header Fields Too Large", "a head of more than 8 KiB");
    const auto request = HttpRequest::parse(seen.left(end + 4));
    if (!request)
        return refuse(socket, "400 Bad Request", "no request of HTTP/1.1");
    if (request->method != "GET")
        return refuse(socket, "405 Method Not Allowed", "only GET is understood");
    if (request->wantsWebSocket()) {
        if (!request->isFromOwnPage(origins_))
            return refuse(socket, "403 Forbidden",
                          QString("a page of %1 may not connect; the setting web.origins names who may")
                              .arg(QString::fromLatin1(request->header("origin").left(100))));
        const QByteArray subprotocol = request->subprotocol();
        if (subprotocol.isEmpty())
            return refuse(socket, "400 Bad Request",
                          "expected the WebSocket subprotocol foxglove.websocket.v1 or foxglove.sdk.v1");
        return letIn(socket, subprotocol);
    }
    const auto document = documents_.constFind(request->path);
    if (document == documents_.constEnd())
        return refuse(socket, "404 Not Found", "there is " + documents_.keys().join(", ") + ", no more");
    answer(socket, "200 OK", *document);
}

void Door::letIn(DoorSocket *socket, const QByteArray &subprotocol) {
    socket->subprotocol = subprotocol;
    socket->setReadBufferSize(0); // Qt waits for whole frames, whose size is limited
    server_.handleConnection(socket);
}

void Door::refuse(DoorSocket *socket, const QByteArray &status, const QString &why) {
    ++refused_;
    lastRefusal_ = why;
    answer(socket, status, {"text/plain; charset=utf-8", why.toUtf8() + '\n'});
}

void Door::answer(DoorSocket *socket, const QByteArray &status, const Document &document) {
    socket->readAll();
    socket->write("HTTP/1.1 " + status + "\r\nContent-Type: " + document.type +
                  "\r\nContent-Length: " + QByteArray::number(document.text.size()) +
                  "\r\nConnection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\n"
                  "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; "
                  "style-src 'unsafe-inline'; connect-src 'self' ws:; frame-ancestors 'none'\r\n\r\n" +
                  document.text);
    socket->patience.start(forRequest);
    socket->disconnectFromHost();
}

} // namespace hermes::web
