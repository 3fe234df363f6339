#include "common/Log.h"
#include "common/client/Client.h"
#include "common/interface/TcpInterface.h"
#include "tests/support/DaemonClient.h"
#include "tests/support/FaultyInterface.h"

using namespace hermes;

class Echo : public Daemon {
public:
    Echo()
        : Daemon({"echo", "Echo", "For tests", 1}) {
        addTopic(Topic("numbers", "Numbers"));
        addCommand(Command("echo", "Gives back")
                       .param(Field::any("value", "Anything"))
                       .handler([](const Call &call) { return call.value("value"); }));
        addCommand(Command("hang", "Never answers").asyncHandler([this](const Call &, const Reply &reply) {
            kept.push_back(reply);
        }));
    }
    using Daemon::publish;
    std::vector<Reply> kept;
};

class TestClient : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        Log::instance().setStderr(false);
        start("tcp://127.0.0.1:0");
        address = daemon->server().addresses().value(0);
    }

    void callsAndFails() {
        ConnectedClient client(address);
        const auto result = client.callAndWait("echo", QJsonObject{{"value", QJsonArray{1, "a"}}});
        QVERIFY(result);
        QCOMPARE(*result, QJsonValue(QJsonArray{1, "a"}));
        QVERIFY(client.callAndWait("nothing").error().is(ErrorCode::MethodNotFound));
        QVERIFY(!client.connectTo("tcp://a b"));
        QVERIFY(!client.connectTo("pigeon://a"));
        QVERIFY(!client.connectTo("tcp://127.0.0.1:1?protocol=morse"));
    }

    void timesOut() {
        ConnectedClient client(address);
        const auto result = client.callAndWait("hang", QJsonObject(), std::chrono::milliseconds(50));
        QVERIFY(result.error().is(ErrorCode::TimedOut));
        daemon->kept[0].result("too late");
        QVERIFY(client.callAndWait("echo", QJsonArray{1})); // the late reply is not taken for this one
    }

    void aReplyThatIsTooLargeEndsItsCall() {
        Client client;
        client.setFrameLimit(1000);
        client.connectTo(address);
        QVERIFY(client.waitConnected().ok());
        const auto result =
            client.callAndWait("echo", QJsonObject{{"value", QString(5000, 'x')}}, std::chrono::hours(1));
        QVERIFY(!result);
        QCOMPARE(result.error().code, int(ErrorCode::OverLimit));
        VERIFY_CONTAINS(result.error().message, "1000 bytes");
        client.setFrameLimit(1 << 20);
        QJsonValue deep;
        for (int i = 0; i < 300; ++i)
            deep = QJsonArray{deep};
        QVERIFY(!client.callAndWait("echo", QJsonObject{{"value", deep}}, std::chrono::hours(1)));
        QVERIFY(client.callAndWait("echo", QJsonObject{{"value", 1}}).ok()); // the next one is read
    }

    void failsWhenNotConnected() {
        Client client;
        client.connectTo("127.0.0.1:1");
        QVERIFY2(client.problem().contains("127.0.0.1:1: no answer") || client.problem().contains("refused"),
                 qPrintable(client.problem()));
        QVERIFY(client.callAndWait("echo").error().is(ErrorCode::Disconnected));
        QVERIFY(!client.waitConnected(std::chrono::milliseconds(50)));
        TRY_CONTAINS(client.lastError(), "refused");
    }

    void pendingCallFailsWithTheConnection() {
        ConnectedClient client(address);
        QTimer::singleShot(20, [this] { daemon.reset(); });
        QVERIFY(client.callAndWait("hang").error().is(ErrorCode::Disconnected));
    }

    // Its bytes are written at once, and so it is seen at once that nobody takes them.
    void anUrgentCallFailsWithTheConnectionToo() {
        QTcpServer server;
        QVERIFY(server.listen(QHostAddress::LocalHost));
        ConnectedClient client(QString("tcp://127.0.0.1:%1").arg(server.serverPort()));
        QTRY_VERIFY(server.hasPendingConnections());
        QTcpSocket *const peer = server.nextPendingConnection();
        server.close();
        peer->abort();
        bool isWaiting = true;
        client.call(
            "stop", {}, [&isWaiting](const Result<QJsonValue> &) { isWaiting = false; },
            std::chrono::hours(1), Client::Repeats::AtOnce);
        QVERIFY(isWaiting); // its answer comes when it has returned
        const auto result =
            client.Client::callAndWait("stop", {}, std::chrono::hours(1), Client::Repeats::AtOnce);
        QVERIFY(result.error().is(ErrorCode::Disconnected));
        QTRY_VERIFY(!isWaiting && !client.isConnected());
    }

    void reconnectsAndSubscribesAgain() {
        Client client;
        QSignalSpy connected(&client, &Client::connected);
        QSignalSpy disconnected(&client, &Client::disconnected);
        client.connectTo(address);
        std::vector<TopicUpdate> updates;
        const int handle = client.subscribe("numbers", {{"queue", 10}},
                                            [&](const TopicUpdate &update) { updates.push_back(update); });
        QTRY_VERIFY(daemon->hasSubscribers("numbers"));
        daemon->publish("numbers", 1);
        QTRY_COMPARE(updates.size(), size_t(1));
        start(address); // a new daemon at the same place
        QTRY_COMPARE(connected.count(), 2);
        QVERIFY(disconnected.count() >= 1);
        QTRY_VERIFY(daemon->hasSubscribers("numbers"));
        daemon->publish("numbers", 2);
        QTRY_COMPARE(updates.size(), size_t(2));
        QCOMPARE(updates[1].json(), QJsonValue(2));
        QCOMPARE(updates[1].handle, handle);
        client.unsubscribe(handle);
        QTRY_VERIFY(!daemon->hasSubscribers("numbers"));
    }

    void subscribesBeforeConnecting() {
        Client client;
        int count = 0;
        client.subscribe("numbers", {}, [&count](const TopicUpdate &) { ++count; });
        client.connectTo(address);
        QTRY_VERIFY(daemon->hasSubscribers("numbers"));
        daemon->publish("numbers", 1);
        QTRY_COMPARE(count, 1);
    }

    void unknownTopicIsReported() {
        Client client;
        QString message;
        connect(&client, &Client::subscriptionFailed,
                [&](int, const RpcError &error) { message = error.message; });
        client.connectTo(address);
        client.subscribe("absent", {}, {});
        TRY_CONTAINS(message, "absent");
    }

    void malformedEnvelopesAreRefused() {
        QTcpServer server;
        QVERIFY(server.listen(QHostAddress(QHostAddress::LocalHost)));
        Client client;
        int updates = 0, failures = 0;
        connect(&client, &Client::subscriptionFailed, [&] { ++failures; });
        QVERIFY(client.connectTo(QString("127.0.0.1:%1").arg(server.serverPort())));
        client.subscribe("a", {}, [&](const TopicUpdate &) { ++updates; });
        client.subscribe("b", {}, [](const TopicUpdate &) {});
        QTRY_VERIFY(server.hasPendingConnections());
        QTcpSocket *const peer = server.nextPendingConnection();
        QTRY_VERIFY(peer->bytesAvailable() > 0);
        const int first = QJsonDocument::fromJson(peer->readLine()).object()["id"].toInt();
        peer->write(QString(R"({"jsonrpc":"2.0","id":%1,"result":{"subscription":5}})").arg(first).toUtf8() +
                    '\n');
        peer->write(QString(R"({"jsonrpc":"2.0","id":%1,"result":{}})").arg(first + 1).toUtf8() + '\n');
        const QByteArrayList wrong{"null", "\"a\"", "-1.7e308", "1e11"};
        for (const QByteArray &stamp : wrong + QByteArrayList{"1.5"})
            peer->write(
                R"({"jsonrpc":"2.0","method":"topic","params":{"subscription":5,"topic":"a","seq":1,"stamp":)" +
                stamp +
                R"(,"data":1}})"
                "\n");
        QTRY_COMPARE(updates, 1);
        QCOMPARE(client.rejected().unreadable, quint64(wrong.size()));
        VERIFY_STARTS(client.rejected().last, "topic a: stamp: found 1");
        QCOMPARE(failures, 1); // a reply without a subscription is no success
    }

    // On its way before the program goes on, whatever that computes next.
    void urgentRequestsLeaveAtOnce() {
        QTcpServer server;
        QVERIFY(server.listen(QHostAddress(QHostAddress::LocalHost)));
        Client client;
        QVERIFY(client.connectTo(QString("127.0.0.1:%1").arg(server.serverPort())));
        QTRY_VERIFY(client.isConnected() && server.hasPendingConnections());
        QTcpSocket *const peer = server.nextPendingConnection();
        client.call(
            "halt", QJsonObject(), [](const auto &) {}, Client::defaultTimeout, Client::Repeats::AtOnce);
        QVERIFY(peer->waitForReadyRead(1000)); // in which no events of the client are processed
        VERIFY_CONTAINS(QString(peer->readAll()), QString("halt"));
    }

    // Who does not read holds nobody up: it waits behind what fills the sockets.
    void urgentRequestsToWhoReadsNothingReturn() {
        QTcpServer server;
        QVERIFY(server.listen(QHostAddress(QHostAddress::LocalHost)));
        Client client;
        QVERIFY(client.connectTo(QString("127.0.0.1:%1").arg(server.serverPort())));
        QTRY_VERIFY(client.isConnected() && server.hasPendingConnections());
        server.nextPendingConnection()->setReadBufferSize(1);
        for (int i = 0; i < 40; ++i)
            client.call("usual", QJsonObject{{"text", QString(250000, 'x')}}, [](const auto &) {});
        for (int i = 0; i < 20; ++i)
            client.call(
                "halt", QJsonObject(), [](const auto &) {}, Client::defaultTimeout, Client::Repeats::AtOnce);
        QVERIFY(client.isConnected());
    }

    void closesFromInsideACallback() {
        ConnectedClient client(address);
        bool done = false;
        client.call("echo", QJsonArray{1}, [&](const Result<QJsonValue> &) {
            client.close();
            done = true;
        });
        QTRY_VERIFY(done);
        QVERIFY(!client.isConnected());
    }

    void everyRequestEndsOverABadLine_data() {
        const Rows<double, double, double> row("drop", "flip", "split");
        row("splits", 0.0, 0.0, 1.0);
        row("drops", 0.2, 0.0, 0.2);
        row("flips", 0.0, 0.2, 0.2);
        row("all", 0.1, 0.1, 0.5);
    }

    void everyRequestEndsOverABadLine() {
        FETCH(double, drop, double, flip, double, split);
        const unsigned int seed = 42;
        auto *faulty = new FaultyInterface(new TcpInterface(*InterfaceUrl::parse(address), nullptr),
                                           {drop, flip, split, 2, seed}, nullptr);
        Client client;
        client.connectTo(new Channel(faulty, makeCodec("json"), nullptr));
        QVERIFY(client.waitConnected());
        const int requests = 200;
        const std::chrono::milliseconds limit(drop + flip == 0 ? 10000 : 1000); // what was lost must run out
        int answered = 0;
        int failed = 0;
        for (int i = 0; i < requests; ++i) {
            client.call(
                "echo", QJsonArray{i},
                [&](const Result<QJsonValue> &result) { ++(result ? answered : failed); }, limit);
            if (i % 10 == 0)
                QTest::qWait(1);
        }
        QTRY_COMPARE_WITH_TIMEOUT(answered + failed, requests, 10000);
        QVERIFY(answered > 0);
        if (drop + flip == 0)
            QCOMPARE(answered, requests);
        else
            QVERIFY(failed > 0);
        QVERIFY(daemon->state() == DaemonState::Ready);
    }

private:
    void start(const QString &listen) {
        daemon.reset();
        daemon = std::make_unique<Echo>();
        launch(*daemon, {}, listen);
    }

    std::unique_ptr<Echo> daemon;
    QString address;
};
