// The odometry on its way to a scan: the buffer, what a pose is expected from it.
#include <vectorlib/mapping/TimedScan.h>
#include <vectorlib/motion/MotionModel.h>
#include <vectorlib/motion/Odometry.h>

using namespace vectorlib;
using Outcome = OdometryBuffer::Outcome;

static constexpr double start = 1.7e9;
static const Twist2D twist{0.8, -0.2, 0.9};

// A robot on an arc, 50 times a second; the variance of its heading grows by 1e-4 rad^2 a second.
static OdometrySample onArc(double seconds) {
    const Eigen::Matrix3d growth = Eigen::Vector3d(4e-4, 4e-4, 1e-4).asDiagonal();
    return {start + seconds, Pose2D{3, -2, 2.9} * twist.motion(seconds), twist, growth * seconds};
}

static void fill(OdometryBuffer &buffer, int from, int to) {
    for (int i = from; i < to; ++i)
        QCOMPARE(buffer.add(onArc(0.02 * i)), Outcome::Taken);
}

static double distance(const Transformation2D &a, const Transformation2D &b) {
    return (a.translation() - b.translation()).norm() + std::abs((a.inverse() * b).alpha());
}

Q_DECLARE_METATYPE(vectorlib::Pose2D)

class TestOdometry : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void givesTheWayDuringAScan() {
        OdometryBuffer buffer;
        fill(buffer, 0, 100);
        const auto track = buffer.over(start + 1.003, start + 1.103);
        QVERIFY(track.has_value());
        for (double t = 1.003; t < 1.103; t += 0.0037) {
            const OdometrySample real = onArc(t);
            QVERIFY(distance(track->at(real.stamp), Transformation2D(real.pose)) < 1e-6);
            QVERIFY((*track->covarianceAt(real.stamp) - *real.covariance).norm() < 1e-9);
        }
    }

    void contradictionsAreSeenInTwoPiecesOfTheWay_data() {
        // What the scans show of each step of 0.05 m and 0.01 rad that the wheels tell of.
        const Rows<Pose2D, bool> row("scans", "isContradicted");
        row("the same", {0.05, 0, 0.01}, false);
        row("a third is slip", {0.033, 0.003, 0.012}, false);
        row("wheels turn on the spot", {0, 0, 0}, true);
        row("backward", {-0.05, 0, 0.01}, true);
        row("sideways", {0, 0.05, 0.01}, true);
        row("they turn", {0.05, 0, 0.05}, true);
    }
    void contradictionsAreSeenInTwoPiecesOfTheWay() {
        FETCH(Pose2D, scans, bool, isContradicted);
        OdometryCheck check;
        Pose2D byWheels{3, -2, 3.1}, byScans{-7, 1, 0.3};
        int steps = 0;
        for (; steps < 40 && !check.add(0.1 * steps, byWheels, byScans); ++steps) {
            byWheels = byWheels * Pose2D{0.05, 0, 0.01};
            byScans = byScans * scans;
        }
        QCOMPARE(check.contradiction().has_value(), isContradicted);
        if (isContradicted)
            QVERIFY2(steps <= 14 && check.contradiction()->odometry.x > 0.59, saying(steps));
    }

    void wheelsThatTurnFasterThanTheyTellAreSeenAtOnce() {
        OdometryCheck check;
        Pose2D byWheels, byScans;
        int steps = 0;
        for (; steps < 40 && !check.add(0.1 * steps, byWheels, byScans); ++steps) {
            byWheels = byWheels * Pose2D{0.02, 0, 0.02};
            byScans = byScans * Pose2D{0.18, 0, 0.18};
        }
        QVERIFY2(steps <= 12, saying(steps)); // 0.24 m by the wheels
    }

    // It stands, and is pushed.
    void standingWheelsContradictNothing() {
        OdometryCheck check;
        for (int i = 0; i < 40; ++i)
            QVERIFY(!check.add(0.1 * i, {0, 0, 0}, {0.05 * i, 0, 0}));
    }

    void clocksThatStepContradictNothing() {
        const double nan = std::nan("");
        for (const double step_s : {-1.0, -1e9, 1e9, nan}) {
            OdometryCheck check;
            for (int i = 0; i < 40; ++i)
                QVERIFY(!check.add((i < 20 ? 0 : step_s) + 0.1 * i, {0.05 * i, 0, 0}, {0.05 * i, 0, 0}));
            QVERIFY(!check.add(1e10, {nan, 0, 0}, {0, 0, 0}));
        }
    }

    void posesThatLeapForAMomentContradictNothing() {
        for (int wrong = 0; wrong < 20; ++wrong) {
            OdometryCheck check;
            for (int i = 0; i < 40; ++i) {
                const double leap = i == wrong ? 5 : i == wrong + 1 ? -5 : 0;
                QVERIFY(!check.add(0.1 * i, {0.05 * i, 0, 0}, {0.05 * i + leap, 0, 0}));
            }
        }
    }

    void oneWrongPoseContradictsNothing() {
        for (int wrong = 0; wrong < 20; ++wrong) {
            OdometryCheck check;
            for (int i = 0; i < 40; ++i)
                QVERIFY(!check.add(0.1 * i, {0.05 * i, 0, 0}, {0.05 * i + (i == wrong ? 5 : 0), 0, 0}));
        }
    }

    void doesNotGuessFar() {
        OdometryBuffer buffer;
        QVERIFY(!buffer.over(start, start));
        fill(buffer, 50, 100); // 1.0 s to 1.98 s
        QVERIFY(!buffer.over(start + 0.99, start + 1.1));
        QVERIFY(!buffer.over(start + 2.0, start + 2.09));
        QVERIFY(!buffer.over(start + 1.5, start + 1.4));
        const auto ahead = buffer.over(start + 1.95, start + 2.05);
        QVERIFY(ahead.has_value());
        QVERIFY(distance(ahead->at(start + 2.05), Transformation2D(onArc(2.05).pose)) < 1e-6);
    }

    void leavesOutWhatIsOutOfOrder() {
        OdometryBuffer buffer;
        fill(buffer, 0, 50);
        for (const int late : {49, 48, 30})
            QCOMPARE(buffer.add(onArc(0.02 * late)), Outcome::OutOfOrder);
        fill(buffer, 50, 60);
        QVERIFY(buffer.over(start, start + 1.1).has_value());
    }

    void beginsAnewWhereNothingFollows_data() {
        const Rows<double, double, double, double> row("seconds", "x", "turn", "certainty");
        row("reset to another place", 0.0, 0.3, 0.0, 1.0);
        row("reset to another heading", 0.0, 0.0, 0.3, 1.0);
        row("reset to the same place", 0.0, 0.0, 0.0, 0.0);
        row("gap", 0.6, 0.0, 0.0, 1.0);
        row("clock set back", -3600.0, 0.0, 0.0, 1.0);
        row("clock set ahead", 3600.0, 0.0, 0.0, 1.0);
    }

    void beginsAnewWhereNothingFollows() {
        FETCH(double, seconds, double, x, double, turn, double, certainty);
        OdometryBuffer buffer;
        fill(buffer, 0, 50);
        const auto before = buffer.over(start + 0.8, start + 0.9);
        const auto changed = [&](int i) {
            OdometrySample s = onArc(0.02 * i);
            s.stamp += seconds;
            s.pose.x += x;
            s.pose.theta += turn;
            *s.covariance *= certainty;
            return s;
        };
        QCOMPARE(buffer.add(changed(50)), Outcome::Restarted);
        QVERIFY(!buffer.over(changed(49).stamp, changed(50).stamp)); // the scan that it falls into
        for (int i = 51; i < 60; ++i)
            QCOMPARE(buffer.add(changed(i)), Outcome::Taken);
        const auto after = buffer.over(changed(51).stamp, changed(55).stamp);
        QVERIFY(before && after);
        QVERIFY(before->epoch() != after->epoch());
    }

    void forgetsItsOldest() {
        OdometryBuffer buffer;
        const int count = 3 * int(OdometryBuffer::capacity) + 7;
        fill(buffer, 0, count);
        const int oldest = count - int(OdometryBuffer::capacity);
        QVERIFY(buffer.over(onArc(0.02 * oldest).stamp, onArc(0.02 * count).stamp).has_value());
        QVERIFY(!buffer.over(onArc(0.02 * (oldest - 1)).stamp, onArc(0.02 * count).stamp).has_value());
    }

    void expectsThePoseOfAMountedSensor() {
        OdometryBuffer buffer;
        fill(buffer, 0, 100);
        const auto track = buffer.over(start, start + 1.9);
        const Pose2D mount{0.3, -0.1, 1.2};
        // The map's frame lies askew in that of the odometry.
        const Transformation2D map(-5, 4, 0.7);
        const auto sensor = [&](double t) {
            return map * Transformation2D(onArc(t).pose) * Transformation2D(mount);
        };
        OdometryModel model;
        model.setMount(mount);
        QVERIFY(!model.expect(*track, start + 1));
        model.update(sensor(0.5).pose(), *track, start + 0.5);
        const auto expected = model.expect(*track, start + 1.31);
        QVERIFY(expected.has_value());
        QVERIFY(distance(Transformation2D(expected->pose), sensor(1.31)) < 1e-6);
    }

    void isAsSureAsTheWaySince() {
        // Certain or not before: what counts is what came in between. A heading that was unsure by p moves a
        // pose that is d ahead by d sqrt(p), and takes the correlation with it.
        const double d = 2, p = 0.04, xx = 1e-4, yy = 9e-4, aa = 2.5e-3;
        Eigen::Matrix3d before = Eigen::Matrix3d::Zero(), after;
        before(2, 2) = p;
        after << xx, 0, 0, 0, yy + d * d * p, d * p, 0, d * p, p + aa;
        const OdometrySample from{start, {1, 1, 0}, {}, before}, to{start + 0.1, {1 + d, 1, 0}, {}, after};
        const OdometryTrack track(0, {from, to});
        OdometryModel model;
        model.update({}, track, from.stamp);
        const auto expected = model.expect(track, to.stamp);
        QVERIFY(expected && expected->deviations);
        QVERIFY(std::abs(expected->deviations->xy -
                         std::hypot(OdometryModel::leastDeviationXY, std::sqrt(yy))) < 1e-6);
        QVERIFY(std::abs(expected->deviations->alpha -
                         std::hypot(OdometryModel::leastDeviationAlpha, std::sqrt(aa))) < 1e-6);
    }

    void saysNothingOfDeviationsWithoutCovariance() {
        OdometrySample from = onArc(0), to = onArc(0.02);
        from.covariance = to.covariance = std::nullopt;
        const OdometryTrack track(0, {from, to});
        OdometryModel model;
        model.update({}, track, from.stamp);
        const auto expected = model.expect(track, to.stamp);
        QVERIFY(expected && !expected->deviations);
        OdometryBuffer buffer;
        QCOMPARE(buffer.add(from), Outcome::Taken);
        QCOMPARE(buffer.add(to), Outcome::Taken);
        QCOMPARE(buffer.add(onArc(0.04)), Outcome::Restarted); // another source, it seems
    }

    void expectsNothingAcrossEpochs() {
        const OdometryTrack before(1, {onArc(0), onArc(0.02)}), after(2, {onArc(0.04), onArc(0.06)});
        OdometryModel model;
        model.update({}, before, start + 0.01);
        QVERIFY(model.expect(before, start + 0.02));
        QVERIFY(!model.expect(after, start + 0.05));
        model.update({}, after, start + 0.05);
        QVERIFY(model.expect(after, start + 0.06));
        model.reset();
        QVERIFY(!model.expect(after, start + 0.06));
    }

    void straightensAScan() {
        OdometryBuffer buffer;
        fill(buffer, 0, 100);
        const Pose2D mount{0.3, -0.1, 1.2};
        OdometryModel model;
        model.setMount(mount);
        const auto sensor = [&](double t) {
            return Transformation2D(onArc(t).pose) * Transformation2D(mount);
        };
        const Vector2D<double> seen(7, 5); // one thing, seen all the time
        TimedScan scan;
        scan.stamp = start + 1.003;
        for (float t = 0; t < 0.1f; t += 0.001f) {
            scan.seconds.push_back(t);
            scan.points.emplace_back(sensor(1.003 + double(t)).inverse() * seen);
        }
        scan.odometry = buffer.over(scan.begin(), scan.end());
        compensateMotion(scan.points, scan.seconds, 0.05f,
                         model.twist(*scan.odometry, scan.begin(), scan.end()));
        QCOMPARE(model.twist(*scan.odometry, scan.begin(), scan.begin()).omega, 0.0);
        const Vector2D<double> expected = sensor(1.053).inverse() * seen;
        for (const auto &point : scan.points)
            QVERIFY((Vector2D<double>(point) - expected).norm() < 1e-5);
    }
};
