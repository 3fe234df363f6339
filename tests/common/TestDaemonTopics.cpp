#include "DaemonFixture.h"
#include "tests/support/Rows.h"
#include "tests/support/Texts.h"

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

    void aReplayTakesThePlaceOfATopic() {
        RawClient viewer(address());
        viewer.ask("topics.subscribe", QJsonArray{"state"});
        QCOMPARE(params(viewer)["data"].toString(), QString("all"));
        auto player = std::make_unique<RawClient>(address());
        const auto replay = [&](const QJsonValue &data) {
            return player->ask("topics.replay",
                               QJsonObject{{"topic", "state"}, {"stamp", 5.5}, {"data", data}});
        };
        QVERIFY(replay("then")["result"].isNull());
        const QJsonObject shown = params(viewer);
        QVERIFY(shown["replayed"].toBool());
        QCOMPARE(shown["stamp"].toDouble(), 5.5);
        QCOMPARE(shown["data"].toString(), QString("then"));
        daemon->publish("state", "now");
        QVERIFY(!daemon->hasSubscribers("state")); // to the live data nobody listens
        RawClient late(address());
        late.ask("topics.subscribe", QJsonArray{"state"});
        QCOMPARE(params(late)["data"].toString(), QString("then"));
        for (const char *key : {"data", "live"}) {
            const QJsonObject refused =
                late.ask("topics.replay", QJsonObject{{"topic", "state"}, {key, true}})["error"].toObject();
            QCOMPARE(refused["code"].toInt(), -32005);
            VERIFY_CONTAINS(refused["message"].toString(), "is replayed by tcp://127.0.0.1");
        }
        VERIFY_CONTAINS(healthOf("topics"), "warn: replayed, not live: state (by tcp://127.0.0.1");
        replay(QJsonArray{1, QJsonObject{{"a", QJsonValue()}}});
        QCOMPARE(params(viewer)["data"].toArray().size(), 2); // and nothing of what was live meanwhile
        player->ask("topics.replay", QJsonObject{{"topic", "state"}, {"live", true}});
        const QJsonObject live = params(viewer);
        QCOMPARE(live["data"].toString(), QString("all"));
        QVERIFY(!live.contains("replayed"));
        QCOMPARE(healthOf("topics"), QString());
        replay("again");
        QCOMPARE(params(viewer)["data"].toString(), QString("again"));
        player.reset();
        QCOMPARE(params(viewer)["data"].toString(), QString("all"));
    }

    void whatIsNotReplayed_data() {
        const Rows<QString, QJsonObject, int> row("topic", "params", "code");
        for (const char *topic : {"log", "status", "settings", "commands", "processes", "session"})
            row(topic, topic, {{"data", 1}}, -32602);
        row("unknown", "none", QJsonObject{{"data", 1}}, -32006);
        row("no data", "numbers", QJsonObject{}, -32602);
        row("stamp", "numbers", QJsonObject{{"data", 1}, {"stamp", -1}}, -32602);
    }
    void whatIsNotReplayed() {
        FETCH(QString, topic, QJsonObject, params, int, code);
        params["topic"] = topic;
        QCOMPARE(RawClient(address()).ask("topics.replay", params)["error"].toObject()["code"].toInt(), code);
        QCOMPARE(healthOf("topics"), QString());
    }

    void commandsAreToldToEngineers_data() {
        const Rows<QString, int> row("role", "refusal");
        row("engineer", "engineer", 0);
        row("operator", "operator", -32001);
        row("observer", "observer", -32001);
    }
    void commandsAreToldToEngineers() {
        FETCH(QString, role, int, refusal);
        start({"access.plain=\"" + role + "\"", "audit.on=false"});
        RawClient client(address());
        const QJsonObject answer = client.ask("topics.subscribe", QJsonArray{"commands"});
        QCOMPARE(answer["error"].toObject()["code"].toInt(), refusal);
        if (refusal != 0)
            return;
        RawClient other(address());
        other.ask("settings.get");
        other.ask("settings.set", QJsonObject{{"values", QJsonObject{{"gain", 2}}}});
        other.ask("settings.set", QJsonObject{{"values", QJsonObject{{"gain", 20}}}});
        const QJsonValue first = params(client), second = params(client);
        QCOMPARE(first["data"]["method"].toString(), QString("settings.set"));
        QCOMPARE(first["data"]["params"]["values"]["gain"].toInt(), 2);
        QCOMPARE(first["data"]["stamp"].toDouble(), first["stamp"].toDouble());
        QVERIFY(first["data"]["error"].isUndefined());
        QCOMPARE(second["data"]["error"].toInt(), -32003);
    }

private:
    static QJsonObject params(RawClient &client) { return client.message()["params"].toObject(); }
    QString healthOf(const QString &item) {
        for (const HealthItem &one : daemon->status().health)
            if (one.name == item)
                return one.level + ": " + one.message;
        return {};
    }
};
