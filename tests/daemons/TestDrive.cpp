// Who may drive, and every reason to stop: the rules of hermes-motorcontrol without devices.
#include "daemons/motorcontrol/Drive.h"
#include "daemons/motorcontrol/Threshold.h"

Q_DECLARE_METATYPE(std::function<void(hermes::motorcontrol::Drive &)>)

using namespace hermes;
using namespace hermes::motorcontrol;

static constexpr quint64 anna = 1, bert = 2, carl = 3;
static const WheelValues still{};
static const double notANumber = std::numeric_limits<double>::quiet_NaN();

class TestDrive : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        drive_ = std::make_unique<Drive>();
        drive_->configure({});
        drive_->setReady();
        drive_->step(0);
    }

    void drivesWithTheLimitsOfAcceleration() {
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        QVERIFY(std::abs(run(0.02, 0.25)[0] - 2.4) < 0.01); // 12 cycles at 1 m/s^2, wheels of 0.1 m
        QVERIFY(std::abs(run(0.26, 0.8)[0] - 5) < 1e-9);
        QCOMPARE(drive_->haltReason(), QString());
        QVERIFY(drive_->driveTwist(anna, {}, 0, 0.81).ok()); // an ordered zero is a ramp, too
        drive_->step(0.82);
        QVERIFY(drive_->setPoint()[0] > 4.5 && drive_->setPoint()[0] < 5);
    }

    void refusesBadCommands_data() {
        const Rows<double, double, int, QString> row("vx", "omega", "code", "text");
        const double inf = std::numeric_limits<double>::infinity();
        row("too fast", 1.5, 0.0, int(ErrorCode::OverLimit), "vx is 1.5, expected a number from -1 to 1 m/s");
        row("too fast back", -1.5, 0.0, int(ErrorCode::OverLimit),
            "vx is -1.5, expected a number from -1 to 1 m/s");
        row("both", 1.5, 9.0, int(ErrorCode::OverLimit),
            "vx is 1.5, expected a number from -1 to 1 m/s; omega is 9, expected a number "
            "from -1.5 to 1.5 rad/s");
        row("not a number", notANumber, 0.0, int(ErrorCode::InvalidParams),
            "vx is nan, expected a number from -1 to 1 m/s");
        row("infinite", 0.0, -inf, int(ErrorCode::InvalidParams),
            "omega is -inf, expected a number from -1.5 to 1.5 rad/s");
    }

    void refusesBadCommands() {
        FETCH(double, vx, double, omega);
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        const Error error = refusal(drive_->driveTwist(anna, {vx, 0, omega}, 0, 0));
        QTEST(error.code, "code");
        QTEST(error.message, "text");
        QVERIFY(error.data["errors"].toArray().size() >= 1);
        QCOMPARE(drive_->step(0.1), still);
    }

    void differentialRefusesSideways() {
        Drive::Settings settings;
        settings.layout = WheelLayout::differential({});
        drive_->configure(settings);
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        QVERIFY(refusal(drive_->driveTwist(anna, {0, 0.1, 0}, 0, 0)).is(ErrorCode::OverLimit));
        QVERIFY(drive_->driveTwist(anna, {0.1, 0, 0}, 0, 0).ok());
    }

    void drivesSingleWheels() {
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        QVERIFY(drive_->driveWheels(anna, {0, 0.3, 0, 0}, 0, 0).ok());
        QCOMPARE(drive_->step(0.1), (WheelValues{0, 0.3, 0, 0}));
        const Error error = refusal(drive_->driveWheels(anna, {0, 0, 0, 21}, 0, 0.1));
        QVERIFY(error.is(ErrorCode::OverLimit));
        VERIFY_CONTAINS(error.message, "rear_right is 21");
    }

    void needsTheLease() {
        Error error = refusal(drive_->driveTwist(anna, {0.1, 0, 0}, 0, 0));
        QVERIFY(error.is(ErrorCode::ControlHeld));
        QVERIFY(error.data["holder"].isNull());
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        error = refusal(drive_->driveTwist(bert, {0.1, 0, 0}, 0, 0));
        QVERIFY(error.is(ErrorCode::ControlHeld));
        QCOMPARE(error.data["holder"].toString(), QString("anna"));
        QVERIFY(refusal(drive_->acquire(bert, "bert", 1, 0)).is(ErrorCode::ControlHeld));
        drive_->release(bert); // not his
        QVERIFY(drive_->driveTwist(anna, {0.1, 0, 0}, 0, 0).ok());
        drive_->release(anna);
        QVERIFY(drive_->acquire(bert, "bert", 1, 0).ok());
    }

    void takingOverIsAskedFor() {
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        QVERIFY(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0).ok());
        QVERIFY(drive_->step(0.1) != still);
        QVERIFY(drive_->takeOver(anna, "anna", 1, 0.1).ok()); // one's own: it drives on
        QVERIFY(drive_->step(0.12) != still);
        QVERIFY(refusal(drive_->acquire(bert, "bert", 1, 0.12)).is(ErrorCode::ControlHeld));
        QVERIFY(drive_->takeOver(bert, "bert", 1, 0.12).ok());
        QCOMPARE(drive_->haltReason(), QString("bert took the control over from anna"));
        QCOMPARE(drive_->step(0.14), still); // at once, and until bert drives
        const Error error = refusal(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0.14));
        QVERIFY(error.is(ErrorCode::ControlHeld));
        QCOMPARE(error.data["holder"].toString(), QString("bert"));
        drive_->clientGone(anna); // is of no account any more
        QVERIFY(drive_->driveTwist(bert, {0.5, 0, 0}, 0, 0.2).ok());
        QVERIFY(drive_->step(0.3) != still);
        drive_->emergencyStop(anna, "anna", 0.3);
        QVERIFY(refusal(drive_->takeOver(anna, "anna", 1, 0.3)).is(ErrorCode::NotReady));
    }

    void leaseRunsOut() {
        QVERIFY(drive_->acquire(anna, "anna", 0.1, 0).ok());
        QVERIFY(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0).ok());
        QVERIFY(drive_->step(0.09) != still);
        QCOMPARE(drive_->step(0.1), still);
        VERIFY_CONTAINS(drive_->haltReason(), "anna");
        QVERIFY(drive_->acquire(bert, "bert", 1, 0.1).ok());
    }

    void motionRenewsTheLease() {
        QVERIFY(drive_->acquire(anna, "anna", 0.3, 0).ok());
        run(0, 2);
        QVERIFY(drive_->lease().isHeldBy(anna));
    }

    void stopsAtOnce_data() {
        const Rows<std::function<void(Drive &)>> row("event");
        using Event = std::function<void(Drive &)>;
        row("motor.stop", Event([](Drive &d) { d.stop(anna, "anna"); }));
        row("motor.stop of another", Event([](Drive &d) { d.stop(bert, "bert"); }));
        row("motor.estop", Event([](Drive &d) { d.emergencyStop(bert, "bert", 1); }));
        row("client gone", Event([](Drive &d) { d.clientGone(anna); }));
        row("control.release", Event([](Drive &d) { d.release(anna); }));
        row("fault", Event([](Drive &d) { d.fault("battery", "low"); }));
        row("controllers lost", Event([](Drive &d) { d.setNotReady("no answer"); }));
        row("gap", Event([](Drive &d) { d.stoodStill("stood still for 3 s"); }));
    }

    void stopsAtOnce() {
        QFETCH(std::function<void(Drive &)>, event);
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        QVERIFY(run(0, 1)[0] > 4);
        event(*drive_);
        QCOMPARE(drive_->setPoint(), still);
        QVERIFY(!drive_->haltReason().isEmpty());
        for (double now = 1; now < 3; now += 0.02)
            QCOMPARE(drive_->step(now), still);
    }

    void commandTimeOutStopsButKeepsTheLease() {
        QVERIFY(drive_->acquire(anna, "anna", 10, 0).ok());
        run(0, 1);
        const double last = 0.98;
        QVERIFY(drive_->step(last + 0.24) != still);
        QCOMPARE(drive_->step(last + 0.27), still);
        QCOMPARE(drive_->haltReason(), QString("no command for 0.25 s"));
        QVERIFY(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 2).ok());
    }

    void stopOfAnotherEndsTheLease() {
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        drive_->stop(anna, "anna");
        QVERIFY(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0).ok());
        drive_->stop(bert, "bert");
        QVERIFY(refusal(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0)).is(ErrorCode::ControlHeld));
    }

    void emergencyStopIsLatched() {
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        drive_->emergencyStop(bert, "bert", 0);
        drive_->emergencyStop(carl, "carl", 0);
        const Error error = refusal(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0));
        QVERIFY(error.is(ErrorCode::NotReady));
        QCOMPARE(error.message, QString("emergency stop by bert; motor.reset_estop releases it"));
        QVERIFY(refusal(drive_->acquire(anna, "anna", 1, 0)).is(ErrorCode::NotReady));
        drive_->resetEmergencyStop();
        QCOMPARE(drive_->step(0.1), still); // the release moves nothing
        QVERIFY(refusal(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0.1)).is(ErrorCode::ControlHeld));
        QVERIFY(drive_->acquire(anna, "anna", 1, 0.1).ok());
        QVERIFY(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0.1).ok());
    }

    void whoWasStoppedIsNotTheReason() {
        const std::pair<QString, std::function<void()>> stops[] = {
            {"stopped by bert", [this] { drive_->stop(bert, "bert"); }},
            {"emergency stop by bert", [this] { drive_->emergencyStop(bert, "bert", 1); }}};
        for (const auto &[reason, stop] : stops) {
            init();
            QVERIFY(drive_->acquire(anna, "anna", 10, 0).ok());
            stop();
            drive_->stop(anna, "anna"); // as a client does at its end
            QCOMPARE(drive_->haltReason(), reason);
            QCOMPARE(drive_->setPoint(), WheelValues{});
        }
        init();
        drive_->stop(bert, "bert");
        drive_->stop(anna, "anna");
        QCOMPARE(drive_->haltReason(), QString("stopped by anna"));
    }

    // By rule, not by case: whoever pressed, drove and asks, in each order, is refused unless it alone
    // pressed, or a person has confirmed and it was not driving when another pressed; and nobody is heard
    // within the hold-off.
    void onlyWhoPressedOrAPersonReleases() {
        const std::array clients{anna, bert, carl};
        for (quint64 driver : clients)
            for (quint64 first : clients)
                for (quint64 second : {quint64(0), anna, bert, carl})
                    for (quint64 asks : clients)
                        for (bool confirmed : {false, true}) {
                            init();
                            QVERIFY(drive_->mayReset(asks, false, 0).ok()); // nothing to release
                            QVERIFY(drive_->acquire(driver, "driver", 10, 0).ok());
                            drive_->emergencyStop(first, "first", 1);
                            if (second)
                                drive_->emergencyStop(second, "second", 2);
                            const double free = (second ? 2 : 1) + Drive::holdOff_s;
                            const Error early = refusal(drive_->mayReset(asks, confirmed, free - 0.5));
                            QCOMPARE(early.data["retry_after_s"].toDouble(), 0.5);
                            const bool alone = asks == first && (second == 0 || second == first);
                            const bool wasStopped = asks == driver && driver != first;
                            QCOMPARE(drive_->mayReset(asks, confirmed, free + 0.01).ok(),
                                     alone || (confirmed && !wasStopped));
                        }
        init();
        drive_->restoreStop("emergency stop of before", 5);
        QVERIFY(refusal(drive_->mayReset(anna, true, 6)).is(ErrorCode::NotReady));
        QVERIFY(refusal(drive_->mayReset(anna, false, 8)).data["confirm"].toBool());
        QVERIFY(drive_->mayReset(anna, true, 8).ok());
    }

    void faultsAreLatchedAndNamed() {
        QVERIFY(drive_->fault("battery", "the battery has 18.1 V"));
        QVERIFY(!drive_->fault("battery", "the battery has 18.0 V"));
        QVERIFY(drive_->fault("current", "front_left draws 50 A"));
        const Error error = refusal(drive_->acquire(anna, "anna", 1, 0));
        QVERIFY(error.is(ErrorCode::DeviceFault));
        QCOMPARE(error.message,
                 QString("the battery has 18.1 V; front_left draws 50 A; motor.reset_estop releases it"));
        QCOMPARE(error.data["battery"].toString(), QString("the battery has 18.1 V"));
        drive_->resetEmergencyStop();
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
    }

    void notReadyRefusesAndRecovers() {
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        drive_->setNotReady("controller 1 does not answer");
        const Error error = refusal(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0));
        QVERIFY(error.is(ErrorCode::DeviceFault));
        QCOMPARE(error.message, QString("controller 1 does not answer"));
        drive_->setReady();
        QVERIFY(refusal(drive_->driveTwist(anna, {0.5, 0, 0}, 0, 0)).is(ErrorCode::ControlHeld));
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
    }

    void oldCommandsAreRefused() {
        QVERIFY(drive_->acquire(anna, "anna", 1, 0).ok());
        QVERIFY(drive_->driveTwist(anna, {0.5, 0, 0}, 0.2, 0).ok());
        QVERIFY(drive_->step(0.04) != still);
        QCOMPARE(drive_->step(0.06), still); // 0.26 s after it was made
        QVERIFY(refusal(drive_->driveTwist(anna, {0.5, 0, 0}, 0.25, 0)).is(ErrorCode::NotReady));
        QVERIFY(refusal(drive_->driveTwist(anna, {0.5, 0, 0}, -0.25, 0)).is(ErrorCode::NotReady));
        QVERIFY(refusal(drive_->driveTwist(anna, {0.5, 0, 0}, notANumber, 0)).is(ErrorCode::NotReady));
    }

    void pauseDoesNotMakeTheRampJump() {
        QVERIFY(drive_->acquire(anna, "anna", 100, 0).ok());
        QVERIFY(drive_->driveTwist(anna, {1, 0, 0}, 0, 50).ok());
        QVERIFY(std::abs(drive_->step(50.1)[0] - 1) < 1e-9); // 0.1 s at 10 rad/s^2
    }

    void thresholdNeedsTime() {
        Threshold battery(Threshold::Side::Below);
        battery.set({23, 22, 1});
        QVERIFY(battery.judge(24, 0) == Threshold::Level::Good);
        QVERIFY(battery.judge(22.5, 0) == Threshold::Level::Warning);
        QVERIFY(battery.judge(21, 1) == Threshold::Level::Warning);
        QVERIFY(battery.judge(21, 1.99) == Threshold::Level::Warning);
        QVERIFY(battery.judge(24, 1.995) == Threshold::Level::Good); // a break
        QVERIFY(battery.judge(21, 2) == Threshold::Level::Warning);
        QVERIFY(battery.judge(21, 3) == Threshold::Level::Fault);
        Threshold current(Threshold::Side::Above);
        current.set({30, 40, 0});
        QVERIFY(current.judge(29, 0) == Threshold::Level::Good);
        QVERIFY(current.judge(31, 0) == Threshold::Level::Warning);
        QVERIFY(current.judge(41, 0) == Threshold::Level::Fault);
        QVERIFY(current.judge(notANumber, 0) == Threshold::Level::Fault);
    }

private:
    Error refusal(const Result<void> &result) {
        return result ? Error(ErrorCode::InternalError, "accepted, though it should not be") : result.error();
    }

    // Cycles of 20 ms with a fresh command in each.
    WheelValues run(double from, double to) {
        for (double now = from; now < to; now += 0.02) {
            drive_->driveTwist(anna, {0.5, 0, 0}, 0, now);
            drive_->step(now);
        }
        return drive_->setPoint();
    }

    std::unique_ptr<Drive> drive_;
};
