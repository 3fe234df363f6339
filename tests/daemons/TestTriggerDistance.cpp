// Triggers by way and angle on the odometry of a real motor control that drives an emulated robot.
#include "MotorFixture.h"
#include "TriggerFixture.h"

using namespace hermes;
using namespace hermes::motorcontrol;
using namespace hermes::simulator;
using namespace hermes::softwaretrigger;

class TestTriggerDistance : public QObject, private MotorFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        setUp();
        launch();
        QTRY_COMPARE(healthItem("controller_1")["level"].toString(), QString("ok"));
        trigger_ = std::make_unique<Trigger>();
        trigger_->startTrigger();
        odometry_.clear();
        client_->subscribe("odometry", {{"queue", 1000}},
                           [this](const TopicUpdate &update) { odometry_.push_back(update.json()["pose"]); });
        QTRY_VERIFY(!odometry_.empty());
    }

    void cleanup() {
        trigger_->tearDown();
        trigger_.reset();
        MotorFixture::tearDown();
    }

    void everyHalfMetre() {
        fireWhileDriving({{"kind", "distance"}, {"distance_m", 0.5}}, {{"vx", 0.8}}, 4);
        compare("x", 0.5);
    }

    void angle() {
        fireWhileDriving({{"kind", "angle"}, {"angle_rad", 0.5}}, {{"omega", -1}}, 2);
        compare("theta", 0.5);
    }

private:
    class Trigger : public TriggerFixture {
    public:
        using TriggerFixture::define;
        using TriggerFixture::fired_;
        using TriggerFixture::listed;
        using TriggerFixture::startTrigger;
        using TriggerFixture::tearDown;
    };

    void fireWhileDriving(const QJsonObject &when, const QJsonObject &twist, int firings) {
        QJsonObject all = when;
        all["daemon"] = address().section("//", 1).section('?', 0, 0);
        trigger_->define("t", all);
        QTRY_VERIFY(trigger_->listed("t")["watched"]["messages"].toInt() > 0);
        call("control.acquire", {{"timeout_s", 10}});
        driveUntil(twist, [&] { return trigger_->fired_["t"].size() >= firings; });
    }

    // Each firing is for the first message at or beyond its multiple: within one cycle of the odometry.
    void compare(const QString &axis, double step) {
        const double start = odometry_.front()[axis].toDouble();
        const auto way = [&](const QJsonValue &pose) { return std::abs(pose[axis].toDouble() - start); };
        const auto fired = trigger_->fired_["t"]; // more may follow
        QTRY_VERIFY(way(odometry_.back()) >= step * fired.size());
        for (int i = 0; i < fired.size(); ++i) {
            QCOMPARE(fired.at(i)["cause"]["n"].toInt(), i + 1);
            QCOMPARE(fired.at(i)["missed"].toInt(), 0);
            const double at = way(fired.at(i)["cause"]["pose"]), target = step * (i + 1);
            const auto first = std::find_if(odometry_.begin(), odometry_.end(), [&](const QJsonValue &pose) {
                return way(pose) >= target - 1e-6;
            });
            QVERIFY(first != odometry_.end());
            qInfo("%.1f: fired at %.4f, the first message beyond it says %.4f, jitter %.2f ms", target, at,
                  way(*first), 1000 * fired.at(i)["jitter_s"].toDouble());
            const auto next = first + 1 == odometry_.end() ? first : first + 1;
            QVERIFY(at >= target - 1e-3 && at <= way(*next) + 1e-6);
        }
    }

    std::unique_ptr<Trigger> trigger_;
    std::vector<QJsonValue> odometry_; // the poses of all messages; the first stands
};
