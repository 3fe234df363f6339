// Daemons that triggers call: slow, away, or refusing.
#include "TriggerFixture.h"
#include "tests/support/FreePort.h"

using namespace hermes;
using namespace hermes::softwaretrigger;

class TestTriggerTargets : public QObject, TriggerFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void failuresAreResults() {
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
        QCOMPARE(healthItem("actions")["values"].toObject()["failed"].toInt(), 2);
    }

    void slowTargetDelaysNothing() {
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
        QVERIFY2(begun < 3, saying(begun));
        QVERIFY(target_->values.size() >= 20);
    }

    void targetThatIsAwayDelaysNothing() {
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

    void callsThatWaitAreLimited() {
        define("t", period(0.005), {callTarget("hang", 30)});
        QTRY_VERIFY_WITH_TIMEOUT(listed("t")["failed_actions"].toInt() > 100, 20000);
        int refused = 0;
        for (const QJsonValue &firing : fired_["t"])
            refused +=
                firing["results"].toArray().at(0)["error"]["code"].toInt() == int(ErrorCode::OverLimit);
        QVERIFY(refused > 20);
        QVERIFY(healthItem("targets")["values"].toObject().value(targetAddress_)["waiting"].toInt() <=
                Targets::maxCalls);
    }

    void scheduleOutlivesTheTarget() {
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
};
