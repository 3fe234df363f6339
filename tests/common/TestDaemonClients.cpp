// Clients that do not read, are many, idle, or send too much.
#include "DaemonFixture.h"
#include "protocol/wire/Fields.h"

using namespace hermes;

class TestDaemonClients : public QObject, DaemonFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }
    void clientThatNeverReadsIsClosed();
    void oneClientCannotDisturbAnother();
    void clientLimit();
    void idleClientIsClosed();
    void oversizedRequest();
};

void TestDaemonClients::clientThatNeverReadsIsClosed() {
    RawClient client(address());
    client.socket.setReadBufferSize(1024);
    RawClient other(address());
    other.ask("daemon.info");
    QElapsedTimer limit;
    limit.start();
    while (client.socket.state() != QAbstractSocket::UnconnectedState && limit.elapsed() < 20000 &&
           daemon->server().counters()["clients"].toInt() != 1) {
        client.request(1, "large", QJsonArray{100000});
        QTest::qWait(1);
    }
    QCOMPARE(daemon->server().counters()["clients"].toInt(), 1);
    QVERIFY(compactJson(asJson(Log::instance().tail(5))).contains("does not read its replies"));
    QVERIFY(other.ask("daemon.info").contains("result"));
}

void TestDaemonClients::oneClientCannotDisturbAnother() {
    RawClient good(address());
    good.ask("topics.subscribe", QJsonArray{"numbers"});
    const QList<QByteArray> hostile{
        QByteArray(2 << 20, 'x'), QByteArray("\0\xff\xfe\n\n", 5), QByteArray(5000, '['),
        "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"" + QByteArray(60000, 'm') + "\"}"};
    for (const QByteArray &bytes : hostile) {
        RawClient bad(address());
        bad.send(bytes);
        QVERIFY(!bad.line().isEmpty());
        QVERIFY(bad.ask("daemon.info").contains("result")); // costs an error reply and nothing else
        bad.socket.abort();
    }
    daemon->publish("numbers", 5);
    QCOMPARE(good.message()["params"].toObject()["data"].toInt(), 5);
}

void TestDaemonClients::clientLimit() {
    start({"limits.clients=2"});
    RawClient first(address());
    RawClient second(address());
    first.ask("daemon.info");
    second.ask("daemon.info");
    RawClient third(address());
    QCOMPARE(third.message()["error"].toObject()["code"].toInt(), -32007);
    QTRY_COMPARE(third.socket.state(), QAbstractSocket::UnconnectedState);
    first.socket.abort();
    QTRY_COMPARE(daemon->server().counters()["clients"].toInt(), 1);
    RawClient fourth(address());
    QVERIFY(fourth.ask("daemon.info").contains("result"));
    QCOMPARE(daemon->server().counters()["clients_turned_away"].toInt(), 1);
}

void TestDaemonClients::idleClientIsClosed() {
    start({"limits.idle_s=1"});
    RawClient subscriber(address());
    subscriber.ask("topics.subscribe", QJsonArray{"numbers"});
    RawClient client(address());
    client.ask("daemon.info");
    QTRY_COMPARE(client.socket.state(), QAbstractSocket::UnconnectedState);
    QVERIFY(subscriber.ask("daemon.info").contains("result"));
}

void TestDaemonClients::oversizedRequest() {
    start({"limits.frame_bytes=1024"});
    RawClient client(address());
    client.send(QByteArray(5000, 'x'));
    const QJsonObject error = client.message()["error"].toObject();
    QCOMPARE(error["code"].toInt(), -32007);
    QVERIFY(client.ask("daemon.info").contains("result"));
    QCOMPARE(daemon->server().counters()["oversized_frames"].toInt(), 1);
}

QTEST_GUILESS_MAIN(TestDaemonClients)
#include "TestDaemonClients.moc"
