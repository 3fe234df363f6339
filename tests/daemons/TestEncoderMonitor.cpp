// What one wheel was told against what its encoder says.
#include "daemons/motorcontrol/EncoderMonitor.h"

Q_DECLARE_METATYPE(std::function<double(double)>)
Q_DECLARE_METATYPE(std::function<double(double, double)>)

using namespace hermes;
using namespace hermes::motorcontrol;
using Mismatch = EncoderMonitor::Mismatch;

static const double notANumber = std::numeric_limits<double>::quiet_NaN();

// When a fault is found in so many seconds, told and measured by their time.
template <typename At>
static std::optional<double> faultAfter(EncoderMonitor &monitor, At at, double seconds = 2) {
    static double begin = 1;
    const double since = std::exchange(begin, begin + seconds);
    for (double t = 0; t < seconds; t += 0.02) {
        const auto [told, measured] = at(t);
        if (monitor.judge(told, measured, since + t) != Mismatch::None)
            return t;
    }
    return std::nullopt;
}

class TestEncoderMonitor : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void whatIsAMismatch_data() {
        const Rows<double, double, int, double> row("commanded", "measured", "expected", "duty");
        row("follows", 5.0, 4.5, int(Mismatch::None), 0.0);
        row("both stand", 0.0, 0.0, int(Mismatch::None), 0.0);
        row("commanded but not moving", 5.0, 0.1, int(Mismatch::StandsStill), 0.0);
        row("commanded backwards but not moving", -5.0, 0.0, int(Mismatch::StandsStill), 0.0);
        row("moving but not commanded", 0.0, -0.3, int(Mismatch::MovesUncommanded), 0.0);
        row("runs away", 2.0, -6.0, int(Mismatch::MovesBackwards), 0.0);
        row("too slow to judge", 0.4, 0.0, int(Mismatch::None), 0.4);
        row("slowly told, pushed and not moving", 0.1, 0.0, int(Mismatch::StandsStill), 0.6);
        row("slowly told backwards, pushed and not moving", -0.1, 0.0, int(Mismatch::StandsStill), -0.6);
        row("follows a hill slowly", 0.4, 0.4, int(Mismatch::None), 0.6);
        row("told to stand, duty of before", 0.0, 0.0, int(Mismatch::None), 0.6);
        row("against a slow command", 0.3, -9.9, int(Mismatch::MovesBackwards), 0.0);
        row("far faster than a slow command", 0.3, 9.9, int(Mismatch::MovesTooFast), 0.0);
        row("brakes", 5.0, 10.0, int(Mismatch::None), 0.0);
        row("no number", 0.0, notANumber, int(Mismatch::MovesUncommanded), 0.0);
    }

    void whatIsAMismatch() {
        FETCH(double, commanded, double, measured, double, duty);
        EncoderMonitor monitor;
        Mismatch found = Mismatch::None;
        for (int i = 0; i <= 30; ++i)
            found = monitor.judge(commanded, measured, 1 + 0.02 * i, duty);
        QTEST(int(found), "expected");
    }

    // A heavy robot creeps: each start needs a push.
    void aPushThatMovesTheWheelIsNoFault() {
        EncoderMonitor monitor;
        for (int i = 0; i < 1000; ++i)
            QVERIFY(monitor.judge(0.3, i % 40 < 8 ? 0 : 0.3, 1 + 0.02 * i, 0.6) == Mismatch::None);
    }

    void aMismatchNeedsTime() {
        EncoderMonitor monitor;
        QVERIFY(!faultAfter(monitor, [](double) { return std::pair(10.0, 10.0); }));
        QVERIFY(!faultAfter(monitor,
                            [](double t) { return std::pair(0.0, std::max(0.0, 10 - 40 * t)); })); // brakes
        const auto after = faultAfter(monitor, [](double) { return std::pair(0.0, 1.0); });
        QVERIFY(after && *after > 0.45 && *after < 0.55);
        monitor.skip();
        QVERIFY(monitor.judge(0, 1, 100) == Mismatch::MovesUncommanded); // what has added up stays
        QVERIFY(!faultAfter(monitor,
                            [](double) { return std::pair(5.0, 5.0); })); // seen to follow, it counts anew
        QVERIFY(monitor.judge(0, 5, 110.3) == Mismatch::None);
    }

    // Whatever is commanded meanwhile, the time of what no command explains adds up.
    void mismatchesAddUp_data() {
        using Told = std::function<double(double)>;
        using Measured = std::function<double(double, double)>;               // time, told
        const Rows<Told, Measured, double> row("told", "measured", "latest"); // latest: 0: no fault at all
        const auto taps = [](double on, double off, double speed) {
            return Told([=](double t) { return std::fmod(t, on + off) < on ? speed : 0; });
        };
        const Told toAndFro = [](double t) { return std::fmod(t, 0.7) < 0.35 ? 2.0 : -2.0; };
        const Measured runsAway = [](double, double) { return -28.0; },
                       stands = [](double, double) { return 0.0; };
        // As a motor follows: late, and with the ramp of its controller.
        const auto follows = [] {
            return Measured([speed = 0.0, last = 0.0](double t, double told) mutable {
                const double step = 40 * (t - std::exchange(last, t));
                return speed += std::clamp(told - speed, -step, step);
            });
        };
        // As the bus tells it: what was commanded two cycles ago.
        const Measured followsLate = [before = std::array<double, 2>{}](double, double told) mutable {
            const double shown = before[1];
            before = {told, before[0]};
            return shown;
        };
        row("backward, to and fro", toAndFro, runsAway, 0.7);
        row("backward, tapped", taps(0.4, 0.4, 2), runsAway, 0.7);
        row("backward, tapped fast", taps(0.06, 0.06, 2), runsAway, 0.7);
        row("stands, tapped", taps(0.4, 0.4, 2), stands, 1.3);
        row("stands, to and fro", toAndFro, stands, 0.8);
        row("stands, tapped seldom", taps(0.3, 2, 2), stands, 5.0);
        row("follows, to and fro", toAndFro, follows(), 0.0);
        row("follows, tapped", taps(0.1, 0.1, 5), follows(), 0.0);
        row("follows, full speed and stops", taps(1, 1, 20), follows(), 0.0);
        row("follows late, creeping in short taps", taps(0.06, 0.1, 0.45), followsLate, 0.0);
    }

    void mismatchesAddUp() {
        using Told = std::function<double(double)>;
        using Measured = std::function<double(double, double)>;
        FETCH(Told, told, Measured, measured, double, latest);
        EncoderMonitor monitor;
        const auto after = faultAfter(
            monitor, [&](double t) { return std::pair(told(t), measured(t, told(t))); }, 20);
        QCOMPARE(after.has_value(), latest > 0);
        QVERIFY2(!after || *after < latest, saying(after.value_or(0)));
    }
};
