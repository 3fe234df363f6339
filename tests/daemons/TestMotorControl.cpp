// hermes-motorcontrol as its clients see it, with emulated controllers on a pseudo-terminal.
#include "MotorFixture.h"
#include "common/settings/DottedPath.h"
#include "tests/support/ReleaseStop.h"

#include <QUrl>

using namespace hermes;
using namespace hermes::motorcontrol;
using namespace hermes::simulator;
using vectorlib::pi;

static std::atomic<double> asleep_s{0}; // so long the machine has slept

// Instead of that of the library: the machine can sleep.
double hermes::bootNow() {
    timespec now{};
    ::clock_gettime(CLOCK_BOOTTIME, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec) + asleep_s;
}

class TestMotorControl : public QObject, MotorFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void setsTheControllersUp() {
        launchReady({"pid.p=2", "pid.i=0.25", "pid.d=0", "pid.qpps=140000"});
        rig_->with([](std::vector<RoboClawEmulator> &all) {
            for (RoboClawEmulator &controller : all) {
                for (int motor : {0, 1}) {
                    QCOMPARE(controller.channel(motor).pid().p, 2.0);
                    QCOMPARE(controller.channel(motor).pid().i, 0.25);
                    QCOMPARE(controller.channel(motor).pid().d, 0.0);
                    QCOMPARE(controller.channel(motor).pid().qpps, 140000.0);
                }
                QCOMPARE(controller.timeout(), 0.2);
            }
        });
        QTRY_COMPARE(healthItem("controller_1")["values"].toObject()["version"].toString(),
                     QString("RoboClaw 2x45A v4.2.8"));
        QTRY_COMPARE(call("daemon.status")["state"].toString(), QString("running"));
        QTRY_COMPARE(healthItem("battery")["values"].toObject()["battery_v"].toDouble(), 25.0);
        QTRY_VERIFY(healthItem("cycle")["values"].toObject()["mean_lateness_s"].toDouble() > 0);
        QCOMPARE(rig_->strange(), 0);
    }

    void drivesAndTellsWhere() {
        launchReady();
        call("odometry.reset", {{"x", 1}, {"y", 2}, {"theta", pi / 2}});
        call("control.acquire", {{"client", "test"}});
        const QJsonObject twist{{"vx", 0.4}, {"vy", 0.2}};
        drive(twist, 1);
        driveUntil(twist, [this] { // front left and right, rear left and right
            const std::vector<double> speeds = rig_->speeds();
            return std::abs(atRim(speeds[0]) - 0.2) < 0.03 && std::abs(atRim(speeds[1]) - 0.6) < 0.03 &&
                   std::abs(atRim(speeds[2]) - 0.6) < 0.03 && std::abs(atRim(speeds[3]) - 0.2) < 0.03;
        });
        driveUntil(twist, [this] {
            const QJsonObject told = state()["twist"].toObject();
            return std::abs(told["vx"].toDouble() - 0.4) < 0.03 &&
                   std::abs(told["vy"].toDouble() - 0.2) < 0.03;
        });
        call("motor.stop");
        QTRY_VERIFY(rig_->fastest() < 10);
        QTRY_VERIFY(std::abs(state()["twist"].toObject()["vx"].toDouble()) < 1e-3);
        // The wheels' turns of the emulator, moved along the heading that the odometry began with.
        double ahead = 0, left = 0;
        rig_->with([&](std::vector<RoboClawEmulator> &all) {
            const double metres = 2 * pi * radius / countsPerTurn;
            const auto turned = [&](int controller, int motor) {
                return double(all[controller].channel(motor).count()) * metres;
            };
            ahead = (turned(0, 0) + turned(0, 1) + turned(1, 0) + turned(1, 1)) / 4;
            left = (-turned(0, 0) + turned(0, 1) + turned(1, 0) - turned(1, 1)) / 4;
        });
        const QJsonObject pose = state()["pose"].toObject();
        QVERIFY(ahead > 0.2);
        QVERIFY(std::abs(pose["y"].toDouble() - (2 + ahead)) < 2e-3);
        QVERIFY(std::abs(pose["x"].toDouble() - (1 - left)) < 2e-3);
    }

    void tellsHowLongTheBatteryLasts() {
        const auto battery = [this] { return state()["battery"].toObject(); };
        launch({"battery.capacity_ah=0.5", "battery.idle_a=2"}); // 15 minutes
        QTRY_COMPARE(battery()["reason"].toString(), QString("the motors must rest for 5 s first"));
        QTRY_VERIFY_WITH_TIMEOUT(battery().contains("charge"), 20000);
        QVERIFY(std::abs(battery()["charge"].toDouble() - 0.8) < 0.02); // 25 V
        const double left_s = battery()["left_s"].toDouble();
        QVERIFY2(std::abs(left_s - 0.6 * 900) < 30, saying(left_s));
        QTRY_VERIFY(battery()["left_s"].toDouble() < left_s - 0.5);
        QTRY_COMPARE(healthItem("battery")["level"].toString(), QString("warn")); // under ten minutes
        QVERIFY(healthItem("battery")["message"].toString().startsWith("25 V, charge "));
        call("settings.set", {{"values", QJsonObject{{"battery", QJsonObject{{"capacity_ah", 5}}}}}});
        QTRY_VERIFY(!battery().contains("charge")); // it is another one
        QTRY_COMPARE_WITH_TIMEOUT(healthItem("battery")["level"].toString(), QString("ok"), 20000);
        rig_.reset();
        QTRY_COMPARE(battery()["reason"].toString(), QString("no controller tells voltage and current"));
    }

    void voltagesThatContradictAreAWarning() {
        const auto tells = [this](int tenthsMore) {
            const auto offset = roboclaw::Request::make(0x81, roboclaw::Command::SetVoltageOffsets,
                                                        {std::uint8_t(tenthsMore), 0})
                                    ->bytes;
            rig_->with([&](auto &all) {
                for (std::size_t i = 0; i < offset.size(); ++i)
                    all[1].receive(offset[i], RoboClawRig::now());
            });
        };
        const auto battery = [this] { return healthItem("battery"); };
        launch();
        QTRY_COMPARE(battery()["level"].toString(), QString("ok"));
        tells(127);
        const QString above =
            "25 V, charge not known: controller 1 tells 25 V, controller 2 37.7 V: expected ";
        QTRY_COMPARE(battery()["message"].toString(), above + "more than 0 V, at most 34 V");
        QCOMPARE(battery()["level"].toString(), QString("warn"));
        QVERIFY(!state()["battery"].toObject().contains("charge"));
        tells(-15);
        const QString differ =
            "23.5 V, charge not known: controller 1 tells 25 V, controller 2 23.5 V: expected ";
        QTRY_COMPARE(battery()["message"].toString(), differ + "at most 1 V between them");
        QCOMPARE(battery()["level"].toString(), QString("warn"));
        tells(0);
        QTRY_COMPARE(battery()["level"].toString(), QString("ok"));
        QVERIFY(state()["latched"].toObject().isEmpty());
    }

    void aSleepForgetsTheCharge() {
        launch();
        const auto knows = [this] { return state()["battery"].toObject().contains("charge"); };
        QTRY_VERIFY_WITH_TIMEOUT(knows(), 20000);
        asleep_s = 3600; // somebody may have charged it
        QTRY_VERIFY(!knows());
        QTRY_VERIFY_WITH_TIMEOUT(knows(), 20000);
    }

    void topicsCome() {
        launchReady();
        QJsonObject first, wheels, power;
        std::vector<double> times; // of the odometry
        client_->subscribe("odometry", {{"queue", 100}}, [&](const TopicUpdate &update) {
            first = update.json().toObject();
            times.push_back(first["mono"].toDouble());
        });
        client_->subscribe("wheels", {},
                           [&](const TopicUpdate &update) { wheels = update.json().toObject(); });
        client_->subscribe("power", {}, [&](const TopicUpdate &update) { power = update.json().toObject(); });
        QTRY_VERIFY(!wheels.isEmpty() && !power.isEmpty());
        QTRY_VERIFY(times.size() > 50);
        std::vector<double> periods; // the median: the machine may have stalled
        for (std::size_t i = 1; i < times.size(); ++i)
            periods.push_back(times[i] - times[i - 1]);
        std::sort(periods.begin(), periods.end());
        const double rate = 1 / periods[periods.size() / 2];
        QVERIFY2(rate > 40 && rate < 51, saying(rate));
        QCOMPARE(first["covariance"].toArray().size(), 9);
        QVERIFY(first["pose"].toObject().contains("theta") && first["twist"].toObject().contains("omega"));
        QVERIFY(wheels["rear_right"].toObject().contains("speed") && wheels.contains("slip"));
        QCOMPARE(power["controllers"].toArray().size(), 2);
    }

    void refusals_data() {
        const Rows<QString, QJsonObject, int, QString> row("method", "params", "code", "names");
        row("too fast", "motor.drive", {{"vx", 3}}, int(ErrorCode::OverLimit),
            "vx is 3, expected a number from -1 to 1 m/s");
        row("wheel too fast", "motor.wheels", {{"rear_left", 1e6}}, int(ErrorCode::OverLimit),
            "rear_left is 1e+06");
        row("unknown parameter", "motor.drive", {{"vz", 1}}, int(ErrorCode::InvalidParams), "vz");
        row("not a number", "motor.drive", {{"vx", "fast"}}, int(ErrorCode::InvalidParams), "vx");
        row("null", "motor.drive", {{"omega", QJsonValue()}}, int(ErrorCode::InvalidParams),
            "omega is null, expected a number in rad/s");
        row("too old", "motor.drive", {{"vx", 0.1}, {"stamp", 1e9}}, int(ErrorCode::NotReady),
            "less than 1 s from now");
        row("lease too long", "control.acquire", {{"timeout_s", 1e9}}, int(ErrorCode::InvalidParams),
            "timeout_s");
    }

    void refusals() {
        launchReady();
        QCOMPARE(failure("motor.drive", {{"vx", 0.1}}).code, int(ErrorCode::ControlHeld)); // no lease
        call("control.acquire", {{"timeout_s", 10}});
        FETCH(QString, method, QJsonObject, params, QString, names);
        const Error error = failure(method, params);
        QTEST(error.code, "code");
        const QString all = error.message + QJsonDocument(error.data.toObject()).toJson();
        VERIFY_CONTAINS(all, names);
        passCycles(5);
        for (const RoboClawRig::SetPoint &setPoint : rig_->heard())
            QVERIFY(setPoint.isZero());
    }

    // As a client may send them that does not keep to JSON.
    void numbersWithoutAValueAreRefused() {
        launchReady();
        QTcpSocket socket;
        socket.connectToHost("127.0.0.1", quint16(QUrl(address()).port()));
        QByteArray answers;
        const auto ask = [&](const QByteArray &method, const QByteArray &params) {
            answers.clear();
            socket.write(R"({"jsonrpc":"2.0","id":1,"method":")" + method + R"(","params":)" + params +
                         "}\n");
            return QTest::qWaitFor([&] { return (answers += socket.readAll()).endsWith('\n'); });
        };
        QVERIFY(ask("control.acquire", "{}") && answers.contains(R"("held":true)"));
        for (const char *number : {"NaN", "1e999", "-Infinity"}) {
            QVERIFY(ask("motor.drive", QByteArray(R"({"vx":)") + number + "}"));
            QVERIFY2(answers.contains(R"("code":-32700)"), answers.constData());
        }
        passCycles(5);
        for (const RoboClawRig::SetPoint &setPoint : rig_->heard())
            QVERIFY(setPoint.isZero());
    }

    void missingDeviceIsNamedAndFoundWhenItComes() {
        rig_->pull();
        launch();
        const QString says =
            QString("controller 1 (0x80 on %1): cannot open %1: there is no such device").arg(url());
        QTRY_COMPARE(healthItem("controller_1")["message"].toString(), says);
        const Error error = failure("control.acquire");
        QCOMPARE(error.code, int(ErrorCode::DeviceFault));
        QCOMPARE(error.message, says);
        QCOMPARE(failure("motor.drive", {{"vx", 0.1}}).message, says);
        rig_->plugIn();
        QTRY_VERIFY(state()["ready"].toBool());
    }

    // As hermesctl setup tests the wheels, and is killed.
    void oneWheelTurnsAndStopsByItself() {
        launchReady();
        QCOMPARE(failure("motor.wheels", {{"front_left", 1}}).code, int(ErrorCode::ControlHeld));
        call("control.acquire");
        call("motor.wheels", {{"front_left", 1}});
        const auto speed = [this](const char *wheel) {
            return valueAt(state(), QString("wheels.%1.speed").arg(wheel)).toDouble();
        };
        QTRY_VERIFY(speed("front_left") > 0.8);
        for (const char *wheel : {"front_right", "rear_left", "rear_right"})
            QCOMPARE(speed(wheel), 0.0);
        QTRY_COMPARE(speed("front_left"), 0.0); // no other command has come
        QTRY_VERIFY(!call("control.state")["held"].toBool());
    }

    void emergencyStopLatches() {
        launchHeld();
        driveOff({{"vx", 0.5}});
        call("motor.estop");
        QVERIFY(state()["estop"].toBool());
        QCOMPARE(healthItem("stop")["level"].toString(),
                 QString("error")); // nothing tells otherwise meanwhile
        QCOMPARE(failure("motor.drive", {{"vx", 0.5}}).code, int(ErrorCode::NotReady));
        QCOMPARE(failure("control.acquire").code, int(ErrorCode::NotReady));
        QTRY_VERIFY(rig_->fastest() < 10);
        QTRY_COMPARE(call("daemon.status")["state"].toString(), QString("degraded"));
        QVERIFY(failure("motor.reset_estop").data["retry_after_s"].toDouble() > 0);
        QVERIFY(releaseStop(*client_));
        passCycles(5);
        QVERIFY(rig_->fastest() < 10);
        QCOMPARE(failure("motor.drive", {{"vx", 0.5}}).code, int(ErrorCode::ControlHeld));
        call("control.acquire");
        driveOff({{"vx", 0.5}});
    }

    void stopsBrakeWithTheEmergencyDeceleration() {
        launchHeld({"safety.deceleration=2", "faults.encoder_hold_s=2"});
        driveUntil({{"vx", 0.6}}, [this] { return atRim(rig_->fastest()) > 0.58; });
        call("motor.stop");
        QTRY_VERIFY(rig_->zeroSince() < RoboClawRig::now());
        // 2 m/s^2 in counts
        QCOMPARE(rig_->heard().back().acceleration,
                 quint32(std::llround(2 / radius * countsPerTurn / (2 * pi))));
        QTRY_VERIFY(RoboClawRig::now() - rig_->lastMoved() > 0.1);
        const double took = rig_->lastMoved() - rig_->zeroSince();
        QVERIFY2(took > 0.2 && took < 0.6, saying(took)); // 0.3 s, and the lag
    }

    void newPidIsWrittenAndReadBack() {
        launchReady();
        call("settings.set", {{"values", QJsonObject{{"pid", QJsonObject{{"p", 3}}}}}});
        QTRY_COMPARE(rig_->with([](auto &all) { return all[1].channel(1).pid().p; }), 3.0);
        QTRY_VERIFY(state()["ready"].toBool());
    }

    // The same command would move the robot in another way.
    void otherWheelsTakeTheControlAway() {
        launchHeld();
        call("motor.drive", {{"vx", 0.1}});
        call("settings.set", {{"values", QJsonObject{{"motion", QJsonObject{{"ax", 0.7}}}}}});
        call("motor.drive", {{"vx", 0.1}});
        call("settings.set", {{"values", QJsonObject{{"frame", QJsonObject{{"wheel_radius_m", 0.05}}}}}});
        QTRY_COMPARE(state()["halted"].toString(), QString("the settings were changed"));
        VERIFY_CONTAINS(failure("motor.drive", {{"vx", 0.1}}).message, QString("control.acquire gives it"));
        call("control.acquire");
        call("motor.drive", {{"vx", 0.1}});
    }

    void twoLines() {
        rig_.reset();
        RoboClawRig front(folder_->filePath("front"), {controllerAt(0x80)});
        RoboClawRig rear(folder_->filePath("rear"), {controllerAt(0x80)});
        launchHeld({"controllers.1.url=" + url("front"), "controllers.2.url=" + url("rear"),
                    "controllers.2.address=128", "wheels.rear_left.reversed=true"});
        driveUntil({{"omega", 1}}, [&] {
            const auto f = front.speeds(), r = rear.speeds(); // rear_left is mounted the other way round
            return f[0] < -1000 && f[1] > 1000 && r[0] > 1000 && r[1] > 1000;
        });
        driveUntil({{"omega", 1}},
                   [&] { return std::abs(state()["twist"].toObject()["omega"].toDouble() - 1) < 0.1; });
        client_.reset();
        daemon_->shutDown();
        daemon_.reset();
    }

    void shutdownStops() {
        launchHeld();
        driveOff({{"vx", 0.5}});
        client_.reset();
        daemon_->shutDown();
        QTRY_VERIFY(rig_->zeroSince() < RoboClawRig::now()); // the last bytes may still be in the line
        daemon_.reset();
    }
};
