// Clients that do not read, are many, idle, or send too much.
#include "DaemonFixture.h"
#include "protocol/wire/Fields.h"

using namespace hermes;

class TestDaemonClients : public QObject, DaemonFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void clientThatNeverReadsIsClosed() {
        RawClient client(address());
        client.socket.setReadBufferSize(1024);
        RawClient other(address());
        other.ask("daemon.info");
        auto limit = runningTimer();
        while (client.socket.state() != QAbstractSocket::UnconnectedState &&
               limit.elapsed() < 20000 * patience && daemon->server().counters()["clients"].toInt() != 1) {
            client.request(1, "large", QJsonArray{100000});
            QTest::qWait(1);
        }
        QCOMPARE(daemon->server().counters()["clients"].toInt(), 1);
        QVERIFY(compactJson(asJson(Log::instance().tail(5))).contains("does not read its replies"));
        QVERIFY(other.ask("daemon.info").contains("result"));
    }

    void oneClientCannotDisturbAnother() {
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

    void clientLimit() {
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

    void idleClientIsClosed() {
        start({"limits.idle_s=1"});
        RawClient subscriber(address());
        subscriber.ask("topics.subscribe", QJsonArray{"numbers"});
        RawClient client(address());
        client.ask("daemon.info");
        QTRY_COMPARE(client.socket.state(), QAbstractSocket::UnconnectedState);
        QVERIFY(subscriber.ask("daemon.info").contains("result"));
    }

    void oversizedRequest() {
        start({"limits.frame_bytes=1024"});
        RawClient client(address());
        client.send(QByteArray(5000, 'x'));
        const QJsonObject error = client.message()["error"].toObject();
        QCOMPARE(error["code"].toInt(), -32007);
        QVERIFY(client.ask("daemon.info").contains("result"));
        QCOMPARE(daemon->server().counters()["oversized_frames"].toInt(), 1);
    }

    void whoSpeaksAnotherProtocolIsTurnedAway_data() {
        const Rows<QByteArray, QString> row("beginning", "name");
        row("HTTP", "POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: text/plain\r\n\r\n", "HTTP");
        row("TLS", QByteArray("\x16\x03\x01\x00\x05\x01\x00\x00\n", 9), "TLS");
    }

    // Sent whole, in pieces, and with a method longer than a frame may be: no command of its body is run.
    void whoSpeaksAnotherProtocolIsTurnedAway() {
        FETCH(QByteArray, beginning, QString, name);
        RawClient good(address());
        good.ask("daemon.info");
        const QByteArray commands = "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"settings.set\",\"params\":{"
                                    "\"values\":{\"gain\":5}}}\n";
        const auto say = [this, name](const QByteArray &bytes, int piece) {
            RawClient page(address());
            QVERIFY(page.socket.waitForConnected());
            for (int i = 0; i < bytes.size() && page.socket.state() == QAbstractSocket::ConnectedState;
                 i += piece) {
                page.socket.write(bytes.mid(i, piece));
                page.socket.flush();
                QCoreApplication::processEvents();
            }
            QTRY_COMPARE(page.socket.state(), QAbstractSocket::UnconnectedState);
            const QByteArray told = page.socket.readAll();
            QVERIFY2(told.contains("this is " + name.toUtf8()) && !told.contains("result"), told);
        };
        const QByteArray all = beginning + commands.repeated(100);
        say(all, all.size());
        say(all, 7);
        if (name == "HTTP")
            say(QByteArray(3 << 20, 'M') + all, 1 << 20);
        QCOMPARE(daemon->settings().integer("gain"), 1);
        QVERIFY(good.ask("daemon.info").contains("result"));
        QVERIFY(daemon->server().counters()["clients_turned_away"].toInt() >= 2);
        QVERIFY(
            compactJson(asJson(Log::instance().tail(5))).contains("turned away: this is " + name.toUtf8()));
    }

    void aNameForgesNoLineOfTheLog() {
        logWarning("test", QString("name\n2026-01-01T00:00:00.000Z error forged: \x1b[2J") + QChar(0x2028) +
                               QString(100000, 'x'));
        const QString text = Log::instance().tail(1).at(0).text;
        QVERIFY2(text.startsWith("name\\u000a2026") && text.contains("\\u001b[2J\\u2028"),
                 qPrintable(text.left(100)));
        QVERIFY2(text.size() < 5000 && text.endsWith("characters)"), qPrintable(text.right(40)));
    }
};
