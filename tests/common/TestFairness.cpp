// One client may not starve another, nor fill a daemon with work.
#include "protocol/jsonrpc/JsonRpc.h"
#include "protocol/wire/JsonText.h"
#include "tests/support/DaemonClient.h"

using namespace hermes;

class TestFairness : public QObject {
    Q_OBJECT

    class BusyDaemon : public Daemon {
    public:
        BusyDaemon()
            : Daemon({"busy", "Busy daemon", "For tests", 1}) {
            addCommand(Command("count", "Counts").returnsNull().handler([this](const Call &) {
                ++counted;
                return QJsonValue();
            }));
            addCommand(
                Command("later", "Answers when told to").asyncHandler([this](const Call &, const Reply &r) {
                    replies.push_back(r);
                }));
        }

        int counted = 0;
        std::vector<Reply> replies;
    };

    static QByteArray request(const QJsonValue &id, const QString &method) {
        return compactJson(makeRequest(id, method, QJsonObject())) + '\n';
    }

private Q_SLOTS:
    void init() {
        daemon = std::make_unique<BusyDaemon>();
        launch(*daemon, {"limits.pending=4", "log.level=error"});
    }

    void floodDoesNotHoldUpAnother() {
        constexpr int many = 50000;
        const auto flooder = client(), other = client();
        QTRY_COMPARE(daemon->server().counters()["clients"].toInt(), 2);
        flooder->write(compactJson(makeNotification("count", QJsonObject())).append('\n').repeated(many));
        QTRY_VERIFY(daemon->counted > 0);
        const int before = daemon->counted;
        int meanwhile = -1; // until the answer came, not until QTRY looks
        connect(other.get(), &QTcpSocket::readyRead, this, [&] {
            if (meanwhile < 0)
                meanwhile = daemon->counted - before;
        });
        other->write(request(1, "daemon.info"));
        QTRY_VERIFY(meanwhile >= 0);
        QVERIFY2(meanwhile < many / 5, saying("%1 requests went before", meanwhile));
        QTRY_COMPARE(daemon->counted, many);
    }

    void unansweredRequestsAreLimited() {
        const auto asking = client(), other = client();
        asking->write(request(1, "later").repeated(20) + request(2, "count"));
        QTRY_COMPARE(daemon->replies.size(), size_t(4));
        other->write(request(1, "daemon.info"));
        QTRY_VERIFY(other->canReadLine());
        QCOMPARE(daemon->replies.size(), size_t(4));
        for (size_t answered = 0; answered < 20; ++answered) {
            QTRY_VERIFY(daemon->replies.size() > answered);
            daemon->replies[answered].result(QJsonValue());
            QVERIFY(daemon->replies.size() <= answered + 5);
        }
        QTRY_COMPARE(daemon->counted, 1);
    }

    void whatWasSaidBeforeClosingIsDone() {
        const auto leaving = client();
        leaving->write(request(QJsonValue::Undefined, "later").repeated(4)); // it has to wait from here on
        leaving->write(request(1, "count").repeated(1000));
        leaving->disconnectFromHost();
        QTRY_COMPARE(daemon->counted, 1000);
        QTRY_COMPARE(daemon->server().counters()["clients"].toInt(), 0);
    }

private:
    std::unique_ptr<QTcpSocket> client() const {
        auto socket = std::make_unique<QTcpSocket>();
        const QUrl url(daemon->server().addresses().value(0));
        socket->connectToHost(url.host(), quint16(url.port()));
        return socket;
    }
    std::unique_ptr<BusyDaemon> daemon;
};
