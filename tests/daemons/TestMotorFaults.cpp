// What breaks under hermes-motorcontrol: lines, controllers, wheels, batteries.
#include "MachineStalls.h"
#include "MotorFixture.h"

Q_DECLARE_METATYPE(std::function<void(RoboClawRig &)>)

using namespace hermes;
using namespace hermes::motorcontrol;
using namespace hermes::simulator;

class TestMotorFaults : public QObject, MotorFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void pulledLineRecoversWithoutAJump() {
        launchHeld();
        driveOff({{"vx", 0.5}});
        drive({{"vx", 0.5}}, 0.5);
        rig_->pull();
        QTRY_VERIFY(!state()["ready"].toBool());
        QCOMPARE(failure("motor.drive", {{"vx", 0.5}}).code, int(ErrorCode::DeviceFault));
        const double before = state()["pose"].toObject()["x"].toDouble();
        QTRY_VERIFY(rig_->fastest() < 10); // by the controllers' own time-out
        const std::size_t heard = rig_->heard().size();
        MachineStalls stalls;
        rig_->plugIn();
        const double back = RoboClawRig::now();
        QTRY_VERIFY(state()["ready"].toBool());
        QTRY_VERIFY(rig_->heard().size() > heard);
        const double found = rig_->heard().at(heard).time - back, most = 0.6 + stalls.takeLongest();
        QVERIFY2(found < most, saying("%1 of %2", found, most));
        passCycles(5); // with readings
        const double rolled = state()["pose"].toObject()["x"].toDouble() - before;
        QVERIFY2(rolled >= 0 && rolled < 0.2, saying(rolled)); // what the wheels really did
        QCOMPARE(state()["counter_jumps"].toInt(), 0);
        const double counts = rig_->with([](auto &all) { return double(all[0].channel(0).count()); });
        QVERIFY(std::abs(state()["pose"].toObject()["x"].toDouble() - atRim(counts)) < 0.005);
        QCOMPARE(failure("motor.drive", {{"vx", 0.5}}).code, int(ErrorCode::ControlHeld));
        call("control.acquire");
        driveOff({{"vx", 0.5}});
    }

    void controllerThatLostItsCountsMakesNoJump() {
        launchHeld();
        driveUntil({{"vx", 0.5}}, [this] { return state()["pose"].toObject()["x"].toDouble() > 0.05; });
        call("motor.stop");
        QTRY_VERIFY(rig_->fastest() < 10);
        passCycles(5); // with readings
        const double before = state()["pose"].toObject()["x"].toDouble();
        rig_->pull();
        rig_->with([](auto &all) {
            for (int motor : {0, 1})
                all[1].channel(motor).setCount(0);
        });
        QTest::qWait(400); // no power cycle is shorter
        rig_->plugIn();
        QTRY_VERIFY_WITH_TIMEOUT(state()["counter_jumps"].toInt() > 0, 7000);
        passCycles(5); // with readings
        QCOMPARE(state()["counter_jumps"].toInt(), 1);
        QVERIFY(std::abs(state()["pose"].toObject()["x"].toDouble() - before) < 1e-3);
    }

    void faultsStopAndLatch_data() {
        using Break = std::function<void(RoboClawRig &)>;
        const Rows<Break, QString, QString, QString> row("breakIt", "setting", "name", "says");
        row(
            "low battery", [](RoboClawRig &rig) { rig.setVoltage(20); }, "faults.battery_v=21", "battery",
            "the battery has 20 V, at least 21 V are needed");
        row(
            "over-current",
            [](RoboClawRig &rig) { rig.with([](auto &all) { all[1].channel(0).setBlocked(true); }); },
            R"(faults={"current_a": 8, "current_warning_a": 5})", "current", "controller 2");
        row(
            "over-temperature", [](RoboClawRig &) {},
            R"(faults={"temperature_c": 20, "temperature_warning_c": 10})", "temperature",
            "at most 20 are allowed");
        row(
            "commanded but not moving",
            [](RoboClawRig &rig) { rig.with([](auto &all) { all[0].channel(1).setEncoderBroken(true); }); },
            "faults.current_a=150", "encoder", "wheel front_right was told to turn and stands still");
        row(
            "status bit",
            [](RoboClawRig &rig) {
                rig.with([](auto &all) { all[1].faults().status = roboclaw::DriverFaultM1; });
            },
            "faults.current_a=150", "controller_2", "controller 2");
        row(
            "hard-wired emergency stop",
            [](RoboClawRig &rig) {
                rig.with([](auto &all) { all[0].faults().status = roboclaw::EmergencyStop; });
            },
            "faults.current_a=150", "controller_1", "controller 1");
    }

    void faultsStopAndLatch() {
        FETCH(std::function<void(RoboClawRig &)>, breakIt, QString, setting, QString, name, QString, says);
        launchReady({setting, "faults.hold_s=0.1"});
        const auto isLatched = [&] { return state()["latched"].toObject().contains(name); };
        const auto tryUntil = [&](const auto &isReached) { // at 25 Hz, for 10 s at most
            for (int i = 0; i < 250 && !isReached(); ++i) {
                client_->callAndWait("motor.drive", QJsonObject{{"vx", 0.4}}); // refused once it is latched
                QTest::qWait(40);
            }
        };
        client_->callAndWait("control.acquire", QJsonObject());
        tryUntil(
            [&] { return isLatched() || rig_->fastest() > 10000; }); // the temperature is latched at once
        breakIt(*rig_);
        tryUntil(isLatched);
        const QString reason = state()["latched"].toObject()[name].toString();
        QVERIFY2(reason.contains(says), qPrintable(QJsonDocument(state()["latched"].toObject()).toJson()));
        QCOMPARE(failure("motor.drive", {{"vx", 0.4}}).code, int(ErrorCode::DeviceFault));
        QTRY_VERIFY(rig_->zeroSince() < RoboClawRig::now());
        QTRY_VERIFY(rig_->fastest() < 10);
        QTRY_COMPARE(call("daemon.status")["state"].toString(), QString("fault"));
        QTRY_COMPARE(healthItem("stop")["level"].toString(), QString("error"));
    }

    void turningUncommandedIsAFault() {
        launchReady();
        double turned = RoboClawRig::now();
        QTimer turn;
        connect(&turn, &QTimer::timeout, this, [&] { // in steps that are shorter than a cycle
            const double now = RoboClawRig::now();
            const auto counts = std::int64_t(20000 * (now - std::exchange(turned, now))); // 20000 in a second
            rig_->with([&](auto &all) { all[1].channel(0).setCount(all[1].channel(0).count() + counts); });
        });
        turn.setTimerType(Qt::PreciseTimer);
        turn.start(5);
        QTRY_VERIFY_WITH_TIMEOUT(!state()["latched"].toObject().isEmpty(), 10000);
        const QString reason = QJsonDocument(state()["latched"].toObject()).toJson();
        QVERIFY2(reason.contains("wheel rear_left turns although it was told to stop") ||
                     reason.contains("was told to stop and kept turning"), // first where readings come slowly
                 qPrintable(reason));
    }

    void deafControllerIsNamed() {
        launchHeld();
        driveOff({{"vx", 0.4}});
        rig_->with([](auto &all) { all[1].faults().silent = true; });
        QTRY_VERIFY(!state()["ready"].toBool());
        const Error error = failure("motor.drive", {{"vx", 0.4}});
        QCOMPARE(error.code, int(ErrorCode::DeviceFault));
        QVERIFY2(error.message.startsWith("controller 2 (0x81 on") &&
                     error.message.endsWith("does not answer"),
                 qPrintable(error.message));
        QTRY_VERIFY(rig_->fastest() < 10); // the other one, too
        rig_->with([](auto &all) { all[1].faults().silent = false; });
        QTRY_VERIFY(state()["ready"].toBool());
    }

    void wrongFirmwareIsNamed() {
        auto other = controllerAt(0x81);
        other.version = "Sabertooth 2x60";
        rig_.reset();
        rig_ =
            std::make_unique<RoboClawRig>(folder_->filePath("line"), std::vector{controllerAt(0x80), other});
        launch();
        const QString says = "tells its version as \"Sabertooth 2x60\", expected that of a RoboClaw";
        TRY_CONTAINS(healthItem("controller_2")["message"].toString(), says);
        QVERIFY(failure("control.acquire").message.contains(says));
        QCOMPARE(call("daemon.status")["state"].toString(), QString("degraded"));
    }

    void damagedAnswersAreCountedAndSurvived() {
        launchReady();
        rig_->with([](auto &all) {
            for (RoboClawEmulator &controller : all)
                controller.faults().corrupt = 0.03;
        });
        call("control.acquire");
        drive({{"vx", 0.4}}, 2);
        QCOMPARE(state()["halted"].toString(), QString());
        driveUntil({{"vx", 0.4}},
                   [this] { return std::abs(state()["twist"].toObject()["vx"].toDouble() - 0.4) < 0.05; });
        const QJsonObject values = healthItem("controller_1")["values"].toObject();
        QVERIFY(values["crc_errors"].toInt() + values["unexpected"].toInt() > 0);
    }
};
