// Who moves the robot by cmd_vel, and when nobody does.
#include "MotorFixture.h"
#include "daemons/ros2/VelocityCommands.h"
#include "tests/support/Rows.h"

using namespace hermes;
using namespace hermes::ros2;

class TestRosCommands : public QObject, MotorFixture {
    Q_OBJECT

    static constexpr Guid teleop{1}, navigation{2};

    std::unique_ptr<RobotDaemons> robot_;
    std::unique_ptr<VelocityCommands> commands_;

    void launchAll() {
        launchReady();
        robot_ = std::make_unique<RobotDaemons>("");
        robot_->follow({address()});
        QTRY_VERIFY(motorControl(*robot_) != nullptr);
        commands_ = std::make_unique<VelocityCommands>(*robot_, daemon_->server().gaps());
    }
    void send(double vx, const Guid &writer = teleop, double age_s = 0) {
        commands_->take({vx, 0, 0}, writer, stampNow() - age_s, 0,
                        writer == teleop ? "ROS /teleop" : "ROS /navigation");
    }
    /// Sends at 20 Hz until it is so.
    template <typename Condition>
    void sendUntil(Condition isSo, const Guid &writer = teleop) {
        QElapsedTimer waited;
        waited.start();
        while (!isSo()) {
            QVERIFY(waited.elapsed() < 20000);
            send(0.2, writer);
            QTest::qWait(50); // the pace of a node
        }
    }
    bool moves() { return state()["target"].toObject()["vx"].toDouble() > 0.1; }
    QString holder() { return state()["control"].toObject()["holder"].toString(); }
    /// Sends on for half a second: longer than any answer takes.
    void sendOn(const Guid &writer = teleop) {
        QElapsedTimer since;
        since.start();
        sendUntil([&] { return since.elapsed() > 500; }, writer);
    }
    void pause() { QTest::qWait(int(1000 * VelocityCommands::pause_s) + 100); }

private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() {
        commands_.reset();
        robot_.reset();
        tearDown();
    }

    void theFirstCommandTakesTheControl() {
        launchAll();
        sendUntil([this] { return moves(); });
        QCOMPARE(holder(), QString("ROS /teleop"));
        QTRY_VERIFY(holder().isEmpty()); // nobody sends any more
        QVERIFY(!moves());
        sendUntil([this] { return moves(); });
    }

    void aPersonKeepsTheControl() {
        launchAll();
        call("control.acquire", {{"client", "anna"}, {"timeout_s", 60}});
        sendOn();
        QCOMPARE(holder(), QString("anna"));
        QVERIFY(commands_->refusal().contains("anna"));
        call("control.release");
        sendOn(); // what goes on does not move the robot as she lets go
        QVERIFY(!moves() && holder().isEmpty());
        pause();
        sendUntil([this] { return moves(); });
        QVERIFY(commands_->refusal().isEmpty());
    }

    void aPersonTakesTheControl() {
        launchAll();
        sendUntil([this] { return moves(); });
        call("control.acquire", {{"client", "anna"}, {"timeout_s", 60}, {"take_over", true}});
        sendOn();
        QCOMPARE(holder(), QString("anna"));
        QVERIFY(!moves());
    }

    void aStopHoldsWhileCommandsGoOn_data() { rowsOf("method", {"motor.stop", "motor.estop"}); }
    void aStopHoldsWhileCommandsGoOn() {
        QFETCH(QString, method);
        launchAll();
        sendUntil([this] { return moves(); });
        call(method, {{"client", "anna"}});
        sendOn();
        QVERIFY(!moves() && holder().isEmpty());
        if (method == "motor.stop")
            return;
        sendUntil([this] { return !call("motor.reset_estop", {{"confirm", true}}).contains("failed"); });
        sendOn(); // released, and still the same commands
        QVERIFY(!moves());
        pause();
        sendUntil([this] { return moves(); });
    }

    void oneNodeCommandsAtATime() {
        launchAll();
        sendUntil([this] { return moves(); });
        for (int i = 0; i < 10; ++i) {
            send(0.2);
            send(-0.5, navigation);
            QTest::qWait(20);
            QVERIFY(state()["target"].toObject()["vx"].toDouble() >= 0);
        }
        QCOMPARE(commands_->counts().others, quint64(10));
        pause();
        sendUntil([this] { return moves(); }, navigation);
        QCOMPARE(holder(), QString("ROS /navigation"));
    }

    /// By the clock of another host, too: the first ones tell how that goes.
    void whatWasLongOnTheWayIsVoid_data() {
        const Rows<double> row("clock");
        row("the same clock", 0);
        row("a clock behind", 5000);
        row("a clock ahead", -5000);
    }
    void whatWasLongOnTheWayIsVoid() {
        QFETCH(double, clock);
        launchAll();
        send(0, teleop, clock);
        for (int i = 0; i < 5; ++i)
            send(0.5, teleop, clock + 0.5 + i);
        QCOMPARE(commands_->counts().late, quint64(5));
        QCOMPARE(commands_->counts().taken, quint64(1));
        commands_->take({qQNaN(), 0, 0}, teleop, stampNow(), 0, "ROS /teleop");
        for (const double made : {60.0, -60.0}) // ago, by its own stamp
            commands_->take({0.5, 0, 0}, teleop, stampNow(), made, "ROS /teleop");
        QCOMPARE(commands_->counts().taken, quint64(1));
    }
};
