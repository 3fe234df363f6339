#pragma once

#include "common/interface/TcpListener.h"

#include <QWebSocketServer>
#include <memory>
#include <set>

class QWebSocket;

namespace hermes::web {

class DoorSocket;

/// Where web clients come in. A GET of a document is answered with it, a request for a WebSocket of Foxglove
/// opens one, everything else is refused. Heads of requests are bounded in size and time.
class Door : public TcpListener {
    Q_OBJECT
public:
    struct Document {
        QByteArray type, text;
    };

    /// documents: by path. places: how many may be connected at the same time.
    Door(const InterfaceUrl &address, QMap<QByteArray, Document> documents, QStringList origins, int places,
         QObject *parent);

    quint64 refused() const { return refused_; }
    /// Why the last one was.
    const QString &lastRefusal() const { return lastRefusal_; }

Q_SIGNALS:
    /// The receiver owns it.
    void entered(QWebSocket *client);

protected:
    void take(qintptr descriptor) override;
    bool isHeard(qintptr descriptor) const override;

private:
    void follow(QWebSocket *client);
    void look(DoorSocket *socket);
    void letIn(DoorSocket *socket, const QByteArray &subprotocol);
    void refuse(DoorSocket *socket, const QByteArray &status, const QString &why);
    static void answer(DoorSocket *socket, const QByteArray &status, const Document &document);

    const QMap<QByteArray, Document> documents_;
    const QStringList origins_;
    const int places_;
    QWebSocketServer server_{"hermes", QWebSocketServer::NonSecureMode}; ///< does not listen itself
    const std::shared_ptr<std::set<DoorSocket *>> open_ = std::make_shared<std::set<DoorSocket *>>();
    quint64 refused_ = 0;
    QString lastRefusal_;
};

} // namespace hermes::web
