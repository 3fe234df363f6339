// What may be defined as a trigger, and what is refused with which words.
#include "TriggerFixture.h"
#include "daemons/softwaretrigger/GpioLines.h"

using namespace hermes;
using namespace hermes::softwaretrigger;

class TestTriggerRules : public QObject, private TriggerFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }
    void refuses_data();
    void refuses();
    void accepts();
    void opensNothingButGpioChips();
    void refusesCycles();
    void refusesToRemoveWhatOthersFollow();
    void refusesNumbersThatAreNone();
    void refusesTooMany();
    void settingsFollowTheSameRules();
    void unknownIds();
};

void TestTriggerRules::refuses_data() {
    Rows<QByteArray, QString>("trigger", "path");
    const auto row = [](const char *name, const char *when, const char *actions, const char *path) {
        QTest::newRow(name) << QByteArray(R"({"id": "t", "when": )") + when + R"(, "actions": )" + actions +
                                   "}"
                            << QString(path);
    };
    const char *const command = R"({"kind": "command"})";
    row("no kind", "{}", "[]", "when.kind");
    row("unknown kind", R"({"kind": "often"})", "[]", "when.kind");
    row("no period", R"({"kind": "period"})", "[]", "when.period_s");
    row("period 0", R"({"kind": "period", "period_s": 0})", "[]", "when.period_s");
    row("period too short", R"({"kind": "period", "period_s": 0.0009})", "[]", "when.period_s");
    row("period too long", R"({"kind": "period", "period_s": 604801})", "[]", "when.period_s");
    row("period of text", R"({"kind": "period", "period_s": "1"})", "[]", "when.period_s");
    row("member of another kind", R"({"kind": "period", "period_s": 1, "at": "12:00"})", "[]", "when.at");
    row("unknown member", R"({"kind": "period", "period_s": 1, "perod": 1})", "[]", "when.perod");
    row("distance below 0", R"({"kind": "distance", "distance_m": -1})", "[]", "when.distance_m");
    row("hour 25", R"({"kind": "time_of_day", "at": "25:00"})", "[]", "when.at");
    row("no time", R"({"kind": "time_of_day", "at": "noon"})", "[]", "when.at");
    row("unknown zone", R"({"kind": "time_of_day", "at": "12:00", "zone": "mars"})", "[]", "when.zone");
    row("unknown daemon",
        R"({"kind": "condition", "daemon": "toaster", "topic": "t", "path": "a", "op": "<", "value": 1})",
        "[]", "when.daemon");
    row("unknown scheme",
        R"({"kind": "condition", "daemon": "http://a:1", "topic": "t", "path": "a", "op": "<", "value": 1})",
        "[]", "when.daemon");
    row("no port",
        R"({"kind": "condition", "daemon": "tcp://a", "topic": "t", "path": "a", "op": "<", "value": 1})",
        "[]", "when.daemon");
    row("path with two dots",
        R"({"kind": "condition", "daemon": "simulator", "topic": "t", "path": "a..b", "op": "<", "value": 1})",
        "[]", "when.path");
    row("path with a blank",
        R"({"kind": "condition", "daemon": "simulator", "topic": "t", "path": "a b", "op": "<", "value": 1})",
        "[]", "when.path");
    row("unknown operator",
        R"({"kind": "condition", "daemon": "simulator", "topic": "t", "path": "a", "op": "~", "value": 1})",
        "[]", "when.op");
    row("order of texts",
        R"({"kind": "condition", "daemon": "simulator", "topic": "t", "path": "a", "op": "<", "value": "b"})",
        "[]", "when.value");
    row("no value", R"({"kind": "condition", "daemon": "simulator", "topic": "t", "path": "a", "op": "<"})",
        "[]", "when.value");
    row("follows itself", R"({"kind": "trigger", "trigger": "t"})", "[]", "when.trigger");
    row("follows nobody", R"({"kind": "trigger", "trigger": "nobody"})", "[]", "when.trigger");
    row("unknown action", command, R"([{"do": "dance"}])", "actions.0.do");
    row("call without method", command, R"([{"do": "call", "daemon": "simulator"}])", "actions.0.method");
    row("call of a sentence", command, R"([{"do": "call", "daemon": "simulator", "method": "go away"}])",
        "actions.0.method");
    row("call of a stranger", command, R"([{"do": "call", "daemon": "toaster", "method": "on"}])",
        "actions.0.daemon");
    row("call of itself", command,
        R"([{"do": "call", "daemon": "softwaretrigger", "method": "trigger.fire", "params": {"id": "t"}}])",
        "actions.0.method");
    row("params as list", command, R"([{"do": "call", "daemon": "simulator", "method": "a", "params": []}])",
        "actions.0.params");
    row("time-out 0", command, R"([{"do": "call", "daemon": "simulator", "method": "a", "timeout_s": 0}])",
        "actions.0.timeout_s");
    row("second action", command,
        R"([{"do": "call", "daemon": "simulator", "method": "a"}, {"do": "serial", "url": "serial:///dev/x"}])",
        "actions.1.text");
    row("text and hex", command, R"([{"do": "serial", "url": "serial:///dev/x", "text": "a", "hex": "61"}])",
        "actions.0.text");
    row("odd hex", command, R"([{"do": "serial", "url": "serial:///dev/x", "hex": "616"}])", "actions.0.hex");
    row("no hex", command, R"([{"do": "serial", "url": "serial:///dev/x", "hex": "xy"}])", "actions.0.hex");
    row("serial over tcp", command, R"([{"do": "serial", "url": "tcp://a:1", "text": "a"}])",
        "actions.0.url");
    row("unknown line", command,
        R"([{"do": "pulse", "url": "serial:///dev/x", "line": "cts", "length_s": 1}])", "actions.0.line");
    row("pulse too long", command,
        R"([{"do": "pulse", "url": "serial:///dev/x", "line": "rts", "length_s": 61}])",
        "actions.0.length_s");
    row("half a line", command, R"([{"do": "gpio", "chip": "gpiochip0", "offset": 1.5, "length_s": 1}])",
        "actions.0.offset");
}

void TestTriggerRules::refuses() {
    FETCH(QByteArray, trigger, QString, path);
    const QJsonDocument json = QJsonDocument::fromJson(trigger);
    QVERIFY(json.isObject());
    const Error error = failure("trigger.define", json.object());
    QVERIFY2(error.is(ErrorCode::InvalidParams), qPrintable(error.message));
    const QJsonArray errors = error.data["errors"].toArray();
    QVERIFY(!errors.isEmpty());
    QCOMPARE(errors.at(0)["path"].toString(), path);
    QVERIFY(!errors.at(0)["expected"].toString().isEmpty());
    VERIFY_CONTAINS(error.message, path);
    QCOMPARE(call("trigger.list").toArray(), QJsonArray());
}

void TestTriggerRules::accepts() {
    define("period", period(0.001));
    define("distance", {{"kind", "distance"}, {"distance_m", 0.5}, {"daemon", targetAddress_}});
    define("angle", {{"kind", "angle"}, {"angle_rad", 1}, {"daemon", targetAddress_}, {"topic", "odometry"}});
    define("noon", {{"kind", "time_of_day"}, {"at", "12:00:00.500"}, {"zone", "utc"}});
    define("condition", condition("a.0.b", "==", QJsonValue()));
    define("after", after("period"));
    QJsonArray actions{
        callTarget("count"),
        QJsonObject{{"do", "serial"}, {"url", "serial:///dev/none?baud=9600"}, {"hex", "00ff"}},
        QJsonObject{{"do", "pulse"}, {"url", "serial:///dev/none"}, {"line", "dtr"}, {"length_s", 0.1}},
        QJsonObject{{"do", "gpio"}, {"chip", "no-such-chip"}, {"offset", 3}, {"length_s", 0.1}}};
    define("command", byCommand(), actions);
    QCOMPARE(call("trigger.list").toArray().size(), 7);
    QCOMPARE(listed("command")["actions"].toArray(), actions);
}

void TestTriggerRules::opensNothingButGpioChips() {
    for (const char *chip : {"/dev/null", "null", "/dev", "no-such-chip", "99"}) {
        const Result<void> set = GpioLines().set(chip, 3, true);
        QVERIFY(!set);
        QVERIFY(set.error().is(ErrorCode::DeviceFault));
        VERIFY_STARTS(set.error().message,
                      QString("GPIO chip %1, line 3: cannot open the chip: No such ").arg(chip));
    }
}

void TestTriggerRules::refusesCycles() {
    define("a", byCommand());
    define("b", after("a"));
    define("c", after("b"));
    const Error error =
        failure("trigger.define", {{"id", "a"}, {"when", after("c")}, {"actions", QJsonArray()}});
    QVERIFY(error.is(ErrorCode::InvalidParams));
    VERIFY_CONTAINS(error.message, "chain");
    QCOMPARE(listed("a")["when"].toObject(), byCommand()); // nothing has changed
    define("d", after("a"));                               // a tree is no cycle
}

void TestTriggerRules::refusesToRemoveWhatOthersFollow() {
    define("a", byCommand());
    define("b", after("a"));
    QVERIFY(failure("trigger.remove", {{"id", "a"}}).is(ErrorCode::InvalidParams));
    QCOMPARE(call("trigger.remove", {{"id", "b"}}), QJsonValue());
    QCOMPARE(call("trigger.remove", {{"id", "a"}}), QJsonValue());
    QCOMPARE(call("trigger.list").toArray(), QJsonArray());
}

// JSON has none, but its numbers may be too large, and programs of the same process may give any.
void TestTriggerRules::refusesNumbersThatAreNone() {
    for (const double none : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        const QJsonObject actionless{{"id", "t"}, {"when", period(none)}, {"actions", QJsonArray()}};
        QVERIFY(!trigger_->settings().set({{"triggers", QJsonArray{actionless}}}).ok());
        const QJsonObject compared{
            {"id", "t"}, {"when", condition("a", "<", none)}, {"actions", QJsonArray()}};
        QVERIFY(!trigger_->settings().set({{"triggers", QJsonArray{compared}}}).ok());
    }
}

void TestTriggerRules::refusesTooMany() {
    QJsonArray triggers;
    for (int i = 0; i < 101; ++i)
        triggers.append(
            QJsonObject{{"id", QString("t%1").arg(i)}, {"when", byCommand()}, {"actions", QJsonArray()}});
    QVERIFY(failure("settings.set", {{"values", QJsonObject{{"triggers", triggers}}}})
                .is(ErrorCode::InvalidSetting));
    triggers.removeLast();
    call("settings.set", {{"values", QJsonObject{{"triggers", triggers}}}});
    QCOMPARE(call("trigger.list").toArray().size(), 100);
    QVERIFY(failure("trigger.define", {{"id", "more"}, {"when", byCommand()}, {"actions", QJsonArray()}})
                .is(ErrorCode::InvalidParams));
}

void TestTriggerRules::settingsFollowTheSameRules() {
    const QJsonObject one{{"id", "same"}, {"when", byCommand()}, {"actions", QJsonArray()}};
    const Error error =
        failure("settings.set", {{"values", QJsonObject{{"triggers", QJsonArray{one, one}}}}});
    QVERIFY(error.is(ErrorCode::InvalidSetting));
    QCOMPARE(error.data["errors"].toArray().at(0)["path"].toString(), QString("triggers.1.id"));
    const QJsonObject schema = call("settings.schema").toObject();
    QVERIFY(
        schema["properties"]["triggers"]["items"]["properties"]["when"]["properties"]["period_s"]["minimum"]
            .isDouble());
}

void TestTriggerRules::unknownIds() {
    define("known", byCommand());
    for (const char *method : {"trigger.remove", "trigger.arm", "trigger.disarm", "trigger.fire"}) {
        const Error error = failure(method, {{"id", "stranger"}});
        QVERIFY(error.is(ErrorCode::InvalidParams));
        VERIFY_CONTAINS(error.message, "known");
    }
    QVERIFY(
        failure("trigger.define", {{"id", "with blank"}, {"when", byCommand()}, {"actions", QJsonArray()}})
            .is(ErrorCode::InvalidParams));
}
