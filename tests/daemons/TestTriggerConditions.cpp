#include "TriggerFixture.h"

using namespace hermes;
using namespace hermes::softwaretrigger;

class TestTriggerConditions : public QObject, TriggerFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void conditionOnATopic() {
        define("low", condition("battery.0.v", "<", 11), {callTarget("count")});
        waitSubscribed("readings");
        QTRY_COMPARE(listed("low")["problem"].toString(), QString());
        const auto reading = [](double v) {
            return QJsonObject{{"battery", QJsonArray{QJsonObject{{"v", v}}}}};
        };
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

    void whatIsReplayedFiresNothing() {
        define("low", condition("", "<", 5));
        waitSubscribed("readings");
        target_->publish("readings", 6);
        ConnectedClient player(asOwner(targetAddress_));
        QVERIFY(player.callAndWait("topics.replay", QJsonObject{{"topic", "readings"}, {"data", 1}}).ok());
        QVERIFY(player.callAndWait("topics.replay", QJsonObject{{"topic", "readings"}, {"live", true}}).ok());
        target_->publish("readings", 4);
        QTRY_COMPARE(fired_["low"].size(), 1);
        QCOMPARE(fired_["low"].last()["cause"]["value"].toDouble(), 4.0);
    }

    void conditionOutlivesTheTarget() {
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

    void conditionThatCannotBeWatched() {
        QJsonObject when = condition("a", "<", 1);
        when["topic"] = "no_such_topic";
        define("t", when);
        QTRY_VERIFY(listed("t")["problem"].toString().contains("no_such_topic"));
        QVERIFY(healthItem("schedule")["message"].toString().contains("no_such_topic"));
    }
};
