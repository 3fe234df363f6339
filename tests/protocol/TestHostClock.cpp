// A sensor without GPS tells the time by the receiver's clock: drawn clocks, delays, losses and steps.
#include "protocol/scan/HostClock.h"
#include "protocol/velodyne/Hdl32e.h"
#include "protocol/velodyne/Vlp16.h"
#include "tests/support/Seed.h"

#include <random>

using namespace hermes::velodyne;
using hermes::scan::HostClock;

static constexpr std::int64_t second_ns = 1000000000;
static constexpr std::int64_t start_ns = 1700000000 * second_ns;

/// A sensor beside a host: truth is the host's clock as a packet's first laser fires.
struct Line {
    std::mt19937 random;
    std::int64_t period_ns = vlp16.packetPeriod_ns();
    double drift_ppm = 0, offset_s = 0, late_s = 0.0003;
    double stall = 0;                        ///< the share of packets that wait for up to 0.1 s
    double lost = 0;                         ///< the share of them that never come
    double step_s = 0, stepAt_s = 1e9;       ///< of the host's clock
    double ownStep_s = 0, ownStepAt_s = 1e9; ///< of the sensor's: it was started anew
    double drawn() { return std::uniform_real_distribution<>(0, 1)(random); }

    /// Calls take(seconds since the start, truth, stamp, when it was received) with each packet.
    template <typename Take>
    void run(double seconds, const Take &take) {
        std::int64_t arrives_ns = 0;
        for (std::int64_t t_ns = 0; t_ns < std::int64_t(seconds * 1e9); t_ns += period_ns) {
            const double t = double(t_ns) * 1e-9;
            const double own_s = t * (1 + drift_ppm * 1e-6) + offset_s + (t > ownStepAt_s ? ownStep_s : 0);
            const double delay_s = -late_s * std::log(1 - drawn()) + (drawn() < stall ? 0.1 * drawn() : 0);
            arrives_ns =
                std::max(arrives_ns, t_ns + period_ns + std::int64_t(delay_s * 1e9)); // in their order
            if (drawn() < lost)
                continue;
            const auto host = [&](std::int64_t since_ns) {
                const bool stepped = double(since_ns) * 1e-9 > stepAt_s;
                return start_ns + since_ns + (stepped ? std::int64_t(step_s * 1e9) : 0);
            };
            const auto stamp_us = std::uint32_t(std::int64_t(own_s * 1e6) % std::int64_t(stampPeriod_us));
            take(t, host(t_ns), stamp_us, host(arrives_ns));
        }
    }
};

class TestHostClock : public QObject {
    Q_OBJECT
private Q_SLOTS:
    /// Ten seconds after the start, and after either clock was set, a stamp is within 5 ms of the truth, and
    /// its bound is true. Stamps keep their order but where a clock jumps.
    void stampsAreTrue() {
        std::mt19937 random(newSeed());
        for (int i = 0; i < 100; ++i) {
            Line line{std::mt19937(random())};
            line.period_ns = line.drawn() < 0.5 ? vlp16.packetPeriod_ns() : hdl32e.packetPeriod_ns();
            line.drift_ppm = 200 * line.drawn() - 100;
            line.offset_s = i % 10 == 0 ? 0 : 3600 * line.drawn();
            line.late_s = 0.001 * line.drawn();
            line.stall = 0.01 * line.drawn();
            line.lost = 0.05 * line.drawn();
            const std::array<double, 5> steps{0, 600, -600, 0.3, -0.3};
            line.step_s = steps[std::size_t(i) % steps.size()];
            line.stepAt_s = 15;
            line.ownStep_s = i % 3 == 0 ? 3600 * line.drawn() : 0;
            line.ownStepAt_s = 30;
            HostClock clock(stampPeriod_ns);
            std::int64_t last_ns = 0;
            QByteArray wrong;
            line.run(45, [&](double t, std::int64_t truth_ns, std::uint32_t stamp_us,
                             std::int64_t receive_ns) {
                const HostClock::Time time =
                    clock.take(stamp_us * std::int64_t(1000), receive_ns, line.period_ns);
                const bool hasSettled = (t > 10 && t < 14.8) || (t > 25 && t < 29.8) || t > 40;
                const double off_s = std::abs(double(time.stamp_ns - truth_ns)) * 1e-9;
                const bool isOff =
                    hasSettled && (off_s > 0.005 || off_s > double(time.bound_ns) * 1e-9 + 0.002);
                const bool mayJump =
                    t == 0 || std::abs(t - line.stepAt_s) < 0.2 || std::abs(t - line.ownStepAt_s) < 0.2;
                if (wrong.isEmpty() && (isOff || (!mayJump && time.stamp_ns <= last_ns)))
                    wrong = saying("case %1 at %2 s: off by %3 s, bound %4 s, %5 ns after the one before", i,
                                   t, off_s, double(time.bound_ns) * 1e-9, qint64(time.stamp_ns - last_ns));
                last_ns = time.stamp_ns;
            });
            QVERIFY2(wrong.isEmpty(), wrong);
            const bool jumps = std::abs(line.step_s) > 1;
            QCOMPARE(clock.steps() > 0, !jumps && line.step_s != 0);
            QVERIFY(clock.restarts() <= std::uint64_t(line.ownStep_s != 0)); // whatever the host's clock does
        }
    }

    void hoursPassWithoutAJump() {
        Line line{std::mt19937(newSeed())};
        line.period_ns = second_ns / 20; // a thinned stream
        line.drift_ppm = 100;
        line.offset_s = 3599;
        HostClock clock(stampPeriod_ns);
        line.run(8000, [&](double t, std::int64_t truth_ns, std::uint32_t stamp_us, std::int64_t receive_ns) {
            const HostClock::Time time =
                clock.take(stamp_us * std::int64_t(1000), receive_ns, line.period_ns);
            if (t > 10)
                QVERIFY(std::abs(time.stamp_ns - truth_ns) < 5000000);
        });
        QCOMPARE(clock.restarts(), std::uint64_t(0));
    }

    /// So a replay, and a map of a recording, have the stamps of the drive.
    void whoBeginsLaterGetsTheSame() {
        Line line{std::mt19937(newSeed())};
        line.drift_ppm = -60;
        line.stall = 0.01;
        HostClock early(stampPeriod_ns), late(stampPeriod_ns);
        line.run(12, [&](double t, std::int64_t, std::uint32_t stamp_us, std::int64_t receive_ns) {
            const HostClock::Time time =
                early.take(stamp_us * std::int64_t(1000), receive_ns, line.period_ns);
            if (t < 7.3)
                return;
            const HostClock::Time again =
                late.take(stamp_us * std::int64_t(1000), receive_ns, line.period_ns);
            if (t > 10.3)
                QCOMPARE(qint64(again.stamp_ns), qint64(time.stamp_ns));
        });
    }

    void stampsBeyondTheHourAreOfTheNext() {
        HostClock clock(stampPeriod_ns);
        clock.take(3599999000000, start_ns, 0);
        QCOMPARE(qint64(clock.take(3600001000000, start_ns + 2000000, 0).stamp_ns),
                 qint64(start_ns + 2000000));
        QCOMPARE(qint64(clock.take(3000000, start_ns + 4000000, 0).stamp_ns), qint64(start_ns + 4000000));
    }
};
