#pragma once

#include "protocol/jsonrpc/Codec.h"
#include "tests/gui/desktop/JsonAsCbor.h"

#include <QHash>
#include <QJsonObject>
#include <QMap>
#include <QPointer>
#include <QThread>
#include <QVector>
#include <mutex>

namespace hermes {

/// What a fake daemon says where it differs from a good one, all as JSON text.
struct Mischief {
    QMap<QString, QByteArray> results; ///< by method
    QMap<QString, QByteArray> topics;  ///< the data of their messages; %1 counts them
    QList<QByteArray> then;            ///< in place of that data, in turn with it
    int messages = 1;                  ///< of each topic; negative: without end
    QByteArray stamp = "1718000000";   ///< of the messages
    QByteArray reply = "{\"jsonrpc\":\"2.0\",\"id\":%1,\"result\":%2}\n";
    QByteArray noise;       ///< sent in place of replies
    bool isEndless = false; ///< the noise goes on and on
    bool closes = false;    ///< after the noise
    bool agrees = false;    ///< on CBOR, before the noise
    bool hasTopics = true;
    bool isMotors = false;     ///< has the methods of a motor control
    bool isSupervisor = false; ///< so it is where it has something to say as `processes`, too
    QByteArray robotId;        ///< that it tells; empty: one of its own where it is a supervisor, else none
    bool isEverywhere = false; ///< at all addresses of this computer: 127.0.0.2 is another host
    bool knowsCbor = true;     ///< and says the same in it when it is asked to
};

/// A daemon that says whatever a test wants, in a thread of its own, so that its work is not the window's.
class FakeDaemon : public QObject {
public:
    explicit FakeDaemon(const Mischief &mischief)
        : mischief_(mischief) {
        moveToThread(&thread_);
        thread_.start();
        inThread([this] { listen(); });
    }
    ~FakeDaemon() override {
        inThread([this] { delete server_; });
        thread_.quit();
        thread_.wait();
    }

    quint16 port() const { return port_; }
    /// Seen from this computer; 127.0.0.2 is another one where the daemon isEverywhere.
    QString address(const char *host = "127.0.0.1") const { return QString("%1:%2").arg(host).arg(port_); }
    /// A message to all who have subscribed to the topic, with a stamp of its own if one is given.
    void say(const QByteArray &topic, const QByteArray &data, const QByteArray &stamp = {}) {
        inThread([&] {
            for (const Subscriber &one : qAsConst(subscribers_))
                if (one.client && one.topic == topic)
                    write(*one.client, message(one.subscription, topic, 0, data, stamp));
        });
    }
    /// Another answer of a method from now on.
    void setResult(const QString &method, const QByteArray &result) {
        inThread([&] { mischief_.results[method] = result; });
    }
    /// What asks for this waits for its answer until letGo().
    void holdBack(const QString &method) {
        inThread([&] { heldMethod_ = method; });
    }
    /// Sends the answers that were held back, and holds back no more.
    void letGo() {
        inThread([&] {
            heldMethod_.clear();
            for (const auto &[client, reply] : std::exchange(held_, {}))
                if (client)
                    write(*client, reply);
        });
    }
    /// Ends all connections; whoever wants to comes back.
    void dropAll() {
        inThread([&] {
            for (auto *const client : server_->findChildren<QTcpSocket *>())
                client->abort();
        });
    }
    /// How often a method was called.
    int calls(const QString &method) const {
        const std::lock_guard<std::mutex> lock(mutex_);
        return calls_.value(method);
    }
    int subscriptions(const QString &topic) const { return calls("topics.subscribe " + topic); }

private:
    struct Subscriber {
        QPointer<QTcpSocket> client;
        QByteArray topic;
        int subscription;
    };

    static constexpr qint64 maxWaiting = 1 << 20; // bytes

    template <typename Work>
    void inThread(const Work &work) {
        QMetaObject::invokeMethod(this, work, Qt::BlockingQueuedConnection);
    }
    void listen() {
        server_ = new QTcpServer;
        server_->listen(mischief_.isEverywhere ? QHostAddress::AnyIPv4 : QHostAddress::LocalHost);
        server_->setMaxPendingConnections(1000);
        port_ = server_->serverPort();
        connect(server_, &QTcpServer::newConnection, server_, [this] {
            QTcpSocket *const client = server_->nextPendingConnection();
            connect(client, &QTcpSocket::disconnected, client, [this, client] {
                cbor_.remove(client);
                client->deleteLater();
            });
            connect(client, &QTcpSocket::readyRead, client, [this, client] {
                if (const auto codec = cbor_.value(client)) {
                    for (const CodecItem &item : codec->feed(client->readAll()))
                        answer(*client, item.message.toObject());
                    return;
                }
                while (client->canReadLine())
                    answer(*client, QJsonDocument::fromJson(client->readLine()).object());
            });
        });
    }
    /// Lines of JSON, in the framing of the client.
    void write(QTcpSocket &client, const QByteArray &lines) {
        if (!cbor_.contains(&client)) {
            client.write(lines);
            return;
        }
        for (const QByteArray &line : lines.trimmed().split('\n'))
            client.write(asCborFrame(line));
    }
    void agree(QTcpSocket &client, int id) {
        const QByteArray reply = mischief_.knowsCbor
                                     ? "\"result\":null}\n"
                                     : "\"error\":{\"code\":-32601,\"message\":\"no such method\"}}\n";
        client.write("{\"jsonrpc\":\"2.0\",\"id\":" + QByteArray::number(id) + ',' + reply);
        if (mischief_.knowsCbor)
            cbor_[&client] = makeCodec("cbor");
    }
    void answer(QTcpSocket &client, const QJsonObject &request) {
        const QString method = request["method"].toString();
        const QString topic =
            method == "topics.subscribe" ? request["params"]["topic"].toString() : QString();
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            ++calls_[method];
            ++calls_[method + ' ' + topic];
        }
        if (method == "protocol.use" && (mischief_.noise.isEmpty() || mischief_.agrees))
            return agree(client, request["id"].toInt());
        if (!mischief_.noise.isEmpty())
            return makeNoise(client);
        if (!request.contains("id"))
            return;
        const int subscription = ++lastSubscription_;
        const QByteArray usual = topic.isEmpty()
                                     ? QByteArray("null")
                                     : "{\"subscription\":" + QByteArray::number(subscription) + '}';
        QByteArray reply = mischief_.reply;
        reply.replace("%1", QByteArray::number(request["id"].toInt()))
            .replace("%2", mischief_.results.value(method, good(method, usual)));
        if (method == heldMethod_)
            held_.emplace_back(&client, reply);
        else
            write(client, reply);
        if (!topic.isEmpty())
            subscribers_.append({&client, topic.toUtf8(), subscription});
        if (mischief_.topics.contains(topic))
            publish(client, topic, subscription);
    }
    void makeNoise(QTcpSocket &client) {
        client.write(mischief_.noise);
        if (mischief_.closes)
            return client.disconnectFromHost();
        if (mischief_.isEndless)
            keepBusy(client, [this, &client] { client.write(mischief_.noise); });
    }
    void publish(QTcpSocket &client, const QString &topic, int subscription) {
        const auto one = [this, &client, topic, subscription, count = 0]() mutable {
            const int turn = count % (mischief_.then.size() + 1);
            QByteArray data = turn == 0 ? mischief_.topics.value(topic) : mischief_.then.at(turn - 1);
            write(client, message(subscription, topic.toUtf8(), count,
                                  data.replace("%1", QByteArray::number(count))));
            ++count;
        };
        if (mischief_.messages < 0)
            return keepBusy(client, one);
        auto next = one;
        for (int i = 0; i < mischief_.messages; ++i)
            next();
    }
    QByteArray message(int subscription, const QByteArray &topic, int count, const QByteArray &data,
                       const QByteArray &stamp = {}) const {
        return "{\"jsonrpc\":\"2.0\",\"method\":\"topic\",\"params\":{\"subscription\":" +
               QByteArray::number(subscription) + ",\"topic\":\"" + topic +
               "\",\"seq\":" + QByteArray::number(count) +
               ",\"dropped\":0,\"stamp\":" + (stamp.isEmpty() ? mischief_.stamp : stamp) +
               ",\"data\":" + data + "}}\n";
    }
    /// As much as the client takes, now and then: what else is sent without end has its turn, too.
    template <typename Write>
    void keepBusy(QTcpSocket &client, Write write) {
        auto *const timer = new QTimer(&client);
        connect(timer, &QTimer::timeout, &client, [this, &client, write]() mutable {
            for (int i = int(200 * (turn_() % 2)); i < 200 && client.bytesToWrite() < maxWaiting; ++i)
                write();
        });
        timer->start(1);
    }
    QByteArray good(const QString &method, const QByteArray &usual) const {
        static const QMap<QString, QByteArray> results{
            {"daemon.status", "{\"state\":\"running\",\"health\":[]}"},
            {"settings.schema", "{\"type\":\"object\",\"properties\":{\"a\":{\"type\":\"number\"}}}"},
            {"settings.get", "{\"a\":1}"},
            {"session.list", "[]"},
            {"log.tail", "[]"},
            {"motor.state", "{\"latched\":{},\"control\":{\"held\":false}}"}};
        return method == "rpc.discover"  ? description()
               : method == "daemon.info" ? info()
                                         : results.value(method, usual);
    }
    QByteArray info() const {
        const QByteArray own = "00000000-0000-4000-8000-0000000" + QByteArray::number(100000 + port_).mid(1);
        const QByteArray processes = mischief_.topics.value("processes");
        QJsonObject all{{"name", "fake"}, {"title", "Fake"}, {"description_hash", "1"}};
        if (!mischief_.robotId.isEmpty() || !processes.isEmpty())
            all["robot"] =
                QJsonObject{{"id", QString(mischief_.robotId.isEmpty() ? own : mischief_.robotId)},
                            {"name", QJsonDocument::fromJson(processes)["robot"].toString("fake")}};
        return QJsonDocument(all).toJson(QJsonDocument::Compact);
    }
    /// The methods and topics of all daemons in one.
    QByteArray description() const {
        QStringList methods{"fake.call",    "daemon.info", "settings.schema", "session.start",
                            "session.list", "pose.set",    "map.undo"};
        if (mischief_.isSupervisor || mischief_.topics.contains("processes"))
            methods << "process.list"
                    << "process.start";
        if (mischief_.isMotors)
            methods << "motor.drive"
                    << "motor.estop"
                    << "motor.state";
        QStringList topics{"map",    "pose",     "scan", "scan2d",    "odometry", "truth", "graph",  "power",
                           "status", "settings", "log",  "processes", "free",     "cloud", "session"};
        if (!mischief_.hasTopics)
            topics.clear();
        return "{\"openrpc\":\"1.2.6\",\"methods\":" + named(methods) + ",\"x-topics\":" + named(topics) +
               '}';
    }
    static QByteArray named(const QStringList &names) {
        QByteArray list = "[";
        for (const QString &name : names)
            list += (list.size() == 1 ? "" : ",") + ("{\"name\":\"" + name.toUtf8() + "\",\"params\":[]}");
        return list + ']';
    }

    Mischief mischief_;
    QThread thread_;
    QTcpServer *server_ = nullptr;
    quint16 port_ = 0;
    int lastSubscription_ = 0;
    QVector<Subscriber> subscribers_;
    std::minstd_rand turn_;
    QString heldMethod_;
    std::vector<std::pair<QPointer<QTcpSocket>, QByteArray>> held_;
    QHash<QTcpSocket *, std::shared_ptr<Codec>> cbor_; // of those who speak it
    mutable std::mutex mutex_;
    QMap<QString, int> calls_;
};

} // namespace hermes

Q_DECLARE_METATYPE(hermes::Mischief)
