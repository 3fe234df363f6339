// hermesctl conform scanner: what hermes-scanmatcher relies on, tried with any daemon that publishes scan2d.
#include "gui/hermesctl/Conformance.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>

namespace hermes::ctl {
namespace {

constexpr double inDegrees = 180 / vectorlib::pi;
using Scan = const ScanMessage &;

double angleOf(Scan scan, std::size_t point) {
    return std::atan2(double(scan.y[point]), double(scan.x[point]));
}

std::size_t pointsOf(Scan scan) {
    return std::min(scan.x.size(), scan.y.size());
}

/// Radians between neighbouring points, the median.
double usualStep(Scan scan) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < pointsOf(scan); ++i)
        steps.push_back(std::abs(vectorlib::wrapAngle(angleOf(scan, i) - angleOf(scan, i - 1))));
    if (steps.empty())
        return 0;
    const auto middle = steps.begin() + std::ptrdiff_t(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

/// Metres, a mean: how badly a scan is that of before from a sensor that has turned by so much.
double misfit(Scan before, Scan after, double turned) {
    const auto degreeOf = [](double angle) { return std::size_t(angle * inDegrees + 720) % 360; };
    std::array<double, 360> ranges{}; // 0: no point
    for (std::size_t i = 0; i < pointsOf(before); ++i)
        ranges[degreeOf(angleOf(before, i))] = std::hypot(before.x[i], before.y[i]);
    double sum = 0, count = 1e-9;
    for (std::size_t i = 0; i < pointsOf(after); ++i)
        if (const double was = ranges[degreeOf(angleOf(after, i) + turned)]; was > 0) {
            sum += std::min(std::abs(was - std::hypot(double(after.x[i]), double(after.y[i]))), 1.0);
            ++count;
        }
    return sum / count;
}

class ScannerTest : Conformance {
public:
    ScannerTest(Client &client, const Arguments &arguments)
        : Conformance(arguments)
        , scans_(client, "scan2d") {
        pass(3);
        if (!comes("scan2d", scans_, 1))
            return;
        times();
        points();
    }

    Result<void> run() {
        const bool turns = !arguments_.base.isEmpty() && scans_.all.size() > 2 && !isEnded();
        const auto turned = turns ? turnOnTheSpot() : Result<void>();
        return turned ? result() : turned;
    }

private:
    /// What has to be true of every scan; of all but the first: what had better be.
    template <typename Test>
    void each(const QString &what, const QString &expected, const Test &test, int but = 0) {
        const auto &all = scans_.all;
        const auto holds = std::count_if(all.begin(), all.end(), [&](auto &one) { return test(one.data); });
        const QString found = QString("%1 of %2 scans").arg(holds).arg(all.size());
        but == 0 ? must(what, holds == int(all.size()), expected, found)
                 : should(what, holds + but >= int(all.size()), expected, found);
    }
    template <typename Test>
    void most(const QString &what, const QString &expected, const Test &test) {
        each(what, expected, test, 1);
    }

    void times() {
        const double revolution_s = 1 / scans_.rate_hz();
        stamps(scans_, revolution_s + 0.3);
        quint64 dropped = 0, backward = 0;
        for (std::size_t i = 1; i < scans_.all.size(); ++i) {
            const quint64 before = scans_.all[i - 1].data.header.turn, turn = scans_.all[i].data.header.turn;
            dropped += turn > before ? turn - before - 1 : 0;
            backward += quint64(turn <= before);
        }
        must("turn", backward == 0, "each more than the one before");
        should("dropped revolutions", dropped == 0, "none, by turn", QString::number(dropped));
        each("t", QString("0 to %1 s, a revolution").arg(revolution_s, 0, 'f', 3), [revolution_s](Scan scan) {
            const auto t = scan.t.value_or(std::vector<float>{0});
            return t.empty() || (*std::min_element(t.begin(), t.end()) >= 0 &&
                                 *std::max_element(t.begin(), t.end()) < 1.5 * revolution_s);
        });
        most("t is there", "in each scan", [](Scan scan) { return scan.t.has_value(); });
        most("whole scans", "none partial but the first", [](Scan scan) { return !scan.header.partial; });
    }

    void points() {
        each("equal lengths", "of x, y, t and intensity", [](Scan scan) {
            const std::size_t n = scan.x.size(), intensities = scan.intensity.size();
            return scan.y.size() == n && (!scan.t || scan.t->size() == n) &&
                   (intensities == 0 || intensities == n);
        });
        most("points", "10 at least", [](Scan scan) { return pointsOf(scan) >= 10; });
        most("rays", "of a full turn, returned or not: as many as the steps between points tell",
             [](Scan scan) {
                 const double rays = double(scan.header.rays.value_or(0)), turn = rays * usualStep(scan);
                 return rays >= 0.98 * double(pointsOf(scan)) && turn > vectorlib::pi &&
                        turn < 6 * vectorlib::pi;
             });
        each("metres", "half of the points within 200, as no millimetres are", [](Scan scan) {
            std::size_t far = 0;
            for (std::size_t i = 0; i < pointsOf(scan); ++i)
                far += std::size_t(std::hypot(scan.x[i], scan.y[i]) > 200);
            return 2 * far <= pointsOf(scan);
        });
        double widest = 0;
        const auto viewOf = [](Scan scan) {
            double view = 0;
            for (std::size_t i = 1; i < pointsOf(scan); ++i)
                view += vectorlib::wrapAngle(angleOf(scan, i) - angleOf(scan, i - 1));
            return view * inDegrees;
        };
        each("counter-clockwise", "the order of the points", [&](Scan scan) {
            widest = std::max(widest, viewOf(scan));
            return pointsOf(scan) < 2 || viewOf(scan) > 0;
        });
        should("field of view", widest >= 90, "90 degrees at least",
               QString("%1 degrees").arg(widest, 0, 'f', 0));
        most("scans with it", "all, or partial: true",
             [&](Scan scan) { return scan.header.partial || viewOf(scan) > 0.7 * widest; });
    }

    /// Error: the base does not turn.
    Result<void> turnOnTheSpot() {
        Client base;
        if (const auto connected = connectTo(base, arguments_.base); !connected)
            return connected;
        const OdometryRecord odometry(base, "odometry");
        if (const auto acquired = call(base, "control.acquire", {{"client", "conform"}, {"timeout_s", 2}});
            !acquired)
            return acquired.error();
        pass(0.5);
        if (odometry.all.empty())
            return Error(ErrorCode::TimedOut, arguments_.base + " publishes no odometry");
        const ScanMessage before = scans_.all.back().data;
        const Pose2D from = odometry.all.back().data.pose;
        const auto driven = driveFor(base, {0, 0, 0.3}, 2);
        (void)call(base, "motor.stop");
        if (!driven && driven.error().is(ErrorCode::OverLimit)) { // as a car's
            (void)call(base, "control.release");
            should("sense of rotation", false, "a base that turns on the spot at 0.3 rad/s, to try it with",
                   driven.error().message);
            return {};
        }
        if (!driven)
            return driven;
        (void)standsAfter(odometry, monotonicNow(), 2);
        (void)call(base, "control.release");
        pass(2.5 / scans_.rate_hz() + 0.3); // for a scan of the robot that stands
        const double turned = (from.inverse() * odometry.all.back().data.pose).theta;
        const ScanMessage &after = scans_.all.back().data;
        const double with = misfit(before, after, turned), against = misfit(before, after, -turned);
        must("sense of rotation", turned > 0.2 && with < 0.7 * against,
             "scans that turn with the odometry; else they are mirrored, or all looks alike here",
             QString("after %1 degrees %2 m apart with the odometry, %3 m against it")
                 .arg(turned * inDegrees, 0, 'f', 0)
                 .arg(with, 0, 'f', 2)
                 .arg(against, 0, 'f', 2));
        return {};
    }

    TopicRecord<ScanMessage> scans_;
};

} // namespace

Result<void> conformScanner(Client &client, const Arguments &arguments) {
    const auto confirmed = arguments.base.isEmpty() ? Result<void>() : confirmFreeWheels(arguments);
    return confirmed ? ScannerTest(client, arguments).run() : confirmed;
}

} // namespace hermes::ctl
