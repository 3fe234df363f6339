// Triggers by way and angle on the odometry of a real motor control that drives an emulated robot.
#include "MotorFixture.h"
#include "TriggerFixture.h"

using namespace hermes;

class TestTriggerDistance : public QObject, private MotorFixture {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void cleanup();
    void everyHalfMetre();
    void angle();

private:
    class Trigger : public TriggerFixture {
    public:
        using TriggerFixture::define;
        using TriggerFixture::fired_;
        using TriggerFixture::listed;
        using TriggerFixture::startTrigger;
        using TriggerFixture::tearDown;
    };
    struct Sample {
        double x, theta, stamp;
    };

    std::unique_ptr<Trigger> trigger_;
    std::vector<Sample> odometry_; // all messages
};

void TestTriggerDistance::init() {
    setUp();
    launch();
    QTRY_COMPARE(healthItem("controller_1")["level"].toString(), QString("ok"));
    trigger_ = std::make_unique<Trigger>();
    trigger_->startTrigger();
    odometry_.clear();
    client_->subscribe("odometry", {{"queue", 1000}}, [this](const TopicUpdate &update) {
        odometry_.push_back(
            {update.data["pose"]["x"].toDouble(), update.data["pose"]["theta"].toDouble(), update.stamp});
    });
    QTRY_VERIFY(!odometry_.empty());
}

void TestTriggerDistance::cleanup() {
    trigger_->tearDown();
    trigger_.reset();
    MotorFixture::tearDown();
}

// Each firing is for the first message at or beyond its multiple: within one cycle of the odometry.
void TestTriggerDistance::everyHalfMetre() {
    const QString daemon = address().section("//", 1).section('?', 0, 0);
    trigger_->define("half", {{"kind", "distance"}, {"distance_m", 0.5}, {"daemon", daemon}});
    QTRY_VERIFY(trigger_->listed("half")["watched"]["messages"].toInt() > 0);
    call("control.acquire", {{"timeout_s", 10}});
    const double start = odometry_.back().x;
    drive({{"vx", 0.8}}, 3.2);
    const auto &fired = trigger_->fired_["half"];
    QTRY_VERIFY(fired.size() >= 4);
    for (int i = 0; i < fired.size(); ++i) {
        QCOMPARE(fired.at(i)["cause"]["n"].toInt(), i + 1);
        QCOMPARE(fired.at(i)["missed"].toInt(), 0);
        const double at = fired.at(i)["cause"]["pose"]["x"].toDouble() - start;
        const double target = 0.5 * (i + 1);
        // One cycle at this speed is 16 mm; a late cycle of a busy machine is longer.
        const auto first = std::find_if(odometry_.begin(), odometry_.end(),
                                        [&](const Sample &s) { return s.x - start >= target - 1e-6; });
        QVERIFY(first != odometry_.end());
        qInfo("%.1f m: fired at %.4f m, the first message beyond it says %.4f m, jitter %.2f ms", target, at,
              first->x - start, 1000 * fired.at(i)["jitter_s"].toDouble());
        const auto next = first + 1 == odometry_.end() ? first : first + 1;
        QVERIFY(at >= target - 1e-3 && at <= next->x - start + 1e-6);
    }
}

void TestTriggerDistance::angle() {
    const QString daemon = address().section("//", 1).section('?', 0, 0);
    trigger_->define("turn", {{"kind", "angle"}, {"angle_rad", 0.5}, {"daemon", daemon}});
    QTRY_VERIFY(trigger_->listed("turn")["watched"]["messages"].toInt() > 0);
    call("control.acquire", {{"timeout_s", 10}});
    const double start = odometry_.back().theta;
    drive({{"omega", -1}}, 1.5);
    const auto &fired = trigger_->fired_["turn"];
    QTRY_VERIFY(fired.size() >= 1);
    const double turned = std::abs(fired.at(0)["cause"]["pose"]["theta"].toDouble() - start);
    QVERIFY2(turned >= 0.499 && turned < 0.6, qPrintable(QString::number(turned)));
}

QTEST_GUILESS_MAIN(TestTriggerDistance)
#include "TestTriggerDistance.moc"
