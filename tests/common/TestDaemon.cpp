#include "DaemonFixture.h"
#include "common/daemon/PastFaults.h"
#include "protocol/wire/Fields.h"

using namespace hermes;

class TestDaemon : public QObject, DaemonFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void commonCommands_data() {
        const Rows<QJsonValue, QString> row("params", "member"); // member: of the result
        row("rpc.discover", QJsonValue(QJsonObject()), "openrpc");
        row("daemon.info", QJsonValue(QJsonObject()), "description_hash");
        row("daemon.status", QJsonValue(QJsonObject()), "health");
        row("settings.schema", QJsonValue(QJsonObject()), "properties");
        row("settings.get", QJsonValue(QJsonArray{"limits"}), "clients");
        row("settings.reset", QJsonValue(QJsonObject()), "changed");
        row("topics.list", QJsonValue(QJsonObject()), "");
        row("log.tail", QJsonValue(QJsonArray{10}), "");
    }

    void commonCommands() {
        FETCH(QJsonValue, params, QString, member);
        RawClient client(address());
        const QJsonObject reply = client.ask(QTest::currentDataTag(), params);
        QVERIFY2(reply.contains("result"), compactJson(reply));
        QVERIFY(member.isEmpty() ? reply["result"].isArray() : reply["result"].toObject().contains(member));
    }

    void descriptionIsComplete() {
        const QJsonObject description = daemon->description();
        bool found = false;
        for (const QJsonValue &method : description["methods"].toArray()) {
            QVERIFY2(!method["summary"].toString().isEmpty(), qPrintable(method["name"].toString()));
            QVERIFY(method["params"].isArray() && method["result"]["schema"].isObject());
            for (const QJsonValue &param : method["params"].toArray())
                QVERIFY(!param["schema"]["description"].toString().isEmpty());
            if (method["name"].toString() == "subtract") {
                found = true;
                QCOMPARE(method["examples"][0]["result"]["value"].toInt(), 19);
            }
        }
        QVERIFY(found);
        QCOMPARE(description["x-topics"].toArray().size(), 6);
        const QString hash = daemon->descriptionHash();
        start();
        QCOMPARE(daemon->descriptionHash(), hash);
    }

    void settingsOverTheWire() {
        RawClient client(address());
        const auto refused =
            client.ask("settings.set", QJsonObject{{"values", QJsonObject{{"gain", 11}, {"foo", 1}}}});
        QCOMPARE(refused["error"].toObject()["code"].toInt(), -32003);
        QCOMPARE(refused["error"].toObject()["data"].toObject()["errors"].toArray().size(), 2);
        QCOMPARE(daemon->settings().number("gain"), 1.0);
        const auto set = client.ask("settings.set", QJsonObject{{"values", QJsonObject{{"gain", 2}}}});
        QCOMPARE(set["result"].toObject()["changed"].toArray(), QJsonArray{"gain"});
        QCOMPARE(client.ask("settings.get", QJsonArray{"gain"})["result"].toDouble(), 2.0);
        QCOMPARE(client.ask("settings.get", QJsonArray{"", true})["result"].toObject()["gain"].toDouble(),
                 2.0);
        QCOMPARE(client.ask("settings.get", QJsonArray{"no"})["error"].toObject()["code"].toInt(), -32003);
        QCOMPARE(client.ask("settings.save")["error"].toObject()["code"].toInt(),
                 -32008); // no file was given
    }

    void wrongFileIsNoWrongCommandLine_data() {
        const Rows<QStringList, bool, int> row("options", "withFile", "status");
        const QStringList clash{"--set", "offset=4"}, type{"--set", "offset=many"},
            unknown{"--set", "ofset=1"};
        row("clash with the file", clash, true, 1);
        row("clash with a default", clash, false, 2);
        row("type", type, true, 2);
        row("unknown", unknown, true, 2);
        row("address", {"--listen", "no://where"}, true, 2);
        row("goes together", {"--set", "offset=2"}, true, 0);
    }

    /// What may be mended in the file is tried again by the supervisor, a wrong command line not.
    void wrongFileIsNoWrongCommandLine() {
        FETCH(QStringList, options, bool, withFile, int, status);
        const QTemporaryDir folder;
        put(folder.filePath("tested.json"), "{\"gain\": 3}");
        TestedDaemon tested;
        tested.settings().declare(Field::number("offset", "At most the gain").byDefault(0));
        tested.settings().addRule([](const QJsonObject &values) -> std::vector<SchemaViolation> {
            if (values["offset"].toDouble() > values["gain"].toDouble())
                return {{"offset", values["offset"], "at most gain"}};
            return {};
        });
        QStringList line{"tested", "--check"};
        if (withFile)
            line << "--config" << folder.filePath("tested.json");
        QCOMPARE(tested.prepare(line + options).value_or(-1), status);
    }

    void networkNeedsInsecure() {
        TestedDaemon open;
        QVERIFY(!open.prepare({"tested", "--listen", "tcp://0.0.0.0:0"}));
        const auto refused = open.launch();
        QVERIFY(!refused);
        VERIFY_CONTAINS(refused.error().message, "insecure");
        TestedDaemon insecure;
        QVERIFY(!insecure.prepare({"tested", "--listen", "tcp://0.0.0.0:0", "--set", "insecure=true"}));
        QVERIFY(insecure.launch());
        const QByteArray status = compactJson(asJson(insecure.status()));
        QVERIFY2(status.contains("\"level\":\"warn\"") && status.contains("\"name\":\"insecure\""), status);
    }

    void healthDegradesAndGoesStale() {
        RawClient client(address());
        client.ask("topics.subscribe", QJsonArray{"status"});
        QCOMPARE(client.message()["params"].toObject()["data"].toObject()["state"].toString(),
                 QString("ready"));
        daemon->health().set("sensor", HealthLevel::Failed, "unplugged");
        QCOMPARE(client.message()["params"].toObject()["data"].toObject()["state"].toString(),
                 QString("degraded"));
        daemon->health().set("sensor", HealthLevel::Ok, "fine");
        QCOMPARE(client.message()["params"].toObject()["data"].toObject()["state"].toString(),
                 QString("ready"));
        daemon->health().expectEvery("sensor", std::chrono::milliseconds(1));
        const QByteArray stale = client.line(); // told without being asked
        QVERIFY2(stale.contains("\"stale\"") && stale.contains("degraded"), stale);
        daemon->setState(DaemonState::Fault);
        QVERIFY(daemon->state() == DaemonState::Fault);
    }

    void whatIsPastIsNoWarning() {
        auto warns = [faults = PastFaults()](double count, double mono) mutable {
            return faults.level(count, mono) == HealthLevel::Warn;
        };
        const double end = PastFaults::window_s;
        QVERIFY(!warns(0, 0));
        QVERIFY(warns(3, 10) && warns(3, 9.9 + end) && !warns(3, 10 + end));
        QVERIFY(warns(4, 20 + end) && warns(4, 19.9 + 2 * end) && !warns(4, 1000));
        QVERIFY(warns(3, 1001 + end) && !warns(3, 1001 + 2 * end) && !warns(0, 1002 + 2 * end)); // begun anew
        QVERIFY(warns(1, 1003 + 2 * end) && !warns(1, 1003 + 3 * end));
    }

    void logIsATopic() {
        RawClient client(address());
        client.ask("topics.subscribe", QJsonArray{"log", 0, 100});
        std::thread([] { logWarning("worker", "from a thread"); }).join();
        QTRY_VERIFY(client.socket.canReadLine());
        const QJsonObject record = client.message()["params"].toObject()["data"].toObject();
        QCOMPARE(record["text"].toString(), QString("from a thread"));
        QCOMPARE(record["level"].toString(), QString("warning"));
    }

    void theLogIsGivenUpToAMebibyte() {
        for (int i = 0; i < 40; ++i)
            logInfo("test", QString("%1 ").arg(i) + QString(60000, 'x'));
        const QJsonArray records = RawClient(address()).ask("log.tail", QJsonArray{1000})["result"].toArray();
        QVERIFY(compactJson(records).size() <= Log::maxTailBytes + 61000);
        QVERIFY(records.size() > 10);
        QVERIFY(records.last()["text"].toString().startsWith("39 "));
    }

    void degreesForRadiansAreTold() {
        RawClient client(address());
        const auto last = [] { return Log::instance().tail(1).back(); };
        client.ask("turn", QJsonObject{{"by", 6.28}});
        QVERIFY2(!last().text.contains("turns"), qPrintable(last().text));
        QCOMPARE(client.ask("turn", QJsonObject{{"by", 90}})["result"].toDouble(), 90.0);
        QCOMPARE(last().text, QString("by: 90 rad is 14.3 turns; did you mean 1.571 rad (90 degrees)?"));
        client.ask("settings.set", QJsonObject{{"values", QJsonObject{{"heading", -180}}}});
        QCOMPARE(last().text,
                 QString("heading: -180 rad is 28.6 turns; did you mean -3.142 rad (-180 degrees)?"));
        start({"heading=45"});
        const std::vector<LogMessage> log = Log::instance().tail(100);
        QVERIFY(std::any_of(log.begin(), log.end(), [](const LogMessage &one) {
            return one.level == "warning" && one.text.startsWith("heading: 45 rad is 7.16 turns");
        }));
    }
};
