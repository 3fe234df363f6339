// A RoboClaw that was without power for a moment answers again with counts of 0 and without its time-out:
// what it is told until somebody knows.
#include "ControllerBench.h"
#include "daemons/motorcontrol/RestartWatch.h"

class TestRestarts : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void isStoppedByItsCounts_data() {
        const Rows<double, double> row("drives", "dead");
        for (int cycle = 0; cycle < 13; ++cycle) // its slow readings take turns
            for (const double dead : {0.0, 0.05, 0.12})
                row(qPrintable(QString("%1, %2 s").arg(cycle).arg(dead)), 1.5 + 0.02 * cycle, dead);
    }

    // Frozen then, this program would leave it turning for ever.
    void isStoppedByItsCounts() {
        FETCH(double, drives, double, dead);
        ControllerBench bench;
        QVERIFY(bench.runUntil([&] { return bench.areReady(); }));
        bench.speed = 60000;
        bench.run(drives);
        QVERIFY(bench.areReady());
        bench.emulator(0).restart(dead);
        bench.run(dead);
        const std::size_t from = bench.sent.size();
        QVERIFY(bench.runUntil([&] { return !bench.controller(0).isReady(); }, 0.5));
        const auto driven = std::count_if(bench.sent.begin() + std::ptrdiff_t(from), bench.sent.end(),
                                          [](const auto &p) { return p.controller == 0 && p.isSetPoint(); });
        QVERIFY2(driven <= 2, qPrintable(QString("%1 set-points without time-out").arg(driven)));
        bench.speed = 0;
        QVERIFY(bench.runUntil([&] { return bench.areReady(); }, 5)); // with its time-out
        QVERIFY(std::abs(bench.emulator(0).timeout() - 0.2) < 1e-9);
    }

    // Told to stand it may not obey: without its time-out no silence would stop it.
    void isGivenItsTimeoutBeforeTheSilence() {
        for (int cycle = 0; cycle < 13; ++cycle) { // its slow readings take turns
            ControllerBench bench;
            bench.driveOff();
            bench.run(0.02 * cycle);
            bench.emulator(0).restart(0);
            QVERIFY(bench.runUntil([&] { return !bench.controller(0).isReady(); }, 0.5));
            QCOMPARE(bench.emulator(0).timeout(), 0.0);
            bench.emulator(0).channel(0).setPid({1, 0.5, 0.25, 150000});
            bench.emulator(0).channel(0).driveSpeed(ControllerBench::fast); // its last set-point
            bench.emulator(0).faults().latched = true;
            bench.speed = 0;
            bench.run(0.2);
            QVERIFY(bench.fastest() > 0);
            QVERIFY(bench.runUntil([&] { return bench.fastest() == 0; }, 3));
        }
    }

    // An answer that comes late was counted before it was asked for.
    void lateCountsAreNoRestart() {
        constexpr double fastest = 10000; // counts/s
        hermes::motorcontrol::RestartWatch watch;
        const auto read = [&](double counted, double sent) {
            hermes::drive::Bus::Outcome outcome;
            outcome.sent = sent;
            outcome.received = sent + 0.01;
            const auto count = std::uint32_t(0.9 * fastest * counted);
            return watch.judge({count, count}, outcome, fastest);
        };
        const auto plausible = hermes::motorcontrol::RestartWatch::Verdict::Plausible;
        QVERIFY(read(1.0, 1.0) == plausible && read(1.02, 1.02) == plausible);
        watch.missed();
        QVERIFY(read(1.1, 1.2) == plausible); // asked for at 1.1
        QVERIFY(read(1.22, 1.22) == plausible);
        QVERIFY(read(1.8, 1.24) == hermes::motorcontrol::RestartWatch::Verdict::ReadAgain);
    }

    // The counts of one wheel that jump are a fault of its encoder.
    void oneEncoderThatJumpsIsNoRestart() {
        ControllerBench bench;
        QVERIFY(bench.runUntil([&] { return bench.areReady(); }));
        bench.speed = 40000;
        bench.run(1.5);
        bench.emulator(0).channel(0).setCount(0);
        bench.run(0.2);
        QVERIFY(bench.areReady());
    }
};
