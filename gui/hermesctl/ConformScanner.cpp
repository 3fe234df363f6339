// hermesctl conform scanner: what hermes-scanmatcher relies on, tried with any daemon that publishes scan2d.
#include "gui/hermesctl/Conformance.h"
#include "protocol/messages/Turns.h"
#include "vectorlib/geometry/Angle.h"

#include <algorithm>
#include <cmath>

namespace hermes::ctl {
namespace {

constexpr double inDegrees = 180 / vectorlib::pi;
using Scan = const ScanMessage &;
using Profile = std::array<double, 360>;

double angleOf(Scan scan, std::size_t point) {
    return std::atan2(double(scan.y[point]), double(scan.x[point]));
}

std::size_t pointsOf(Scan scan) {
    return std::min(scan.x.size(), scan.y.size());
}

/// The range in each degree; 0: no point.
Profile profileOf(Scan scan) {
    Profile ranges{};
    for (std::size_t i = 0; i < pointsOf(scan); ++i)
        ranges[std::size_t(angleOf(scan, i) * inDegrees + 360) % 360] = std::hypot(scan.x[i], scan.y[i]);
    return ranges;
}

/// Metres, a mean: how badly a profile is that of before from a sensor that has turned by so much.
double misfit(const Profile &before, const Profile &after, double turned) {
    double sum = 0, count = 1e-9;
    for (std::size_t i = 0; i < 360; ++i) {
        const double was = before[(i + std::size_t(std::lround(turned * inDegrees + 720))) % 360];
        const bool areBoth = was > 0 && after[i] > 0;
        sum += areBoth ? std::min(std::abs(was - after[i]), 1.0) : 0;
        count += areBoth;
    }
    return sum / count;
}

class ScannerTest : Conformance {
public:
    ScannerTest(Client &client, const Arguments &arguments)
        : Conformance(arguments)
        , scans_(client, "scan2d") {
        pass(3);
        if (!comes("scan2d", client, scans_))
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
    /// What has to be true of every scan.
    template <typename Test>
    void each(const QString &what, const QString &expected, const Test &test) {
        const int count = of(test);
        must(what, count == int(scans_.all.size()), expected, text(count));
    }
    /// What had better be true of all but the first.
    template <typename Test>
    void most(const QString &what, const QString &expected, const Test &test) {
        const int count = of(test);
        should(what, count + 1 >= int(scans_.all.size()), expected, text(count));
    }
    template <typename Test>
    int of(const Test &test) const {
        return int(
            std::count_if(scans_.all.begin(), scans_.all.end(), [&](auto &one) { return test(one.data); }));
    }
    QString text(int count) const { return QString("%1 of %2 scans").arg(count).arg(scans_.all.size()); }

    void times() {
        std::vector<double> first, ages;
        quint64 dropped = 0, backward = 0;
        for (const auto &one : scans_.all) {
            const quint64 turn = one.data.header.turn, before = first.empty() ? turn - 1 : turn_;
            dropped += turn > before ? turn - before - 1 : 0;
            backward += quint64(turn <= before && !first.empty());
            turn_ = turn;
            first.push_back(one.data.header.stamp);
            ages.push_back(one.age + one.stamp - one.data.header.stamp);
        }
        const double rate = scans_.rate_hz();
        should("rate", rate >= 2, "2 Hz at least", QString("%1 Hz").arg(rate, 0, 'f', 1));
        stamps(first, ages, 1 / rate + 0.3);
        must("turn", backward == 0, "each more than the one before");
        should("dropped revolutions", dropped == 0, "none, by turn", QString::number(dropped));
        each("t", QString("0 to %1 s, a revolution").arg(1 / rate, 0, 'f', 3), [rate](Scan scan) {
            const auto t = scan.t.value_or(std::vector<float>{0});
            return t.empty() || (*std::min_element(t.begin(), t.end()) >= 0 &&
                                 *std::max_element(t.begin(), t.end()) < 1.5 / rate);
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
        most("rays", "of a full turn, returned or not",
             [](Scan scan) { return scan.header.rays.value_or(0) >= 0.98 * double(pointsOf(scan)); });
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
            return viewOf(scan) > 0;
        });
        most("field of view", QString("%1 degrees in all, or partial: true").arg(widest, 0, 'f', 0),
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
        const Profile before = profileOf(scans_.all.back().data);
        const Pose2D from = odometry.all.back().data.pose;
        const auto driven = driveFor(base, {0, 0, 0.3}, 2);
        (void)call(base, "motor.stop");
        if (!driven)
            return driven;
        (void)standsAfter(odometry, monotonicNow(), 2);
        (void)call(base, "control.release");
        pass(2.5 / scans_.rate_hz() + 0.3); // for a scan of the robot that stands
        const double turned = (from.inverse() * odometry.all.back().data.pose).theta;
        const Profile after = profileOf(scans_.all.back().data);
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
    quint64 turn_ = 0;
};

} // namespace

Result<void> conformScanner(Client &client, const Arguments &arguments) {
    const auto confirmed = arguments.base.isEmpty() ? Result<void>() : confirmFreeWheels(arguments);
    return confirmed ? ScannerTest(client, arguments).run() : confirmed;
}

} // namespace hermes::ctl
