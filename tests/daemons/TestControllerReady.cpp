// What it takes that a motor controller is ready, and stays so: everything was read, in time, and is read on;
// and when it stands.
#include "ControllerBench.h"
#include "daemons/motorcontrol/StandstillWatch.h"
#include "protocol/roboclaw/Packet.h"

using namespace hermes;
using namespace hermes::simulator;
using namespace hermes::motorcontrol;
using roboclaw::Command;

Q_DECLARE_METATYPE(roboclaw::Command)

class TestControllerReady : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void standsByAcknowledgementAndReadings() {
        StandstillWatch watch;
        watch.setThreshold(1500);
        watch.read({1000, 0}, 1);
        watch.read({1000, 0}, 2);
        QVERIFY(!watch.stands()); // not acknowledged
        watch.acknowledged();
        watch.read({1000, 0}, 2.02);
        QVERIFY(!watch.stands()); // what was read before does not count
        watch.read({1001, quint32(-1)}, 2.04);
        QVERIFY(!watch.stands());
        watch.read({1001, quint32(-1)}, 2.07); // jitter, also across zero
        QVERIFY(watch.stands());
        watch.read({1100, 0}, 2.09);
        QVERIFY(!watch.stands() && watch.isMoving());
        QVERIFY(std::abs(watch.speed() - 99 / 0.02) < 1);
        watch.read({1100, 0}, 2.15);
        QVERIFY(watch.stands());
        watch.doubt();
        watch.read({1100, 0}, 2.2);
        watch.read({1100, 0}, 2.3);
        QVERIFY(!watch.stands());
    }

    // 100 counts a turn: in 50 ms a wheel at the threshold shows a fifth of a count.
    void standsByCoarseEncodersAfterLonger() {
        StandstillWatch watch;
        watch.setThreshold(4);
        watch.acknowledged();
        for (double time = 1; time < 1.49; time += 0.02) {
            watch.read({7, 7}, time);
            QVERIFY(!watch.stands());
        }
        watch.read({7, 7}, 1.51);
        QVERIFY(watch.stands());
    }

    void creepingIsMotionAfterASecond() {
        StandstillWatch watch;
        watch.setThreshold(1500);
        watch.acknowledged();
        double noticed = 0;
        for (int i = 0; i < 150; ++i) {
            const double time = 1 + i * 0.02;
            watch.read({quint32(1000 - 600 * time), 0}, time); // less than the threshold
            QVERIFY(i < 4 || watch.stands() != watch.isMoving());
            if (watch.isMoving() && noticed == 0)
                noticed = time;
        }
        QVERIFY2(noticed > 1.9 && noticed < 2.2, saying(noticed));
        for (int i = 0; i < 60; ++i)
            watch.read({0, 0}, 4 + i * 0.02);
        QVERIFY(watch.stands());
    }

    void lateAnswersSlowTheCycleDown_data() {
        const Rows<int, double, double> row("controllers", "latency", "least");
        row("10 ms, two", 2, 0.010, 15.0);
        row("16 ms, two", 2, 0.016, 10.0);
        row("16 ms, one", 1, 0.016, 17.0);
        row("30 ms, one", 1, 0.030, 10.0);
    }

    void lateAnswersSlowTheCycleDown() {
        FETCH(int, controllers, double, latency, double, least);
        ControllerBench bench(controllers);
        bench.latency = latency;
        QVERIFY2(bench.runUntil([&] { return bench.areReady(); }, 5),
                 qPrintable(bench.controller(0).error()));
        bench.speed = ControllerBench::fast;
        bench.run(1);
        bench.sent.clear();
        bench.run(10);
        QVERIFY(bench.areReady());
        std::map<int, std::map<Command, int>> counts;
        for (const auto &packet : bench.sent)
            ++counts[packet.controller][packet.command()];
        for (int i = 0; i < controllers; ++i) {
            QVERIFY(!bench.controller(i).isTooSlow());
            QVERIFY2(*bench.controller(i).rate_Hz() >= least, saying(*bench.controller(i).rate_Hz()));
            for (const Command command : {Command::SpeedAccel, Command::ReadEncoders})
                QVERIFY(counts[i][command] >= int(10 * least) - 2);
            QVERIFY(counts[i][Command::ReadStatus] >= 5);
        }
    }

    void tooLateAnswersAreRefused() {
        ControllerBench bench;
        bench.latency = 0.03;
        bench.speed = ControllerBench::fast;
        bench.run(5);
        for (int i = 0; i < 2; ++i) {
            QVERIFY(!bench.controller(i).isReady());
            const QString error = bench.controller(i).error();
            QVERIFY2(error.contains("31 ms") && error.contains("6.5 Hz") && error.contains("at least 10"),
                     qPrintable(error));
            QVERIFY(
                bench.runUntil([&] { return bench.controller(i).stands(); }, 1)); // is known in spite of it
        }
        QVERIFY(
            std::none_of(bench.sent.begin(), bench.sent.end(), [](const auto &p) { return p.isSetPoint(); }));
    }

    // It is set up anew again and again, in vain, and stands meanwhile.
    void refusedOnesAreKnownToStand() {
        ControllerBench bench;
        bench.latency = 0.023;
        QVERIFY(bench.runUntil([&] { return bench.controller(0).stands() && bench.controller(1).stands(); }));
        bench.run(3);
        for (int n = 0; n < 200; ++n) {
            bench.run(0.01);
            for (int i = 0; i < 2; ++i)
                QVERIFY2(bench.controller(i).stands(), qPrintable(bench.controller(i).error()));
        }
        VERIFY_CONTAINS(bench.controller(0).error(), "at least 10 are needed");
    }

    // Who answers as a RoboClaw does and calls itself otherwise is told to stand, and known to.
    void strangersAreKnownToStand() {
        ControllerBench bench(1);
        RoboClawEmulator::Options options;
        options.version = "Stranger 2x45A v4.2.8";
        RoboClawEmulator stranger(options);
        bench.passes = [&](const auto &packet, const auto &bytes) {
            auto answer = std::optional(bytes);
            for (std::size_t i = 0; packet.command() == Command::ReadVersion && i < packet.bytes.size(); ++i)
                for (const auto &part : stranger.receive(packet.bytes[i], packet.time))
                    answer = part.bytes;
            return answer;
        };
        QVERIFY(bench.runUntil([&] { return bench.controller(0).error().contains("Stranger"); }));
        for (int n = 0; n < 200; ++n) {
            bench.run(0.01);
            QVERIFY2(bench.controller(0).stands(), qPrintable(bench.controller(0).error()));
        }
        VERIFY_CONTAINS(bench.controller(0).error(), "Stranger");
    }

    void readyMeansThatEverythingWasRead_data() {
        const Rows<Command> row("missing");
        for (const Command command :
             {Command::ReadVersion, Command::SetSerialTimeout, Command::ReadSerialTimeout,
              Command::SetVelocityPidM1, Command::ReadVelocityPidM2, Command::ReadEncoders,
              Command::ReadStatus, Command::ReadCurrents, Command::ReadMainBattery, Command::ReadLogicBattery,
              Command::ReadTemperature})
            row(qPrintable(rowOf(command)), command);
    }

    void readyMeansThatEverythingWasRead() {
        QFETCH(Command, missing);
        ControllerBench bench;
        bench.hears = [=](const auto &packet) {
            return packet.controller != 1 || packet.command() != missing;
        };
        bool ready = false;
        bench.runUntil([&] { return ready = ready || bench.controller(1).isReady(); }, 8);
        QVERIFY(!ready);
        const QString says = QString("answers, but not command %1 (").arg(int(missing));
        QVERIFY2(bench.runUntil([&] { return bench.controller(1).error().contains(says); }, 2),
                 qPrintable(bench.controller(1).error()));
        if (missing == Command::SetSerialTimeout)
            VERIFY_CONTAINS(bench.controller(1).error(), "would not stop by itself");
    }

    // Only the gauge of the battery needs them. They are asked for seldom: what waits for an answer waits
    // with the stops.
    void withoutDutiesItIsDrivenAllTheSame() {
        ControllerBench bench;
        bool deaf = true;
        bench.hears = [&](const auto &packet) { return !deaf || packet.command() != Command::ReadPwm; };
        bench.driveOff();
        for (int i = 0; i < 3000; ++i) {
            bench.run(0.01);
            QVERIFY2(bench.areReady(), qPrintable(bench.controller(0).error()));
        }
        QVERIFY(bench.fastest() > 0.95 * ControllerBench::fast);
        QVERIFY(bench.controller(0).readings().complete && !bench.controller(0).readings().duty);
        const auto asked = std::count_if(bench.sent.begin(), bench.sent.end(),
                                         [](const auto &p) { return p.command() == Command::ReadPwm; });
        QVERIFY2(asked >= 4 && asked <= 8, saying(asked));
        deaf = false;
        QVERIFY(bench.runUntil([&] { return bench.controller(0).readings().duty.has_value(); }, 11));
        QVERIFY(bench.controller(0).readings().duty->at(0) > 0.1);
    }

    void dutiesThatAreToldNoMoreAreForgotten() {
        ControllerBench bench;
        bench.driveOff();
        bench.run(1);
        QVERIFY(bench.controller(0).readings().duty);
        const double began = bench.now();
        bench.passes = [](const auto &packet, const auto &bytes) {
            return packet.command() == Command::ReadPwm ? std::nullopt : std::optional(bytes);
        };
        QVERIFY(bench.runUntil([&] { return !bench.controller(0).readings().duty; }, 4));
        QVERIFY(bench.now() - began > 2); // one answer may be lost on any line
        bench.sent.clear();
        bench.run(30);
        QVERIFY2(bench.areReady(), qPrintable(bench.controller(0).error()));
        QVERIFY(bench.fastest() > 0.95 * ControllerBench::fast);
        const auto asked = std::count_if(bench.sent.begin(), bench.sent.end(),
                                         [](const auto &p) { return p.command() == Command::ReadPwm; });
        QVERIFY2(asked <= 8, saying(asked));
        bench.passes = ControllerBench().passes;
        QVERIFY(bench.runUntil([&] { return bench.controller(0).readings().duty.has_value(); }, 11));
    }

    void whatIsAnsweredNoMoreIsNamed_data() {
        const Rows<Command, double> row("missing", "after_s");
        for (const Command command : {Command::SpeedAccel, Command::ReadEncoders})
            row(qPrintable(rowOf(command)), command, 0.35);
        for (const Command command :
             {Command::ReadStatus, Command::ReadTemperature, Command::ReadSerialTimeout})
            row(qPrintable(rowOf(command)), command, 3.5);
    }

    void whatIsAnsweredNoMoreIsNamed() {
        FETCH(Command, missing, double, after_s);
        ControllerBench bench;
        bench.driveOff();
        bench.passes = [=](const auto &packet, const auto &bytes) {
            return packet.controller == 1 && packet.command() == missing ? std::nullopt
                                                                         : std::optional(bytes);
        };
        QVERIFY(bench.runUntil([&] { return !bench.controller(1).isReady(); }, after_s));
        const QString says = QString("answers, but not command %1 (").arg(int(missing));
        VERIFY_CONTAINS(bench.controller(1).error(), says);
        bench.speed = 0; // as the drive does when one is not ready
        QVERIFY(bench.runUntil([&] { return bench.fastest() == 0; }, 0.3));
    }

    void versionWithoutLineFeedIsTold() {
        ControllerBench bench(1);
        bench.passes = [](const ControllerBench::Packet &packet, const ControllerBench::Bytes &bytes) {
            if (packet.command() != Command::ReadVersion)
                return std::optional(bytes);
            ControllerBench::Bytes bare;
            for (const char c : {'R', 'o', 'b', 'o', 'C', 'l', 'a', 'w', '\0'})
                bare.push(std::uint8_t(c));
            const auto start = roboclaw::crc16(packet.bytes.data(), packet.bytes.size());
            bare.push16(roboclaw::crc16(bare.data(), bare.size(), start));
            return std::optional(bare);
        };
        QVERIFY2(bench.runUntil([&] { return bench.areReady(); }), qPrintable(bench.controller(0).error()));
        QCOMPARE(bench.controller(0).version(),
                 QString("RoboClaw (without the line feed that should end it)"));
    }

    // A controller that was without power for a moment would not stop by itself any more.
    void lostTimeoutIsSetAnew() {
        ControllerBench bench;
        bench.driveOff();
        const auto forget = roboclaw::Request::make(0x81, Command::SetSerialTimeout, {0})->bytes;
        for (std::size_t i = 0; i < forget.size(); ++i)
            bench.emulator(1).receive(forget[i], bench.now());
        QVERIFY(bench.runUntil([&] { return !bench.controller(1).isReady(); }, 0.5));
        VERIFY_STARTS(bench.controller(1).error(),
                      "has a time-out of 0 s, expected the 0.2 s that were written");
        bench.speed = 0;
        QVERIFY(bench.runUntil([&] { return bench.areReady(); }, 3));
        QCOMPARE(bench.emulator(1).timeout(), 0.2);
    }

    // As the settings may have it for a controller of another kind, which waits for a restart.
    void noTimeoutIsLongerThanHalfASecond() {
        ControllerBench bench(1, 2);
        QVERIFY(bench.runUntil([&] { return bench.areReady(); }));
        QCOMPARE(bench.emulator(0).timeout(), 0.5);
    }

private:
    static QString rowOf(Command command) { return QString("command %1").arg(int(command)); }
};
