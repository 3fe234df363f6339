#include "DaemonFixture.h"

using namespace hermes;

class TestDaemonTopics : public QObject, DaemonFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void subscribeWithSnapshotAndUnsubscribe() {
        RawClient client(address());
        QVERIFY(!daemon->hasSubscribers("state"));
        const QJsonValue id =
            client.ask("topics.subscribe", QJsonArray{"state"})["result"].toObject()["subscription"];
        const QJsonObject first = client.message();
        QCOMPARE(first["method"].toString(), QString("topic"));
        QCOMPARE(first["params"].toObject()["data"].toString(), QString("all"));
        QCOMPARE(first["params"].toObject()["subscription"].toInt(), id.toInt());
        daemon->publish("state", "news", 12.5);
        const QJsonObject second = client.message()["params"].toObject();
        QCOMPARE(second["stamp"].toDouble(), 12.5);
        QCOMPARE(second["seq"].toInt(), 1);
        QCOMPARE(second["dropped"].toInt(), 0);
        RawClient other(address());
        QCOMPARE(other.ask("topics.unsubscribe", QJsonArray{id})["error"].toObject()["code"].toInt(), -32006);
        QVERIFY(client.ask("topics.unsubscribe", QJsonArray{id}).contains("result"));
        QVERIFY(!daemon->hasSubscribers("state"));
        QCOMPARE(client.ask("topics.subscribe", QJsonArray{"none"})["error"].toObject()["code"].toInt(),
                 -32006);
        QCOMPARE(
            client.ask("topics.subscribe", QJsonArray{"state", 0, 0})["error"].toObject()["code"].toInt(),
            -32602);
    }

    void rateIsLimitedAndNewestArrives() {
        RawClient client(address());
        client.ask("topics.subscribe", QJsonArray{"numbers", 20});
        auto clock = runningTimer();
        for (int i = 1; i <= 100; ++i)
            daemon->publish("numbers", i);
        QCOMPARE(client.message()["params"].toObject()["seq"].toInt(), 1);
        QJsonObject last;
        int messages = 0;
        for (; last["seq"].toInt() < 100; ++messages) { // held until its time, then the newest
            last = client.message()["params"].toObject();
            QVERIFY(!last.isEmpty());
        }
        QCOMPARE(last["dropped"].toInt(), 0); // thinned on request, not lost
        QVERIFY(clock.elapsed() >= 40);
        QVERIFY(messages <= 1 + clock.elapsed() / 50);
    }

    // Not at once, as a period that no timer can hold would be, over and over.
    void aTinyRateIsNeverDue() {
        static int warnings = 0;
        const auto handler = qInstallMessageHandler(
            [](QtMsgType, const QMessageLogContext &, const QString &) { ++warnings; });
        RawClient client(address());
        for (const double rate_hz : {1e-300, 5e-324, 1e-7})
            QVERIFY(client.ask("topics.subscribe", QJsonArray{"numbers", rate_hz}).contains("result"));
        for (int i = 0; i < 3; ++i) {
            daemon->publish("numbers", i);
            QTest::qWait(5); // in which a timer that is due at once would come
        }
        qInstallMessageHandler(handler);
        QCOMPARE(warnings, 0);
    }

    void slowReaderLosesTopicsButNoReplies() {
        RawClient client(address());
        client.socket.setReadBufferSize(1024);
        client.ask("topics.subscribe", QJsonArray{"numbers", 0, 20});
        const QString payload(20000, 'x');
        int published = 0;
        for (; published < 600; ++published) {
            daemon->publish("numbers", QJsonObject{{"text", payload}});
            if (published % 20 == 0)
                client.request(1000 + published, "subtract", QJsonArray{published, 0});
            QTest::qWait(0);
        }
        QVERIFY(daemon->server().counters()["dropped_topic_messages"].toInt() > 0);
        client.socket.setReadBufferSize(0);
        int replies = 0;
        int topics = 0;
        QJsonObject last;
        while (replies < 30 || last["seq"].toInt() < published) {
            const QJsonObject message = client.message();
            QVERIFY(!message.isEmpty());
            if (message.contains("id")) {
                QCOMPARE(message["id"].toInt(), 1000 + replies++ * 20);
            } else {
                ++topics;
                QVERIFY(message["params"].toObject()["seq"].toInt() > last["seq"].toInt());
                last = message["params"].toObject();
            }
        }
        QCOMPARE(replies, 30);
        daemon->publish("numbers", QJsonObject()); // a drop is counted in the messages that follow it
        last = client.message()["params"].toObject();
        QCOMPARE(last["seq"].toInt(), topics + 1 + last["dropped"].toInt());
    }
};
