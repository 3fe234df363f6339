// The software trigger with a daemon to watch and call, and a pseudo-terminal for a serial line. A
// pseudo-terminal has neither RTS nor DTR: what is tested is what the program asks of the system, ioctl() of
// this program, which hears it before the system does.
#include "TriggerFixture.h"
#include "tests/support/FreePort.h"

#include <cmath>
#include <cstdarg>
#include <fcntl.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

using namespace hermes;

namespace {

struct SignalChange {
    double time; // monotonic
    int bit;
    bool on;
};
std::vector<SignalChange> signalChanges;
bool hasSignals = true; // what the port is made to seem

} // namespace

extern "C" int ioctl(int descriptor, unsigned long request, ...) noexcept {
    va_list arguments;
    va_start(arguments, request);
    void *const argument = va_arg(arguments, void *);
    va_end(arguments);
    if (hasSignals && (request == TIOCMBIS || request == TIOCMBIC)) {
        signalChanges.push_back({monotonicNow(), *static_cast<int *>(argument), request == TIOCMBIS});
        return 0;
    }
    return int(::syscall(SYS_ioctl, descriptor, request, argument));
}

class TestSoftwareTrigger : public QObject, private TriggerFixture {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void cleanup();
    void firingTellsEverything();
    void failuresAreResults();
    void slowTargetDelaysNothing();
    void targetThatIsAwayDelaysNothing();
    void callsThatWaitAreLimited();
    void scheduleOutlivesTheTarget();
    void conditionOnATopic();
    void conditionOutlivesTheTarget();
    void conditionThatCannotBeWatched();
    void chain();
    void armAndDisarm();
    void changesKeepTheScheduleOfOthers();
    void definitionsSurvive();
    void logHasARowForEachAction();
    void bytesOnASerialLine();
    void pulseOfASerialLine();
    void pulseWithoutTheLine();
    void endTellsWhatWasUnderWay();

private:
    QString openTerminal();

    std::unique_ptr<QTemporaryDir> folder_;
    int farEnd_ = -1, nearEnd_ = -1;
};

void TestSoftwareTrigger::init() {
    folder_ = std::make_unique<QTemporaryDir>();
    signalChanges.clear();
    hasSignals = true;
    setUp({"firings.folder=" + folder_->filePath("log")});
}

void TestSoftwareTrigger::cleanup() {
    tearDown();
    for (int *end : {&farEnd_, &nearEnd_}) {
        if (*end >= 0)
            ::close(*end);
        *end = -1;
    }
}

QString TestSoftwareTrigger::openTerminal() {
    termios raw{};
    cfmakeraw(&raw);
    char name[256] = {};
    if (openpty(&farEnd_, &nearEnd_, name, &raw, nullptr) == 0)
        fcntl(farEnd_, F_SETFL, O_NONBLOCK);
    return "serial://" + QString(name);
}

void TestSoftwareTrigger::firingTellsEverything() {
    QTRY_COMPARE(healthItem("targets")["message"].toString(), QString("connected"));
    QJsonObject count = callTarget("count");
    count["params"] = QJsonObject{{"value", "hello"}};
    define("t", byCommand(), {count});
    QTRY_COMPARE(healthItem("targets")["message"].toString(), QString("connected"));
    const double before = stampNow();
    const QJsonValue firing = fire("t");
    QCOMPARE(firing["id"].toString(), QString("t"));
    QCOMPARE(firing["seq"].toInt(), 1);
    QVERIFY(firing["stamp"].toDouble() >= before && firing["stamp"].toDouble() <= stampNow());
    QCOMPARE(firing["jitter_s"].toDouble(), 0.0);
    QCOMPARE(firing["cause"]["kind"].toString(), QString("command"));
    QCOMPARE(firing["ok"].toBool(), true);
    const QJsonValue result = firing["results"].toArray().at(0);
    QCOMPARE(result["action"].toString(), "call " + targetAddress_ + " count");
    QCOMPARE(result["result"].toInt(), 1);
    QVERIFY(result["duration_s"].toDouble() > 0 && result["duration_s"].toDouble() < 2);
    QCOMPARE(target_->values, QJsonArray{"hello"});
    QCOMPARE(fire("t")["seq"].toInt(), 2);
    QTRY_COMPARE(fired_["t"].size(), 2);
    QCOMPARE(fired_["t"].at(0), firing);
    QCOMPARE(listed("t")["fired"].toInt(), 2);
}

void TestSoftwareTrigger::failuresAreResults() {
    define("t", byCommand(), {callTarget("refuse"), callTarget("no.such"), callTarget("count")});
    QTRY_VERIFY(healthItem("targets")["level"] == "ok");
    const QJsonValue firing = fire("t");
    QCOMPARE(firing["ok"].toBool(true), false);
    const QJsonArray results = firing["results"].toArray();
    QCOMPARE(results.at(0)["error"]["code"].toInt(), int(ErrorCode::DeviceFault));
    QCOMPARE(results.at(0)["error"]["message"].toString(), QString("it is broken"));
    QCOMPARE(results.at(1)["error"]["code"].toInt(), int(ErrorCode::MethodNotFound));
    QCOMPARE(results.at(2)["ok"].toBool(), true);
    QCOMPARE(listed("t")["failed_actions"].toInt(), 2);
    QCOMPARE(healthItem("actions")["level"].toString(), QString("warn"));
    define("t", byCommand(), {callTarget("count")});
    QCOMPARE(fire("t")["ok"].toBool(), true);
    QCOMPARE(healthItem("actions")["level"].toString(), QString("ok"));
    QCOMPARE(healthItem("actions")["values"]["failed"].toInt(), 2);
}

void TestSoftwareTrigger::slowTargetDelaysNothing() {
    define("slow", period(0.02), {callTarget("hang", 0.5)});
    define("quick", period(0.02), {callTarget("count")});
    QTRY_VERIFY(fired_["quick"].size() >= 20);
    QTRY_VERIFY(fired_["slow"].size() >= 20); // each ends with its time-out
    const auto &slow = fired_["slow"];
    double last = 0;
    int timedOut = 0;
    for (const QJsonValue &firing : slow) {
        const QJsonValue result = firing["results"].toArray().at(0);
        timedOut += result["error"]["code"].toInt() == int(ErrorCode::TimedOut);
        if (result["error"]["code"].toInt() == int(ErrorCode::TimedOut))
            QVERIFY(result["duration_s"].toDouble() >= 0.45);
        QVERIFY(firing["mono"].toDouble() > last); // begun one after another, ended so too
        last = firing["mono"].toDouble();
    }
    QVERIFY(timedOut >= 15);
    // Begun at their times: the time-out of 0.5 s has delayed none.
    const double begun = slow.at(19)["mono"].toDouble() - slow.at(0)["mono"].toDouble();
    QVERIFY2(begun < 3, qPrintable(QString::number(begun)));
    QVERIFY(target_->values.size() >= 20);
}

void TestSoftwareTrigger::targetThatIsAwayDelaysNothing() {
    const QString away = QString("127.0.0.1:%1").arg(reservePort()); // where nobody listens
    QJsonObject gone = callTarget("count");
    gone["daemon"] = away;
    define("t", byCommand(), {gone, callTarget("count")});
    QTRY_VERIFY(fire("t")["results"].toArray().at(1)["ok"].toBool());
    const QJsonValue result = fire("t")["results"].toArray().at(0);
    QCOMPARE(result["error"]["code"].toInt(), int(ErrorCode::Disconnected));
    QVERIFY(result["duration_s"].toDouble() < 1);
    QVERIFY(healthItem("targets")["message"].toString().contains(away));
}

void TestSoftwareTrigger::callsThatWaitAreLimited() {
    define("t", period(0.005), {callTarget("hang", 30)});
    QTRY_VERIFY_WITH_TIMEOUT(listed("t")["failed_actions"].toInt() > 100, 20000);
    int refused = 0;
    for (const QJsonValue &firing : fired_["t"])
        refused += firing["results"].toArray().at(0)["error"]["code"].toInt() == int(ErrorCode::OverLimit);
    QVERIFY(refused > 20);
    QVERIFY(healthItem("targets")["values"][targetAddress_]["waiting"].toInt() <= Targets::mostCalls);
}

void TestSoftwareTrigger::scheduleOutlivesTheTarget() {
    define("t", period(0.05), {callTarget("count")});
    QTRY_VERIFY(target_->values.size() >= 3);
    const auto t0 = [](const QJsonValue &firing) {
        return firing["cause"]["due_mono"].toDouble() - 0.05 * firing["cause"]["n"].toDouble();
    };
    const double start = t0(fired_["t"].last());
    stopTarget();
    const auto lastOk = [this] { return fired_["t"].last()["ok"].toBool(); };
    QTRY_VERIFY(!lastOk());
    startTarget(targetAddress_);
    QTRY_VERIFY_WITH_TIMEOUT(lastOk(), 10000);
    QTRY_VERIFY(target_->values.size() >= 3);
    for (const QJsonValue &firing : fired_["t"])
        QVERIFY(std::abs(t0(firing) - start) < 1e-6);
    // Every time of the grid was fired or counted.
    double all = 0;
    for (const QJsonValue &firing : fired_["t"])
        all += 1 + firing["missed"].toDouble();
    QCOMPARE(fired_["t"].last()["cause"]["n"].toDouble(), all);
}

void TestSoftwareTrigger::conditionOnATopic() {
    define("low", condition("battery.0.v", "<", 11), {callTarget("count")});
    waitSubscribed("readings");
    QTRY_COMPARE(listed("low")["problem"].toString(), QString());
    const auto reading = [](double v) { return QJsonObject{{"battery", QJsonArray{QJsonObject{{"v", v}}}}}; };
    for (const double v : {12.0, 10.9, 10.5, 11.0, 12.0, 10.0, 9.0})
        target_->publish("readings", reading(v));
    QTRY_COMPARE(fired_["low"].size(), 2); // each time that it became true
    QCOMPARE(fired_["low"].at(0)["cause"]["value"].toDouble(), 10.9);
    QCOMPARE(fired_["low"].at(1)["cause"]["value"].toDouble(), 10.0);
    QTRY_COMPARE(target_->values.size(), 2);
    target_->publish("readings", QJsonObject{{"battery", "unknown"}});
    QTRY_VERIFY(listed("low")["problem"].toString().contains("battery.0.v"));
    QCOMPARE(listed("low")["watched"]["bad_messages"].toInt(), 1);
    QCOMPARE(healthItem("schedule")["level"].toString(), QString("warn"));
    target_->publish("readings", reading(9));
    QTRY_COMPARE(listed("low")["problem"].toString(), QString());
    QCOMPARE(fired_["low"].size(), 2); // it was true before
}

void TestSoftwareTrigger::conditionOutlivesTheTarget() {
    define("high", condition("", ">", 5));
    waitSubscribed("readings");
    target_->publish("readings", 6);
    QTRY_COMPARE(fired_["high"].size(), 1);
    stopTarget();
    QTRY_VERIFY(listed("high")["problem"].toString().startsWith("not connected"));
    startTarget(targetAddress_);
    QTRY_VERIFY_WITH_TIMEOUT(target_->hasSubscribers("readings"), 10000);
    target_->publish("readings", 7); // as before the restart
    target_->publish("readings", 1);
    target_->publish("readings", 8);
    QTRY_COMPARE(fired_["high"].size(), 2);
    QCOMPARE(fired_["high"].last()["cause"]["value"].toDouble(), 8.0);
}

void TestSoftwareTrigger::conditionThatCannotBeWatched() {
    QJsonObject when = condition("a", "<", 1);
    when["topic"] = "no_such_topic";
    define("t", when);
    QTRY_VERIFY(listed("t")["problem"].toString().contains("no_such_topic"));
    QVERIFY(healthItem("schedule")["message"].toString().contains("no_such_topic"));
}

void TestSoftwareTrigger::chain() {
    define("first", byCommand());
    define("second", after("first"), {callTarget("count")});
    define("third", after("second"), {callTarget("count")});
    define("aside", after("first"));
    QTRY_VERIFY(healthItem("targets")["level"] == "ok");
    fire("first");
    QTRY_COMPARE(fired_["third"].size(), 1);
    QTRY_COMPARE(fired_["aside"].size(), 1);
    QCOMPARE(fired_["third"].at(0)["cause"]["trigger"].toString(), QString("second"));
    QVERIFY(fired_["third"].at(0)["jitter_s"].toDouble() < 1);
    QCOMPARE(target_->values.size(), 2);
    call("trigger.disarm", {{"id", "second"}});
    fire("first");
    QTRY_COMPARE(fired_["aside"].size(), 2);
    QCOMPARE(listed("second")["fired"].toInt(), 1);
    QCOMPARE(listed("third")["fired"].toInt(), 1);
}

void TestSoftwareTrigger::armAndDisarm() {
    define("t", period(0.01));
    QTRY_VERIFY(fired_["t"].size() >= 3);
    QCOMPARE(fire("t")["cause"]["kind"].toString(), QString("command"));
    call("trigger.disarm", {{"id", "t"}});
    const int count = listed("t")["fired"].toInt();
    QCOMPARE(listed("t")["armed"].toBool(true), false);
    QVERIFY(failure("trigger.fire", {{"id", "t"}}).is(ErrorCode::NotReady));
    define("other", period(0.01));
    QTRY_VERIFY(fired_["other"].size() >= 10);
    QCOMPARE(listed("t")["fired"].toInt(), count);
    call("trigger.arm", {{"id", "t"}});
    QTRY_VERIFY(listed("t")["fired"].toInt() > count);
    QTRY_COMPARE(fired_["t"].value(count)["cause"]["n"].toInt() - fired_["t"].value(count)["missed"].toInt(),
                 1); // its time began anew
    call("trigger.remove", {{"id", "t"}});
    QVERIFY(listed("t").isUndefined());
}

void TestSoftwareTrigger::changesKeepTheScheduleOfOthers() {
    define("t", period(0.02));
    QTRY_VERIFY(fired_["t"].size() >= 2);
    const double n = fired_["t"].last()["cause"]["n"].toDouble();
    define("other", period(1));
    define("t", period(0.02), {callTarget("count")}); // other actions, the same time
    QTRY_VERIFY(target_->values.size() >= 2);
    const QJsonValue same = fired_["t"].last();
    QVERIFY(same["cause"]["n"].toDouble() > n);
    const double due = same["cause"]["due_mono"].toDouble();
    const double first = fired_["t"].first()["cause"]["due_mono"].toDouble();
    const double periods = (due - first) / 0.02;
    QVERIFY(std::abs(periods - std::round(periods)) < 1e-4);
}

void TestSoftwareTrigger::definitionsSurvive() {
    client_.reset();
    trigger_->shutDown();
    QFile config(folder_->filePath("settings.json"));
    QVERIFY(config.open(QIODevice::WriteOnly) && config.write("{}") == 2);
    config.close();
    config_ = config.fileName();
    startTrigger();
    define("kept", period(0.05), {callTarget("count")});
    define("off", byCommand());
    call("trigger.disarm", {{"id", "off"}});
    QCOMPARE(call("settings.save")["path"].toString(), config_);
    client_.reset();
    trigger_->shutDown();
    startTrigger();
    QCOMPARE(call("trigger.list").toArray().size(), 2);
    QCOMPARE(listed("off")["armed"].toBool(true), false);
    const int before = target_->values.size();
    QTRY_VERIFY(target_->values.size() > before);
}

void TestSoftwareTrigger::logHasARowForEachAction() {
    define("t", byCommand(), {callTarget("count"), callTarget("refuse")});
    define("none", byCommand());
    QTRY_VERIFY(healthItem("targets")["level"] == "ok");
    const double stamp = fire("t")["stamp"].toDouble();
    fire("none");
    QTRY_COMPARE(healthItem("firings_log")["values"]["rows"].toInt(), 2);
    QFile file(healthItem("firings_log")["values"]["path"].toString());
    QVERIFY(file.open(QIODevice::ReadOnly));
    const QStringList rows = QString(file.readAll()).split('\n');
    QCOMPARE(rows.size(), 5); // the header, three rows, and nothing after the last line feed
    QCOMPARE(rows.at(0).count(','), 10);
    QVERIFY(rows.at(1).startsWith(QString::number(stamp, 'f', 6)));
    QVERIFY(rows.at(1).contains(",t,1,command,"));
    QVERIFY(rows.at(1).contains(" count,1,"));
    QVERIFY(rows.at(2).contains(" refuse,0,"));
    QVERIFY(rows.at(2).endsWith("it is broken"));
    QVERIFY(rows.at(3).contains(",none,1,command,"));
    QCOMPARE(rows.at(4), QString());
}

void TestSoftwareTrigger::bytesOnASerialLine() {
    const QString url = openTerminal();
    define("text", byCommand(), {QJsonObject{{"do", "serial"}, {"url", url}, {"text", "Grüße\r\n"}}});
    define("hex", byCommand(), {QJsonObject{{"do", "serial"}, {"url", url}, {"hex", "00ff1103"}}});
    QTRY_VERIFY(healthItem("serial_lines")["level"] == "ok");
    QVERIFY2(fire("text")["ok"].toBool(), qPrintable(healthItem("actions")["message"].toString()));
    QVERIFY(fire("hex")["ok"].toBool());
    QByteArray received;
    const QByteArray expected = QByteArray("Grüße\r\n") + QByteArray::fromHex("00ff1103");
    const auto read = [&] {
        char buffer[64];
        const ssize_t size = ::read(farEnd_, buffer, sizeof buffer);
        received.append(buffer, int(std::max<ssize_t>(size, 0)));
        return received.size() >= expected.size();
    };
    QTRY_VERIFY(read());
    QCOMPARE(received, expected);
    define("nowhere", byCommand(),
           {QJsonObject{{"do", "serial"}, {"url", "serial:///dev/no-such-line"}, {"text", "a"}}});
    const QJsonValue result = fire("nowhere")["results"].toArray().at(0);
    QVERIFY(result["error"]["message"].toString().contains("no-such-line"));
    QVERIFY(healthItem("serial_lines")["message"].toString().contains("no-such-line"));
}

void TestSoftwareTrigger::pulseOfASerialLine() {
    const QString url = openTerminal();
    const QJsonObject pulse{{"do", "pulse"}, {"url", url}, {"line", "rts"}, {"length_s", 0.1}};
    define("t", byCommand(), {pulse});
    QTRY_COMPARE(signalChanges.size(), size_t(1)); // low from the opening on
    QCOMPARE(signalChanges[0].bit, TIOCM_RTS);
    QCOMPARE(signalChanges[0].on, false);
    const QJsonValue firing = fire("t");
    QVERIFY(firing["ok"].toBool());
    QCOMPARE(signalChanges.size(), size_t(3));
    QVERIFY(signalChanges[1].on && !signalChanges[2].on);
    QCOMPARE(signalChanges[2].bit, TIOCM_RTS);
    const double length = signalChanges[2].time - signalChanges[1].time;
    QVERIFY2(length >= 0.099 && length < 1, qPrintable(QString::number(length)));
    // At the firing, and within the time that is told.
    const double begin = firing["mono"].toDouble();
    const double end = begin + firing["results"].toArray().at(0)["duration_s"].toDouble();
    QVERIFY(signalChanges[1].time >= begin && signalChanges[2].time <= end + 1e-3);
    // Two pulses of one line do not overlap.
    define("both", byCommand(), {pulse, pulse});
    const QJsonArray results = fire("both")["results"].toArray();
    QVERIFY(results.at(0)["ok"].toBool());
    QCOMPARE(results.at(1)["error"]["code"].toInt(), int(ErrorCode::NotReady));
    QCOMPARE(signalChanges.size(), size_t(5));
}

void TestSoftwareTrigger::pulseWithoutTheLine() {
    hasSignals = false;
    const QString url = openTerminal();
    define("t", byCommand(),
           {QJsonObject{{"do", "pulse"}, {"url", url}, {"line", "dtr"}, {"length_s", 0.1}},
            QJsonObject{{"do", "serial"}, {"url", url}, {"text", "a"}}});
    const QJsonArray results = fire("t")["results"].toArray();
    QCOMPARE(results.at(0)["error"]["code"].toInt(), int(ErrorCode::DeviceFault));
    QVERIFY2(results.at(0)["error"]["message"].toString().contains("DTR"),
             qPrintable(results.at(0)["error"]["message"].toString()));
    QVERIFY(results.at(1)["ok"].toBool()); // the port works on
}

void TestSoftwareTrigger::endTellsWhatWasUnderWay() {
    define("t", byCommand(), {callTarget("hang", 30)});
    QTRY_VERIFY(healthItem("targets")["level"] == "ok");
    client_->call("trigger.fire", QJsonObject{{"id", "t"}}, [](const Result<QJsonValue> &) {});
    QTRY_COMPARE(int(target_->kept.size()), 1);
    trigger_->shutDown();
    const QDir folder(folder_->filePath("log"));
    QFile file(folder.filePath(folder.entryList(QDir::Files).value(0)));
    QVERIFY(file.open(QIODevice::ReadOnly));
    QVERIFY(file.readAll().contains("hang,0,"));
}

QTEST_GUILESS_MAIN(TestSoftwareTrigger)
#include "TestSoftwareTrigger.moc"
