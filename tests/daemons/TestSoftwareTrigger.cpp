#include "TriggerFixture.h"

using namespace hermes;
using namespace hermes::softwaretrigger;

class TestSoftwareTrigger : public QObject, TriggerFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        folder_ = std::make_unique<QTemporaryDir>();
        setUp({"firings.folder=" + folder_->filePath("log")});
    }

    void cleanup() { tearDown(); }

    void firingTellsEverything() {
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

    void chain() {
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

    void armAndDisarm() {
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
        QTRY_COMPARE(fired_["t"].value(count)["cause"]["n"].toInt() -
                         fired_["t"].value(count)["missed"].toInt(),
                     1); // its time began anew
        call("trigger.remove", {{"id", "t"}});
        QVERIFY(listed("t").isUndefined());
    }

    void changesKeepTheScheduleOfOthers() {
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

    void definitionsSurvive() {
        client_.reset();
        trigger_->shutDown();
        put(folder_->filePath("settings.json"), "{}");
        config_ = folder_->filePath("settings.json");
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

    void logHasARowForEachAction() {
        define("t", byCommand(), {callTarget("count"), callTarget("refuse")});
        define("none", byCommand());
        QTRY_VERIFY(healthItem("targets")["level"] == "ok");
        const double stamp = fire("t")["stamp"].toDouble();
        fire("none");
        QTRY_COMPARE(healthItem("firings_log")["values"].toObject()["rows"].toInt(), 2);
        const QStringList rows =
            QString(contentOf(healthItem("firings_log")["values"].toObject()["path"].toString())).split('\n');
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

    void endTellsWhatWasUnderWay() {
        define("t", byCommand(), {callTarget("hang", 30)});
        QTRY_VERIFY(healthItem("targets")["level"] == "ok");
        client_->call("trigger.fire", QJsonObject{{"id", "t"}}, [](const Result<QJsonValue> &) {});
        QTRY_COMPARE(int(target_->kept.size()), 1);
        trigger_->shutDown();
        const QDir folder(folder_->filePath("log"));
        QVERIFY(contentOf(folder.filePath(folder.entryList(QDir::Files).value(0))).contains("hang,0,"));
    }

private:
    std::unique_ptr<QTemporaryDir> folder_;
};
