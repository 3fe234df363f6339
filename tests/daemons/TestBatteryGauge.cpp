#include "daemons/motorcontrol/BatteryGauge.h"
#include "daemons/motorcontrol/MotorMessages.h"
#include "daemons/simulator/Drivetrain.h"
#include "protocol/roboclaw/Device.h"
#include "protocol/wire/Fields.h"

using namespace hermes;
using namespace hermes::motorcontrol;

/// What is told of a battery: never a guess as if it were sure, and right within what it tells, whatever the
/// robot does.
class TestBatteryGauge : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void nothingIsKnownBeforeARest() {
        pass(20, 24.4, 10);
        QVERIFY(!state().charge && !state().left_s && state().current_a);
        QCOMPARE(state().reason, QString("the motors must rest for 5 s first"));
        pass(4, 24.4, 0);
        QVERIFY(!state().charge);
        pass(2, 24.4, 0);
        QVERIFY(state().charge && state().reason.isEmpty());
        QVERIFY(std::abs(*state().charge - 0.5) < 0.01);
        QVERIFY(*state().chargeDeviation > 0.1);
    }

    void whatIsMissingIsNamed_data() {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                         inf = std::numeric_limits<double>::infinity();
        const Rows<double, double> row("voltage", "motors_a");
        row("no voltage", 0.0, 1.0);
        row("NaN", nan, 1.0);
        row("infinite", inf, 1.0);
        row("current NaN", 24.0, nan);
        row("current infinite", 24.0, inf);
    }

    void whatIsMissingIsNamed() {
        FETCH(double, voltage, double, motors_a);
        pass(10, 24.4, 0);
        QVERIFY(state().charge);
        pass(1, voltage, motors_a);
        QVERIFY(!state().charge && !state().left_s && !state().current_a);
        QVERIFY2(state().reason.contains("controller") && state().reason.contains(" tells "),
                 qPrintable(state().reason));
        QCOMPARE(gauge_->missing(), state().reason);
        gauge_->take(now_, Error(ErrorCode::NotReady, "no controller tells it"));
        QCOMPARE(state().reason, QString("no controller tells it"));
        pass(1, 24.4, 0);
        QVERIFY(state().charge); // still known
    }

    void voltagesThatCannotBeTrueGiveNoCharge_data() {
        const Rows<double, double, QString> row("first", "second", "reason");
        const QString impossible = ": expected more than 0 V, at most 34 V",
                      differ = ": expected at most 1 V between them";
        row("second above", 23.4, 65.5, "controller 1 tells 23.4 V, controller 2 65.5 V" + impossible);
        row("first above", 34.1, 24.0, "controller 1 tells 34.1 V, controller 2 24 V" + impossible);
        row("both above", 65.5, 65.5, "controller 1 tells 65.5 V, controller 2 65.5 V" + impossible);
        row("one zero", 24.0, 0.0, "controller 1 tells 24 V, controller 2 0 V" + impossible);
        row("they differ", 24.5, 23.4, "controller 1 tells 24.5 V, controller 2 23.4 V" + differ);
        row("they differ far", 24.0, 34.0, "controller 1 tells 24 V, controller 2 34 V" + differ);
    }

    void voltagesThatCannotBeTrueGiveNoCharge() {
        FETCH(double, first, double, second, QString, reason);
        restAt(first, second, 10); // from the start
        QCOMPARE(state().reason, reason);
        QVERIFY(!state().charge && !state().left_s);
        restAt(24, 24, 6);
        QVERIFY(std::abs(*state().charge - 0.3) < 0.01);
        restAt(first, second, 2); // and later
        QCOMPARE(state().reason, reason);
        QCOMPARE(gauge_->missing(), reason);
        QVERIFY(!state().charge && !state().left_s);
        restAt(24, 24, 1);
        QVERIFY(std::abs(*state().charge - 0.3) < 0.01);
    }

    void theLowerVoltageCounts() {
        restAt(24.4, 23.4, 10); // 1 V is allowed
        QVERIFY2(state().charge, qPrintable(state().reason));
        QVERIFY(*state().charge < 0.01);
    }

    // They are not read at the same time: a motor may have started in between.
    void voltagesMayDifferForAMoment() {
        restAt(24.4, 24.4, 10);
        restAt(24.4, 22, 0.8);
        QVERIFY2(state().charge, qPrintable(state().reason));
        QVERIFY(std::abs(*state().charge - 0.5) < 0.01); // nothing follows from either
        restAt(24.4, 24.4, 0.2);
        restAt(24.4, 22, 0.8);
        QVERIFY2(state().charge, qPrintable(state().reason));
    }

    void batteriesOfOtherVoltagesAreKnown() {
        gauge_->configure({26, 50, 46, 2, 0.2});
        restAt(48, 48, 10);
        QVERIFY2(state().charge, qPrintable(state().reason));
        restAt(65.5, 65.5, 10);
        QVERIFY2(state().reason.endsWith("at most 62.5 V"), qPrintable(state().reason));
    }

    void controllersShareOneBattery() {
        Telemetry told = ready();
        told.controllers[1].readings.battery_v = 24.2;
        const auto reading = batteryOf(told);
        QVERIFY(reading && reading->voltages == (std::vector{24.0, 24.2}) && reading->motors_a == 8);
        told.controllers[0].ready = false; // half of the current is no guess for all of it
        QVERIFY(!batteryOf(told));
        QCOMPARE(batteryOf(told).error().message, QString("no controller tells voltage and current"));
    }

    void aControllerWithoutDutiesIsNamed() {
        Telemetry told = ready();
        told.controllers[1].name = "controller 2";
        told.controllers[1].readings.duty.reset();
        QVERIFY(!batteryOf(told));
        QCOMPARE(batteryOf(told).error().message,
                 QString("controller 2 does not tell the duties of its motors"));
        const PowerMessage power = powerOf(told, {});
        QVERIFY(asJson(power.controllers[0]).toObject().contains("duty"));
        const QJsonObject without = asJson(power.controllers[1]).toObject();
        QVERIFY(without["ready"].toBool() && !without.contains("duty"));
    }

    void dutiesAreSharesOfOne() {
        roboclaw::Device device(0x80);
        drive::Command read{drive::Command::Kind::ReadSlow};
        while (device.isVital(read))
            ++read.number;
        const auto request = roboclaw::Request::make(0x80, roboclaw::Command::ReadPwm);
        const auto answer = roboclaw::encodeReply(*request, {-32768, 32767});
        device.reader().begin(device.bytes(read));
        for (std::size_t i = 0; i < answer->size(); ++i)
            device.reader().feed((*answer)[i]);
        drive::Readings readings;
        QVERIFY(device.take(read, readings).empty());
        QVERIFY(readings.duty == (std::array{-1.0, 1.0}));
    }

    void tellsTheTimeLeft() {
        gauge_->configure({20, 25, 23, 2, 0.2});
        pass(10, 24.4, 0); // 70 %: 10 Ah above the reserve
        pass(600, 24, 8);  // 10 A
        const double charge = 0.7 - 10 / 6. / 20;
        QVERIFY2(std::abs(*state().charge - charge) < 0.005, saying(*state().charge));
        QVERIFY(std::abs(*state().current_a - 10) < 0.01);
        QVERIFY(std::abs(*state().left_s - (charge - 0.2) * 20 / 10 * 3600) < 60);
        const double least_s = *state().leftLeast_s;
        QVERIFY(least_s > 0 && least_s < *state().left_s);
        pass(4 * 3600, 24, 8);
        QCOMPARE(*state().charge, 0.0);
        QCOMPARE(*state().left_s, 0.0);
    }

    // What motors draw is smoothed; what was set is known.
    void theIdleCurrentCountsAtOnce() {
        gauge_->configure({20, 25, 23, 2, 0.2});
        pass(10, 24.4, 0);
        pass(600, 24, 8);
        gauge_->configure({20, 25, 23, 12, 0.2});
        pass(0.1, 24, 8);
        QVERIFY2(std::abs(*state().current_a - 20) < 0.01, saying(*state().current_a));
        QVERIFY(std::abs(*state().left_s - (*state().charge - 0.2) * 20 / 20 * 3600) < 5);
        pass(6, 24, 0); // a tenth of the minute
        QVERIFY(*state().current_a > 18 && *state().current_a < 20);
    }

    void aRestCorrectsTheCount() {
        pass(10, 24.4, 0);
        pass(1800, 24, 8); // counted: 19 % less; the voltage then says: 13 % less
        const double counted = *state().charge;
        pass(600, 24.14, 0);
        QVERIFY(*state().charge > counted + 0.01);
        QVERIFY(std::abs(*state().charge - 0.37) < 0.05);
    }

    void anotherBatteryIsNoticed() {
        pass(10, 23.5, 0);
        QVERIFY(*state().charge < 0.1);
        pass(10, 25.4, 0);
        QVERIFY2(*state().charge > 0.95, saying(*state().charge));
    }

    void aGapMakesUnsure() {
        pass(10, 24.4, 0);
        const double before = *state().chargeDeviation;
        now_ += 50; // nobody looked
        pass(0.1, 24.4, 5);
        QVERIFY(*state().chargeDeviation > before + 0.005);
    }

    void aLongGapForgets() {
        pass(10, 24.4, 0);
        now_ += 61;
        pass(0.1, 24.4, 5);
        QVERIFY(!state().charge);
        now_ -= 1e6; // no clock should, but it does no harm
        pass(10, 24.4, 0);
        QVERIFY(std::abs(*state().charge - 0.5) < 0.01);
    }

    void isRightWithinWhatItTells_data() { rowsOfSeeds(1, 20); }

    // A day of a robot on a battery with a resistance, whose gauge knows its capacity and idle current by 10
    // % only.
    void isRightWithinWhatItTells() {
        QFETCH(int, seed);
        std::mt19937 random(static_cast<unsigned>(seed));
        std::uniform_real_distribution<double> any(0, 1);
        simulator::Battery::Options options;
        options.capacity_Ah = 26 * (0.9 + 0.2 * any(random));
        simulator::Battery battery(options);
        battery.setCharge(0.3 + 0.7 * any(random));
        const double idle_a = 2 * (0.9 + 0.2 * any(random));
        int told = 0, within = 0;
        while (battery.charge() > 0.1 && now_ < 1000 + 6 * 3600) {
            const double motors_a = any(random) < 0.3 ? 0 : 15 * any(random),
                         until = now_ + 5 + 200 * any(random);
            for (; now_ < until; now_ += tick_s) {
                battery.draw(idle_a + motors_a, tick_s);
                const double tenths = std::round(10 * battery.voltage()) / 10; // as a RoboClaw tells it
                gauge_->take(now_, BatteryReading{{tenths, tenths}, motors_a});
            }
            if (!state().charge)
                continue;
            ++told;
            within += std::abs(*state().charge - battery.charge()) < 2 * *state().chargeDeviation;
        }
        QVERIFY2(told > 10 && within > 0.95 * told, saying("%1 of %2", within, told));
    }

    void anyInputGivesSenseOrNothing() {
        std::mt19937 random(7);
        const double values[] = {0,  -0.0, 1e-300, 1e300, -1e300,       23.4,     25.4,     24,
                                 -5, 0.5,  1,      1e9,   std::nan(""), INFINITY, -INFINITY};
        const auto any = [&] { return values[random() % std::size(values)]; };
        for (int i = 0; i < 100000; ++i) {
            now_ += i % 1000 == 0 ? 1e5 * double(random() % 3) - 1e5 : 0.1 * double(random() % 20);
            const bool isThere = random() % 8 != 0;
            const BatteryReading reading{{any(), any()}, any()};
            if (isThere)
                gauge_->take(now_, reading);
            else
                gauge_->take(now_, Error(ErrorCode::NotReady, "none"));
            for (const auto &share : {state().charge, state().chargeDeviation})
                QVERIFY(!share || (*share >= 0 && *share <= 1));
            for (const auto &time : {state().left_s, state().leftLeast_s})
                QVERIFY(!time || (*time >= 0 && *time <= 48 * 3600));
            QVERIFY(!state().current_a || *state().current_a >= 0);
            QVERIFY(state().charge.has_value() == state().reason.isEmpty());
        }
    }

private:
    static constexpr double tick_s = 0.1;
    void pass(double seconds, double voltage, double motors_a) {
        for (double end = now_ + seconds; now_ < end; now_ += tick_s)
            gauge_->take(now_, BatteryReading{{voltage, voltage}, motors_a});
    }
    void restAt(double voltage1, double voltage2, double seconds) {
        for (double end = now_ + seconds; now_ < end; now_ += tick_s)
            gauge_->take(now_, BatteryReading{{voltage1, voltage2}, 0});
    }
    static Telemetry ready() {
        Telemetry told;
        for (Telemetry::Controller &controller : told.controllers) {
            controller.ready = controller.readings.complete = true;
            controller.readings.battery_v = 24;
            controller.readings.current_a = {4, -4};
            controller.readings.duty = {0.5, -0.5};
        }
        return told;
    }
    const BatteryState &state() const { return gauge_->state(); }

    std::unique_ptr<BatteryGauge> gauge_;
    double now_ = 0;

private Q_SLOTS:
    void init() {
        gauge_ = std::make_unique<BatteryGauge>();
        now_ = 1000;
    }
};
