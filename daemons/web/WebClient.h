#pragma once

#include "common/daemon/GapWatch.h"
#include "daemons/web/Frames.h"
#include "daemons/web/RobotView.h"
#include "daemons/web/Teleop.h"

#include <QPointer>
#include <array>

class QWebSocket;

namespace hermes::web {

/// What all clients share.
struct Hall {
    RobotView &robot;
    GapWatch &gaps;
    QString name, session; ///< that serverInfo tells
    double deadMan_s = 0;  ///< of teleop panels
    quint64 dropped = 0;   ///< messages of topics, for clients that read too slowly
    quint64 bad = 0;       ///< frames that could not be understood
};

/// A client of the WebSocket protocol of Foxglove. What it says wrong is answered with a status; nothing that
/// it sends or leaves unread takes more than a bounded amount of memory.
class WebClient : public QObject {
    Q_OBJECT
public:
    static constexpr int maxFrame = 1 << 20;       ///< bytes that it may send at once
    static constexpr qint64 maxUnsent = 10000000;  ///< bytes; beyond it messages of topics are dropped
    static constexpr qint64 mostUnsent = 20000000; ///< beyond it the client is

    WebClient(QWebSocket *socket, Role role, Hall &hall, QObject *parent);
    ~WebClient() override;

    Role role() const { return role_; }
    /// To be called now and then: ends the connection when nothing came since the last time.
    void checkAlive();

Q_SIGNALS:
    void gone();

private:
    enum class Level { Info, Warning, Error };
    using Operation = void (WebClient::*)(const QJsonObject &);

    static const QHash<QString, Operation> &operations();
    void takeText(const QString &text);
    void takeBinary(const QByteArray &bytes);
    void subscribe(const QJsonObject &operation);
    void unsubscribe(const QJsonObject &operation);
    void advertise(const QJsonObject &operation);
    void unadvertise(const QJsonObject &operation);
    void getParameters(const QJsonObject &operation);
    void setParameters(const QJsonObject &operation);
    void watchParameters(const QJsonObject &operation);
    void unwatchParameters(const QJsonObject &operation);

    void greet();
    void advertiseAll();
    void tellChanges(std::optional<QSet<quint32>> &told, const QJsonArray &now,
                     const std::array<QString, 4> &words);
    void sendMessage(quint32 channel, double stamp, const QByteArray &json);
    void onParameters(const QStringList &names);
    void steer(quint32 channel, const QByteArray &json);
    void request(const ClientFrame &frame);
    /// What speaks against the call; empty: nothing.
    QString objection(const Service &service, const QJsonObject &params) const;
    void answer(quint32 service, quint32 call, const Result<QJsonValue> &result);
    void sendParameters(const QStringList &names, const QJsonValue &id);
    void send(const QJsonObject &operation);
    bool isFull();
    void tell(Level level, const QString &message, const QString &id = {});

    QWebSocket *const socket_;
    const Role role_;
    Hall &hall_;
    const QString name_;
    bool isAlive_ = true;
    double dropTold_ = 0;                              ///< monotonic
    std::optional<QSet<quint32>> channels_, services_; ///< that were told
    QHash<quint32, quint32> subscriptions_;            ///< channel: the client's id
    QSet<QString> watched_;                            ///< parameters
    QSet<quint32> steering_;                           ///< channels of teleop panels
    int calls_ = 0;                                    ///< that wait
    std::unique_ptr<Teleop> teleop_;
};

} // namespace hermes::web
