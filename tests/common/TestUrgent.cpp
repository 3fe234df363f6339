// Urgent commands find their way whatever others ask for; what was received before a gap is void.
#include "DaemonFixture.h"
#include "common/Time.h"

using namespace hermes;

class TestUrgent : public QObject {
    Q_OBJECT

    class StoppableDaemon : public TestedDaemon {
    public:
        StoppableDaemon() {
            addCommand(Command("work", "Takes a millisecond").returnsNull().handler([this](const Call &) {
                const double end = monotonicNow() + 0.001;
                while (monotonicNow() < end) {
                }
                ++worked;
                return QJsonValue();
            }));
            addCommand(Command("halt", "Stops").urgent().handler([this](const Call &) { return worked; }));
            addCommand(Command("freeze", "Stops, too")
                           .param(Field::number("wait_s", "").range(0, 10).byDefault(1))
                           .param(Field::text("client", "").with("maxLength", 5).byDefault("nobody"))
                           .urgent()
                           .handler([this](const Call &call) -> Result<QJsonValue> {
                               taken = call.params;
                               return QJsonValue(worked);
                           }));
            addCommand(Command("go", "Moves").fresh().handler([](const Call &) { return true; }));
        }
        int worked = 0;
        QJsonObject taken; // by freeze
    };

    static QByteArray batchOf(int count, const QString &method, bool notifications = false) {
        QJsonArray batch;
        for (int i = 0; i < count; ++i)
            batch.append(notifications ? makeNotification(method, QJsonObject())
                                       : makeRequest(i, method, QJsonObject()));
        return compactJson(batch);
    }

private Q_SLOTS:
    void init() {
        Log::instance().setStderr(false);
        start();
    }
    void cleanup() { daemon.reset(); }

    void goesBeforeABatchOfAnother() {
        RawClient busy(address()), other(address());
        busy.send(batchOf(1000, "work"));
        QTRY_VERIFY(daemon->worked > 0);
        const int before = daemon->worked;
        const int then = other.ask("halt")["result"].toInt();
        QVERIFY2(then < before + 50, saying(then - before));
        const QJsonArray replies = QJsonDocument::fromJson(busy.line()).array();
        QCOMPARE(replies.size(), 1000);
        for (int i = 0; i < replies.size(); ++i)
            QCOMPARE(replies[i].toObject()["id"].toInt(), i);
    }

    void goesBeforeWhatItsClientAskedBefore() {
        RawClient client(address());
        for (int i = 0; i < 500; ++i)
            client.send(compactJson(makeNotification("work", QJsonObject())));
        QVERIFY(client.ask("halt")["result"].toInt() < 250);
        QTRY_COMPARE(daemon->worked, 500);
    }

    void oneOfEachKindGoesBefore() {
        RawClient client(address());
        QByteArray together;
        for (int i = 0; i < 500; ++i)
            together += compactJson(makeNotification("work", QJsonObject())) + '\n';
        for (int i = 0; i < 3; ++i)
            for (const char *method : {"halt", "freeze"})
                together += compactJson(makeRequest(i, method, QJsonObject())) + '\n';
        client.send(together.chopped(1));
        QVERIFY(client.message()["result"].toInt() < 100);
        QVERIFY(client.message()["result"].toInt() < 100);
        QCOMPARE(client.message()["result"].toInt(), 500); // those after the first have no haste
    }

    void nameMayBeWrittenWithEscapes() {
        RawClient busy(address()), other(address());
        busy.send(batchOf(1000, "work", true));
        QTRY_VERIFY(daemon->worked > 0);
        other.send(R"({"jsonrpc":"2.0","id":1,"method":"h\u0061lt"})");
        QVERIFY(other.message()["result"].toInt() < 500);
    }

    void isNeverRefusedForItsForm_data() {
        Rows<QByteArray, QByteArray>("request", "taken");
        const auto row = [](const char *name, const QByteArray &params, const char *taken) {
            QTest::newRow(name) << R"({"jsonrpc":"2.0","id":1,"method":"freeze","params":)" + params + '}'
                                << QByteArray(taken);
        };
        const char *const nothing = R"({"wait_s":1,"client":"nobody"})";
        row("too large", R"({"wait_s":20,"client":"anna"})", R"({"wait_s":1,"client":"anna"})");
        row("of another kind", R"({"wait_s":"1s"})", nothing);
        row("too long", R"({"client":"ANNNNA","wait_s":2})", R"({"wait_s":2,"client":"nobody"})");
        row("unknown", R"({"reason":"fire","wait_s":0})", R"({"wait_s":0,"client":"nobody"})");
        row("null", R"({"wait_s":null,"client":null})", nothing);
        row("by position, too many", R"([3, "eva", 4, 5])", R"({"wait_s":3,"client":"eva"})");
        row("no object", R"("now")", nothing);
        row("many values", '[' + QByteArray("0,").repeated(2000) + "0]", R"({"wait_s":0,"client":"nobody"})");
        row("deep", R"({"client":{"client":[[[]]]}})", nothing);
        QTest::newRow("no version") << QByteArray(R"({"id":1,"method":"freeze"})") << QByteArray(nothing);
        QTest::newRow("another version")
            << QByteArray(R"({"jsonrpc":2.0,"id":1,"method":"freeze"})") << QByteArray(nothing);
        QTest::newRow("a bad id") << QByteArray(R"({"jsonrpc":"2.0","id":[1],"method":"freeze"})")
                                  << QByteArray(nothing);
    }

    void isNeverRefusedForItsForm() {
        FETCH(QByteArray, request, QByteArray, taken);
        RawClient client(address());
        client.send(request);
        QVERIFY(client.message().contains("result"));
        QCOMPARE(daemon->taken, QJsonDocument::fromJson(taken).object());
        client.send('[' + request + ']'); // in a batch, too
        daemon->taken = {};
        QVERIFY(QJsonDocument::fromJson(client.line()).array()[0].toObject().contains("result"));
        QCOMPARE(daemon->taken, QJsonDocument::fromJson(taken).object());
    }

    void aFrameOfManyValuesTakesNoMemory() {
        start({});
        RawClient client(address());
        client.send('[' + QByteArray("{},").repeated(60000) + "{}]");
        const QJsonObject error = errorOf(client.message());
        QVERIFY2(error["message"].toString().endsWith("more than 50000 values"),
                 qPrintable(error["message"].toString()));
        QVERIFY(client.ask("halt").contains("result"));
    }

    void hasAPlaceWhenAllAreTaken() {
        start({"limits.clients=2"});
        auto first = std::make_unique<RawClient>(address());
        RawClient second(address());
        first->ask("go");
        second.ask("go");
        RawClient third(address());
        QVERIFY(third.ask("halt").contains("result"));
        const QJsonObject refused = errorOf(third.ask("go"));
        QCOMPARE(refused["code"].toInt(), -32007);
        QCOMPARE(
            refused["message"].toString(),
            QString(
                "2 clients are connected already (limits.clients); this place is kept for halt and freeze"));
        QCOMPARE(count("clients_in_kept_places"), 1);
        first.reset();
        QTRY_COMPARE(count("clients_in_kept_places"), 0);
        QVERIFY(third.ask("go").contains("result"));
    }

    void silentClientsGiveWay() {
        start({"limits.clients=1"});
        std::vector<std::unique_ptr<RawClient>> silent;
        for (int i = 0; i < 3 * Server::keptPlaces; ++i) {
            silent.push_back(std::make_unique<RawClient>(address()));
            QTRY_COMPARE(count("clients_in_all"), i + 1);
        }
        RawClient stopping(address());
        QVERIFY(stopping.ask("halt").contains("result"));
        QCOMPARE(count("clients"), 1 + Server::keptPlaces);
        QCOMPARE(silent[0]->socket.state(), QAbstractSocket::ConnectedState); // an ordinary place
        const QJsonObject farewell = errorOf(silent[1]->message());
        QCOMPARE(farewell["code"].toInt(), -32007);
        QVERIFY(farewell["message"].toString().contains("limits.clients"));
        QTRY_COMPARE(silent[1]->socket.state(), QAbstractSocket::UnconnectedState);
    }

    // A socket closed with bytes unread resets the connection, and with it goes what the client was told.
    void refusalIsReadWhateverWasSent() {
        class Full : public DaemonFixture { // nothing is urgent
        public:
            using DaemonFixture::address;
            using DaemonFixture::daemon;
            using DaemonFixture::start;
        } full;
        full.start({"limits.clients=1"});
        RawClient first(full.address());
        QVERIFY(first.ask("daemon.info").contains("result"));
        for (int i = 0; i < 10; ++i) {
            RawClient refused(full.address());
            QVERIFY(refused.socket.waitForConnected());
            refused.request(1, "daemon.info");
            refused.send(QByteArray(200000, ' '));
            refused.socket.flush();
            refused.socket.waitForBytesWritten(100);
            const QJsonObject error = errorOf(refused.message());
            QCOMPARE(error["code"].toInt(), -32007);
            QVERIFY(error["message"].toString().contains("limits.clients"));
            QTRY_COMPARE(refused.socket.state(), QAbstractSocket::UnconnectedState);
        }
    }

    void batchOfOneWhoLeavesIsDone() {
        RawClient leaving(address());
        leaving.send(batchOf(200, "work", true));
        leaving.send(compactJson(makeNotification("work", QJsonObject())));
        leaving.socket.disconnectFromHost();
        QTRY_COMPARE(daemon->worked, 201);
        QTRY_COMPARE(count("clients"), 0);
    }

    void repliesOfABatchHaveALimit() {
        RawClient client(address());
        client.send(batchOf(100, "large"));
        const QJsonObject error = errorOf(client.message());
        QCOMPARE(error["code"].toInt(), -32007);
        QVERIFY(error["message"].toString().contains("together"));
        QVERIFY(client.ask("halt").contains("result"));
    }

    void manyValuesAreRefused() {
        RawClient client(address());
        QJsonArray many;
        for (int i = 0; i < 1001; ++i)
            many.append(0);
        const QJsonValue values = QJsonObject{{"listen", many}};
        QCOMPARE(errorOf(client.ask("settings.set", QJsonObject{{"values", values}}))["code"].toInt(),
                 -32007);
    }

    void whatCameBeforeAGapIsVoid() {
        daemon->server().gaps().watch(0.2);
        RawClient client(address());
        QVERIFY(client.ask("go").contains("result"));
        for (int gap = 0; gap < 3; ++gap) {
            client.request(1, "go");
            client.request(2, "work");
            client.request(3, "halt");
            client.socket.flush();
            QThread::msleep(400); // the daemon stands still: this is its thread
            QMap<int, QJsonObject> replies;
            for (int i = 0; i < 3; ++i) {
                const QJsonObject reply = client.message();
                replies[reply["id"].toInt()] = reply;
            }
            QCOMPARE(errorOf(replies[1])["code"].toInt(), -32005);
            QVERIFY(errorOf(replies[1])["message"].toString().contains("stood still for 0.4"));
            QVERIFY(replies[2].contains("result"));
            QVERIFY(replies[3].contains("result"));
        }
        QTRY_VERIFY(client.ask("go").contains("result"));
    }

private:
    void start(const QStringList &more = {}) {
        daemon.reset();
        daemon = std::make_unique<StoppableDaemon>();
        launch(*daemon, more);
    }
    QString address() const { return daemon->server().addresses().value(0); }
    int count(const char *what) const { return daemon->server().counters()[QLatin1String(what)].toInt(); }
    static QJsonObject errorOf(const QJsonObject &reply) { return reply["error"].toObject(); }

    std::unique_ptr<StoppableDaemon> daemon;
};
