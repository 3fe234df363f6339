#include "daemons/motorcontrol/WheelTracker.h"

using namespace hermes;
using namespace hermes::motorcontrol;

/// Counters become motions; what was lost is told from what was really driven.
class TestWheelTracker : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        tracker_ = {};
        readings_ = {};
        tracker_.configure({WheelMount{0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}}, countsPerTurn, maxSpeed);
    }

    void motions_data() {
        const Rows<double, double, bool, bool> row(
            "gap_s", "turn", "isSetUpAgain",
            "plausible"); // turn: rad, of all wheels; NaN: the second controller begins at zero again
        row("a cycle", 0.02, 0.3, false, true);
        row("a cycle, too far", 0.02, 2.5, false, false);
        row("set out during a silence", 0.3, 4.0, false, true); // it stood at the reading before
        row("set out while it was set up again", 0.12, 2.0, true, true);
        row("rolled to a stop in a long silence", 30, 15.0, true, true);
        row("no wheel runs on for so long", 30, 25.0, true, false);
        row("without power for a moment", 0.1, qQNaN(), true, false);
        row("without power for long", 5, qQNaN(), true, false);
    }

    void motions() {
        FETCH(double, gap_s, double, turn, bool, isSetUpAgain, bool, plausible);
        const quint32 before = counts(8);
        QVERIFY(!read(1, before, before));
        QVERIFY(read(1.02, before, before)->plausible);
        readings_[1].setups += int(isSetUpAgain);
        const quint32 after = std::isnan(turn) ? before : before + counts(turn);
        const auto motion = read(1.02 + gap_s, after, std::isnan(turn) ? 0 : after);
        QVERIFY(motion);
        QCOMPARE(motion->plausible, plausible);
        for (const double turned : motion->turns)
            QVERIFY2(std::abs(turned - (plausible ? turn : 0)) < 0.01, saying(turned));
    }

    void countersWrap() {
        QVERIFY(!read(1, 0xfffffff0u, 5));
        const auto motion = read(1.02, 0x10u, 0xfffffff5u);
        QVERIFY(motion && motion->plausible);
        QVERIFY(motion->turns[0] > 0 && motion->turns[2] < 0);
    }

private:
    static constexpr double countsPerTurn = 1000, maxSpeed = 20;
    static quint32 counts(double turn) {
        return quint32(qint32(std::lround(turn * countsPerTurn / (2 * M_PI))));
    }

    /// The readings of both controllers, whose wheels stand at that many counts.
    std::optional<WheelMotion> read(double time, quint32 first, quint32 second) {
        readings_[0].counts = {first, first};
        readings_[1].counts = {second, second};
        for (drive::Readings &readings : readings_)
            readings.countsTime = time;
        return tracker_.update({&readings_[0], &readings_[1]});
    }

    WheelTracker tracker_;
    std::array<drive::Readings, 2> readings_;
};
