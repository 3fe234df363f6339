// The scan matcher with a robot's odometry: what it gains, and that whatever the odometry does, it goes on as
// without.
#include "MatcherFixture.h"

using namespace hermes;
using vectorlib::Pose2D;
using vectorlib::Transformation2D;
using vectorlib::Twist2D;

static constexpr double scanPeriod = 0.1, period = 0.02;
static constexpr int perScan = 5;

// To and fro, 1.6 m and 1.2 rad a scan: nobody who goes by the motion so far expects that.
static Pose2D zigzag(int i) {
    return i % 2 ? Pose2D{0.6 + 0.01 * i, 0.2, 1.2} : Pose2D{-1.0 + 0.01 * i, 0.1, 0};
}

class TestMatcherOdometry : public QObject, MatcherFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void withoutItAZigzagIsLost() { QVERIFY(zigzagLost(false, 12) > 0); }

    void followsAZigzagByBentOdometry() {
        connectOdometry();
        QCOMPARE(zigzagLost(true, 12), 0);
        QCOMPARE(call("matcher.state")["by_odometry"].toInt(), 11); // the first has none before it
        QCOMPARE(counts()["scans_without"].toInt(), 0);
        QCOMPARE(counts()["restarts"].toInt(), 0);
        QCOMPARE(healthItem("odometry")["level"].toString(), QString("ok"));
    }

    void badOdometryIsCountedAndLeftAlone_data() {
        const Rows<QString, QString, QString> row("kind", "count", "level");
        row("reset with every scan", "reset", "restarts", "warn");
        row("refused", "nonsense", "refused", "warn");
        row("out of order", "backwards", "out_of_order", "ok");
        row("of another time", "stale", "scans_without", "warn");
    }

    void badOdometryIsCountedAndLeftAlone() {
        FETCH(QString, kind, QString, count, QString, level);
        connectOdometry();
        call("pose.set", {{"x", -1.5}, {"y", -0.5}, {"theta", 0.0}});
        for (int i = 0; i < 20; ++i) {
            const double stamp = 1 + scanPeriod * i;
            if (kind == "reset") {
                publishOdometry({5.0 * i, 0, 0}, {}, stamp - 0.01, 0);
                publishOdometry({5.0 * i + 2, 0, 0}, {}, stamp + 0.01, 0);
            } else if (kind == "nonsense") {
                source->publish("odometry", QJsonObject{{"pose", "nowhere"}}, stamp);
                ++published;
            } else if (kind == "backwards") {
                advance(i > 0 ? Transformation2D(onTheWay(i - 1)).inverse() * Transformation2D(onTheWay(i))
                              : Transformation2D(),
                        i);
                publishOdometry({100, 100, 1}, {}, stamp - 0.05, 0);
            } else {
                publishOdometry({}, {}, stamp + 1000, 0);
            }
            QTRY_VERIFY(taken());
            source->publish("scan2d", roomScan(onTheWay(i), stamp), stamp);
            QTRY_COMPARE(call("matcher.state")["scans"].toInt(), i + 1);
        }
        QTRY_VERIFY2(counts()[count].toInt() >= 19, saying(counts()[count].toInt()));
        QCOMPARE(call("matcher.state")["matched"].toInt(), 20);
        QCOMPARE(call("matcher.state")["by_odometry"].toInt(), kind == "backwards" ? 19 : 0);
        QCOMPARE(healthItem("odometry")["level"].toString(), level);
        const QString message = healthItem("odometry")["message"].toString(); // tells why
        QVERIFY2(kind != "nonsense" || message.contains("refused 20 messages, the last: "),
                 qPrintable(message));
    }

    void lossOfItIsShownAndMended() {
        connectOdometry();
        const quint16 port = sourcePort;
        QTRY_COMPARE(healthItem("odometry")["level"].toString(), QString("ok"));
        source->shutDown();
        source.reset();
        QTRY_COMPARE(healthItem("odometry")["level"].toString(), QString("warn"));
        QVERIFY(healthItem("odometry")["message"].toString().contains(QString::number(port)));
        startSource(port);
        QTRY_VERIFY(source->hasSubscribers("odometry"));
        QTRY_COMPARE(healthItem("odometry")["level"].toString(), QString("ok"));
    }

    void aSensorThatIsMountedOtherwiseIsTold_data() {
        const Rows<double, bool, QString> row("theta", "isMirrored", "told");
        row("as it is said", 0, false, "nothing contradicts");
        row("turned", 1.5, false, "a sensor.theta_rad of about 0.0");
        row("backward", -3.1, false, "a sensor.theta_rad of about 0.0");
        row("mirrored", 0, true, "the other way than the odometry");
    }
    void aSensorThatIsMountedOtherwiseIsTold() {
        FETCH(double, theta, bool, isMirrored, QString, told);
        const auto step = [&](const Pose2D &from, const Pose2D &to) {
            Pose2D motion = from.inverse() * to;
            motion.theta *= isMirrored ? -1 : 1;
            motion.y *= isMirrored ? -1 : 1;
            return Transformation2D(motion);
        };
        call("settings.set", {{"values", QJsonObject{{"sensor", QJsonObject{{"theta_rad", theta}}}}}});
        connectOdometry();
        for (int i = 0; i < 25; ++i) {
            advance(i > 0 ? step(onTheWay(i - 1), onTheWay(i)) : Transformation2D(), i);
            source->publish("scan2d", roomScan(onTheWay(i), 1 + scanPeriod * i), 1 + scanPeriod * i);
            QTRY_COMPARE(call("matcher.state")["scans"].toInt(), i + 1);
        }
        QTRY_COMPARE(healthItem("sensor")["level"].toString(),
                     QString(theta != 0 || isMirrored ? "warn" : "ok"));
        const QString message = healthItem("sensor")["message"].toString().remove('-');
        VERIFY_CONTAINS(message, told);
    }

    void isShownOnlyWhereThereIsOne() {
        QVERIFY(healthItem("odometry").isEmpty());
        connectOdometry();
        QVERIFY(!healthItem("odometry").isEmpty());
        setAddress("");
        QTRY_VERIFY(!source->hasSubscribers("odometry"));
        QVERIFY(healthItem("odometry").isEmpty());
        QVERIFY(source->hasSubscribers("scan2d")); // untouched
    }

private:
    void setAddress(const QString &address) {
        call("settings.set", {{"values", QJsonObject{{"odometry", QJsonObject{{"address", address}}}}}});
    }

    void connectOdometry() {
        setAddress(QString("127.0.0.1:%1").arg(sourcePort));
        QTRY_VERIFY(source->hasSubscribers("odometry"));
        odometry = Transformation2D(20, -7, 2);
        published = 0;
    }

    void publishOdometry(const Pose2D &pose, const Twist2D &twist, double stamp, double variance) {
        const QJsonObject data{
            {"pose", QJsonObject{{"x", pose.x}, {"y", pose.y}, {"theta", pose.theta}}},
            {"twist", QJsonObject{{"vx", twist.vx}, {"vy", twist.vy}, {"omega", twist.omega}}},
            {"covariance", QJsonArray{variance, 0, 0, 0, variance, 0, 0, 0, variance}}};
        source->publish("odometry", data, stamp);
        ++published;
    }

    // The odometry of a motion that ends with this scan.
    void advance(const Transformation2D &motion, int scan) {
        const Twist2D twist = Twist2D::between(motion.pose(), scanPeriod);
        const Transformation2D from = odometry;
        odometry = from * motion;
        for (int k = scan == 0 ? perScan : 1; k <= perScan; ++k) {
            const double stamp = scanPeriod * (scan - 1) + period * k;
            publishOdometry(from.pose() * twist.motion(period * k), twist, 1 + stamp, 1e-4 * (stamp + 1));
        }
        QTRY_VERIFY(taken());
    }

    int zigzagLost(bool byOdometry, int scans) {
        const Pose2D start = zigzag(0);
        call("pose.set", {{"x", start.x}, {"y", start.y}, {"theta", start.theta}});
        QJsonObject last;
        const int handle = client_->subscribe(
            "pose", {{"queue", 100}}, [&](const TopicUpdate &update) { last = update.json().toObject(); });
        for (int i = 0; i < scans; ++i) {
            Transformation2D motion;
            if (i > 0)
                motion = Transformation2D(zigzag(i - 1)).inverse() * Transformation2D(zigzag(i));
            // The wheels slip by 8 % and drift to the left.
            if (byOdometry)
                advance({1.08 * motion.x(), 1.08 * motion.y(), 1.08 * motion.alpha() + 0.02}, i);
            source->publish("scan2d", roomScan(zigzag(i), 1 + scanPeriod * i), 1 + scanPeriod * i);
            [&] { QTRY_COMPARE(call("matcher.state")["scans"].toInt(), i + 1); }();
        }
        client_->unsubscribe(handle);
        const Pose2D end = zigzag(scans - 1);
        const double error = std::hypot(last["x"].toDouble() - end.x, last["y"].toDouble() - end.y) +
                             std::abs(last["theta"].toDouble() - end.theta);
        const int lost = call("matcher.state")["lost"].toInt();
        if (lost == 0 && error > 0.02)
            qWarning("the last pose is wrong by %f", error);
        return lost == 0 && error > 0.02 ? -1 : lost;
    }

    QJsonObject counts() { return call("matcher.state")["odometry"].toObject(); }
    bool taken() {
        const QJsonObject now = counts();
        return now["messages"].toInt() + now["refused"].toInt() == published;
    }

    Transformation2D odometry; // the robot in its frame
    int published = 0;
};
