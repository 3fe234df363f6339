// Settings of hermes-motorcontrol that do not fit together, or wait for the next start.
#include "MotorFixture.h"
#include "common/settings/DottedPath.h"

using namespace hermes;
using namespace hermes::motorcontrol;
using namespace hermes::simulator;

class TestMotorSettings : public QObject, MotorFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void settingsAreCheckedAgainstEachOther_data() {
        const Rows<QStringList, QString> row("settings", "path");
        row("a path alone", {"controllers.1.url=/dev/ttyACM0"}, "controllers.1.url");
        row("unknown scheme", {"controllers.2.url=serail:///dev/ttyACM0"}, "controllers.2.url");
        row("one address twice", {"controllers.2.address=128"}, "controllers.2.address");
        row("one motor twice", {"wheels.rear_left.controller=1"}, "wheels.rear_left.motor");
        row("thresholds crossed", {"faults.battery_v=24"}, "faults.battery_v");
        row("encoder fault while braking", {"safety.deceleration=1"}, "faults.encoder_hold_s");
        row("motor.wheels is faster than any twist",
            {"motion.vx=0.1", "motion.vy=0.1", "motion.omega=0.1", "safety.deceleration=2"},
            "faults.encoder_hold_s");
        row("a fault that comes too late", {"faults.encoder_hold_s=5"}, "faults.encoder_hold_s");
        row("turning counts as standing",
            {"faults.encoder_moving_rad_s=0.9", "faults.encoder_commanded_rad_s=0.9"},
            "faults.encoder_moving_rad_s");
        row("standing may be a command", {"faults.encoder_commanded_rad_s=5"},
            "faults.encoder_commanded_rad_s");
        row("an encoder that shows no turning", {"frame.counts_per_turn=50", "pid.qpps=150"},
            "frame.counts_per_turn");
    }

    void settingsAreCheckedAgainstEachOther() {
        FETCH(QStringList, settings, QString, path);
        MotorControl daemon;
        const auto result = daemon.settings().set([&] {
            QJsonObject values;
            for (const QString &text : settings) {
                const auto assignment = parseAssignment(text);
                values = withValueAt(values, assignment->first, assignment->second);
            }
            return values;
        }());
        QVERIFY(!result.ok());
        QVERIFY(result.error().is(ErrorCode::InvalidSetting));
        QCOMPARE(result.error().data["errors"].toArray().first().toObject()["path"].toString(), path);
    }

    void aTenthOfAVoltIsEnough() {
        MotorControl daemon;
        const auto set = [&](double empty_v, double full_v) {
            const QJsonObject battery{{"empty_v", empty_v}, {"full_v", full_v}};
            return daemon.settings().set({{"battery", battery}}).ok();
        };
        for (int tenths = 10; tenths < 599; ++tenths)
            QVERIFY2(set(tenths / 10.0, (tenths + 1) / 10.0), saying(tenths));
        QVERIFY(!set(24.8, 24.89));
        QVERIFY(!set(24.8, 24.8));
    }

    // What is set for other controllers is nothing for those that were opened.
    void othersThatWaitForAStartAreNotDriven() {
        launchHeld();
        const QJsonObject before = daemon_->settings().values();
        const QJsonObject left{{"controller", 1}};
        call("settings.set",
             {{"values", QJsonObject{{"controllers",
                                      QJsonObject{{"kind", "vesc"}, {"1", QJsonObject{{"address", 10}}}}},
                                     {"frame", QJsonObject{{"layout", "ackermann"}}},
                                     {"wheels", QJsonObject{{"rear_left", left}}},
                                     {"faults", QJsonObject{{"encoder_commanded_rad_s", 1}}}}}});
        QTRY_VERIFY(state()["halted"].toString().contains("other controllers are set"));
        VERIFY_CONTAINS(failure("control.acquire").message, QString("other controllers are set"));
        call("settings.set", {{"values", QJsonObject{{"motion", QJsonObject{{"ax", 0.7}}}}}});
        QTRY_VERIFY(healthItem("stop")["message"].toString().contains("other controllers are set"));
        VERIFY_CONTAINS(state()["halted"].toString(), QString("other controllers are set")); // still
        QJsonObject back;
        for (const char *name : {"controllers", "frame", "wheels", "faults"})
            back[name] = before.value(name);
        call("settings.set", {{"values", back}});
        QTRY_VERIFY(!failure("control.acquire").message.contains("other controllers are set"));
    }
};
