// What goes over the line of the motor controllers when they do not answer as they should: stops first, stops
// until they stand, silence in between; fair turns.
#include "ControllerBench.h"
#include "protocol/roboclaw/Packet.h"

using namespace hermes;
using namespace hermes::simulator;
using namespace hermes::motorcontrol;
using roboclaw::Command;

Q_DECLARE_METATYPE(decltype(ControllerBench::passes))

class TestControllerStops : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void nothingButStopsBeforeItStands() {
        ControllerBench bench;
        bench.emulator(1).channel(0).driveSpeed(
            ControllerBench::fast); // from a program that ran before, which a new one must not feed
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
        bench.driveOff();
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
        bench.driveOff();
        bench.passes = passes;
        bench.latency = latency;
        QVERIFY(bench.runUntil(
            [&] { return !bench.controller(0).isReady() && !bench.controller(1).isReady(); }, 1));
        QVERIFY(bench.runUntil([&] { return bench.fastest() == 0; }, 0.4)); // they hear
        QVERIFY(!bench.controller(0).stands() && !bench.controller(1).stands());
        const double lost = bench.now();
        bench.speed = ControllerBench::fast; // whoever asks
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
        bench.driveOff();
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
        bench.driveOff();
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
        bench.driveOff();
        std::mt19937 random(3);
        bench.passes = [&](const auto &packet, const auto &bytes) {
            const bool lost =
                packet.controller == 0 && std::uniform_real_distribution<double>()(random) < loss;
            return lost ? std::nullopt : std::optional(bytes);
        };
        for (const double began = bench.now(); bench.now() < began + 20;) {
            bench.speed = bench.areReady() ? ControllerBench::fast : 0; // as the drive does
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
        bench.emulator(0).channel(0).driveSpeed(ControllerBench::fast);
        bench.emulator(0).faults().latched = true;
        QCOMPARE(bench.emulator(0).timeout(), 0.0);
        bench.run(0.2);
        QVERIFY(bench.fastest() > 0.9 * ControllerBench::fast);
        QVERIFY(bench.runUntil([&] { return bench.fastest() == 0; }, 3));
    }

    void whoIsBarredIsLeftInSilence() {
        ControllerBench bench;
        bench.driveOff();
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

private:
    static constexpr double silence_s = 0.3;

    static QString rowOf(Command command) { return QString("command %1").arg(int(command)); }
};
