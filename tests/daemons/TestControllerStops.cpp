// What goes over the line of the motor controllers when they do not answer as they should: stops first, stops
// until they stand, silence in between; fair turns at any latency; what it takes to be ready.
#include "ControllerBench.h"
#include "daemons/motorcontrol/StandstillWatch.h"
#include "protocol/roboclaw/Packet.h"

using namespace hermes;
using namespace hermes::simulator;
using namespace hermes::motorcontrol;
using roboclaw::Command;

Q_DECLARE_METATYPE(decltype(ControllerBench::passes))
Q_DECLARE_METATYPE(roboclaw::Command)

class TestControllerStops : public QObject {
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

    void nothingButStopsBeforeItStands() {
        ControllerBench bench;
        bench.emulator(1).channel(0).driveSpeed(
            fast); // from a program that ran before, which a new one must not feed
        bench.emulator(1).channel(0).setPid({1, 0.5, 0.25, 150000});
        bench.runUntil([&] { return bench.areReady(); });
        QVERIFY(bench.areReady());
        for (int i = 0; i < 2; ++i) {
            QVERIFY(bench.controller(i).stands());
            bool stopped = false, asked = false;
            for (const auto &packet : bench.sent) {
                if (packet.controller != i)
                    continue;
                stopped = stopped || packet.isStop();
                asked = asked || (stopped && packet.command() == Command::ReadVersion);
                QVERIFY(asked || packet.isStop() || packet.command() == Command::ReadEncoders);
            }
        }
        QCOMPARE(bench.fastest(), 0.0);
    }

    void stopsGoBeforeAllElse() {
        ControllerBench bench;
        bench.latency = 0.015;
        driveOff(bench);
        bench.speed = 0;
        bench.run(0.05); // the next cycle, and the answer that is waited for
        int before = 0;
        for (int i = 0; i < 2; ++i) {
            const auto stop = std::find_if(bench.sent.begin(), bench.sent.end(),
                                           [i](const auto &p) { return p.controller == i && p.isStop(); });
            QVERIFY(stop != bench.sent.end());
            before = std::max(before, int(stop - bench.sent.begin()));
        }
        QVERIFY2(before <= 3, saying(before)); // in 20 ms two others fit
    }

    void whoIsNotHeardIsStoppedInSilence_data() {
        using Passes = decltype(ControllerBench::passes);
        const Rows<Passes, double, double> row("passes", "latency", "timeout_s");
        const Passes nothing = [](const auto &, const auto &) { return std::nullopt; };
        const Passes damaged = [](const auto &, const auto &bytes) {
            ControllerBench::Bytes wrong;
            for (std::size_t i = 0; i < bytes.size(); ++i)
                wrong.push(std::uint8_t(bytes[i] ^ (i == 0 ? 4 : 0)));
            return std::optional(wrong);
        };
        for (const double timeout_s : {0.2, 0.5}) {
            const QByteArray name = ", " + QByteArray::number(timeout_s);
            row("mute" + name, nothing, 0.0, timeout_s);
            row("damaged" + name, damaged, 0.0, timeout_s);
            row(
                "late" + name, [](const auto &, const auto &b) { return std::optional(b); }, 0.1, timeout_s);
        }
    }

    void whoIsNotHeardIsStoppedInSilence() {
        FETCH(decltype(ControllerBench::passes), passes, double, latency, double, timeout_s);
        ControllerBench bench(2, timeout_s);
        driveOff(bench);
        bench.passes = passes;
        bench.latency = latency;
        QVERIFY(bench.runUntil(
            [&] { return !bench.controller(0).isReady() && !bench.controller(1).isReady(); }, 1));
        QVERIFY(bench.runUntil([&] { return bench.fastest() == 0; }, 0.4)); // they hear
        QVERIFY(!bench.controller(0).stands() && !bench.controller(1).stands());
        const double lost = bench.now();
        bench.speed = fast; // whoever asks
        bench.run(3);
        QCOMPARE(bench.fastest(), 0.0);
        double last = lost, pause = 0, shortest = 10;
        for (const auto &packet : bench.sent) {
            if (packet.time <= lost)
                continue;
            QVERIFY2(latency > 0 || packet.isStop(), qPrintable(rowOf(packet.command())));
            pause = packet.time - last;
            shortest = last > lost ? std::min(shortest, pause) : shortest;
            last = packet.time;
        }
        if (latency == 0)
            QVERIFY2(shortest > timeout_s + 0.05, saying(shortest));
        bench.speed = 0;
        bench.passes = ControllerBench().passes;
        bench.latency = 0;
        QVERIFY(bench.runUntil([&] { return bench.areReady(); }, 4));
    }

    void whoKeepsItsSetPointIsStoppedBySilence() {
        ControllerBench bench;
        driveOff(bench);
        bool latched = true;
        bench.hears = [&](const auto &packet) {
            return !latched || packet.controller != 0 ||
                   (packet.command() != Command::SpeedAccel && packet.command() != Command::Duty);
        };
        // It acknowledges all the same, and its time-out hears the bytes: so it hears another command
        // instead.
        bench.passes = [](const auto &, const auto &bytes) { return std::optional(bytes); };
        auto &emulator = bench.emulator(0);
        bench.hears = [&](const ControllerBench::Packet &packet) {
            if (packet.controller == 0 && (packet.isStop() || packet.isSetPoint())) {
                const auto harmless = roboclaw::Request::make(0x80, Command::SetSerialTimeout, {2})->bytes;
                for (std::size_t i = 0; i < harmless.size(); ++i)
                    emulator.receive(harmless[i], packet.time);
                const std::uint8_t ack = 0xFF;
                bench.line->feed(&ack, 1, packet.time);
                return false;
            }
            return true;
        };
        bench.speed = 0;
        const double told = bench.now();
        QVERIFY(bench.runUntil([&] { return bench.fastest() == 0; }, 2));
        const double took = bench.now() - told;
        // Braking from 0.5 m/s and half of it more, 0.2 s and three readings, the time-out and 0.1 s.
        QVERIFY2(took < 0.19 + 0.26 + 0.3 + 0.05, saying(took));
        QVERIFY(!bench.controller(0).takeDisobedience().isEmpty());
        QVERIFY(bench.controller(0).takeDisobedience().isEmpty());
        bench.run(3);
        QCOMPARE(bench.fastest(), 0.0);
    }

    // While the line is silent for the first one, the second one is not lost.
    void theOtherOneOnTheLineStaysReady() {
        ControllerBench bench;
        driveOff(bench);
        bench.hears = [](const auto &packet) { return packet.controller != 0; };
        bench.speed = 0;
        QVERIFY(bench.runUntil([&] { return !bench.controller(0).isReady(); }, 1));
        for (int i = 0; i < 300; ++i) {
            bench.run(0.01);
            QVERIFY2(bench.controller(1).isReady(), qPrintable(bench.controller(1).error()));
        }
        QCOMPARE(bench.controller(0).error(), QString("does not answer"));
        QVERIFY(bench.controller(1).stands());
    }

    void whoIsStoppedOnASlowLineHasItsTurns_data() {
        Rows<double, double>("latency", "loss");
        for (const double latency : {0.0, 0.010, 0.016}) {
            for (const double loss : {0.5, 0.9, 1.0})
                QTest::addRow("%g ms, %g lost", 1000 * latency, loss) << latency << loss;
        }
    }

    // The other one, which answers, takes all the time that a slow line has.
    void whoIsStoppedOnASlowLineHasItsTurns() {
        FETCH(double, latency, double, loss);
        ControllerBench bench;
        bench.latency = latency;
        driveOff(bench);
        std::mt19937 random(3);
        bench.passes = [&](const auto &packet, const auto &bytes) {
            const bool lost =
                packet.controller == 0 && std::uniform_real_distribution<double>()(random) < loss;
            return lost ? std::nullopt : std::optional(bytes);
        };
        for (const double began = bench.now(); bench.now() < began + 20;) {
            bench.speed = bench.areReady() ? fast : 0; // as the drive does
            bench.run(0.02);
            const auto last = std::find_if(bench.sent.rbegin(), bench.sent.rend(),
                                           [](const auto &packet) { return packet.controller == 0; });
            const double heard = last == bench.sent.rend() ? began : last->time;
            QVERIFY2(bench.now() - heard < 0.8, qPrintable(bench.controller(0).error()));
        }
        bench.speed = 0;
        bench.passes = ControllerBench().passes;
        QVERIFY2(bench.runUntil([&] { return bench.areReady(); }, 5),
                 qPrintable(bench.controller(0).error()));
    }

    // One that turns on whatever it is told, and has no time-out from before, is given one; then silence
    // stops it.
    void aTimeoutIsToldBeforeTheSilence() {
        ControllerBench bench(1);
        bench.emulator(0).channel(0).setPid({1, 0.5, 0.25, 150000});
        bench.emulator(0).channel(0).driveSpeed(fast);
        bench.emulator(0).faults().latched = true;
        QCOMPARE(bench.emulator(0).serialTimeout(), 0.0);
        bench.run(0.2);
        QVERIFY(bench.fastest() > 0.9 * fast);
        QVERIFY(bench.runUntil([&] { return bench.fastest() == 0; }, 3));
    }

    void whoIsBarredIsLeftInSilence() {
        ControllerBench bench;
        driveOff(bench);
        bench.controller(0).bar("is barred");
        bench.speed = 0;
        bench.run(12);
        QCOMPARE(bench.fastest(), 0.0);
        QVERIFY(!bench.controller(0).isReady() && !bench.controller(0).stands());
        QCOMPARE(bench.controller(0).error(), QString("is barred"));
        int stops = 0;
        for (const auto &packet : bench.sent) {
            if (packet.controller != 0 || !packet.isStop())
                continue;
            ++stops;
            for (const auto &other : bench.sent)
                QVERIFY(other.time <= packet.time || other.isStop() || other.time > packet.time + silence_s);
        }
        QCOMPARE(stops, 3);
        bench.controller(0).release();
        QVERIFY(bench.runUntil([&] { return bench.areReady(); }, 2));
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
        bench.speed = fast;
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
        bench.speed = fast;
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
        driveOff(bench);
        for (int i = 0; i < 3000; ++i) {
            bench.run(0.01);
            QVERIFY2(bench.areReady(), qPrintable(bench.controller(0).error()));
        }
        QVERIFY(bench.fastest() > 0.95 * fast);
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
        driveOff(bench);
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
        QVERIFY(bench.fastest() > 0.95 * fast);
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
        driveOff(bench);
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
        driveOff(bench);
        const auto forget = roboclaw::Request::make(0x81, Command::SetSerialTimeout, {0})->bytes;
        for (std::size_t i = 0; i < forget.size(); ++i)
            bench.emulator(1).receive(forget[i], bench.now());
        QVERIFY(bench.runUntil([&] { return !bench.controller(1).isReady(); }, 0.5));
        VERIFY_STARTS(bench.controller(1).error(),
                      "has a time-out of 0 s, expected the 0.2 s that were written");
        bench.speed = 0;
        QVERIFY(bench.runUntil([&] { return bench.areReady(); }, 3));
        QCOMPARE(bench.emulator(1).serialTimeout(), 0.2);
    }

    // As the settings may have it for a controller of another kind, which waits for a restart.
    void noTimeoutIsLongerThanHalfASecond() {
        ControllerBench bench(1, 2);
        QVERIFY(bench.runUntil([&] { return bench.areReady(); }));
        QCOMPARE(bench.emulator(0).serialTimeout(), 0.5);
    }

private:
    static constexpr qint32 fast = 30000; // counts/s: half a metre a second
    static constexpr double silence_s = 0.3;

    static void driveOff(ControllerBench &bench) {
        QVERIFY2(bench.runUntil([&] { return bench.areReady(); }), qPrintable(bench.controller(0).error()));
        bench.speed = fast;
        QVERIFY(bench.runUntil([&] { return bench.fastest() > 0.95 * fast; }));
        bench.sent.clear();
    }

    static QString rowOf(Command command) { return QString("command %1").arg(int(command)); }
};
