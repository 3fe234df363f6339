// Who sees and drives a robot that has keys: hermes-ros2 as a program of its own, nodes in this process.
#include "MotorFixture.h"
#include "common/tls/RosKeystore.h"
#include "daemons/ros2/Participant.h"
#include "protocol/ros/Cdr.h"
#include "protocol/ros/Messages.h"
#include "tests/support/ChildProcess.h"
#include "tests/support/Rows.h"

using namespace hermes;
using namespace hermes::ros2;

class TestRosSecurity : public QObject, MotorFixture {
    Q_OBJECT

    const int domain_ = 1 + int(QCoreApplication::applicationPid() % 200);
    ChildProcess bridge_;

    QString enclave(const QString &name) const { return folder_->filePath("keys/enclaves/" + name); }

private Q_SLOTS:
    void initTestCase() {
        setUp();
        const RosKeystore keys(folder_->filePath("keys"));
        for (const auto &[name, canCommand] :
             {std::pair("robot", true), {"laptop", true}, {"viewer", false}}) {
            const auto made = keys.addEnclave(name, canCommand, 10);
            QVERIFY2(made, made ? "" : qPrintable(made.error().message));
            QCOMPARE(*made, enclave(name));
        }
        QVERIFY(!keys.addEnclave("robot", true, 10)); // there is one
        QVERIFY(!keys.addEnclave("../robot", true, 10));
        QVERIFY(RosKeystore(folder_->filePath("other")).addEnclave("stranger", true, 10));
        launchReady();
        bridge_.setProcessChannelMode(QProcess::ForwardedChannels);
        bridge_.start(qEnvironmentVariable("HERMES_BIN") + "/hermes-ros2",
                      {"--listen", "tcp://127.0.0.1:0", "--set", "daemons=[\"" + address() + "\"]", "--set",
                       QString("domain=%1").arg(domain_), "--set", "commands=true", "--set",
                       "enclave=" + enclave("robot")});
        QVERIFY(bridge_.waitForStarted());
    }
    void cleanupTestCase() {
        bridge_.terminate();
        QVERIFY(bridge_.waitForFinished());
        tearDown();
    }

    void onlyWhoHasKeysSeesAndOnlyWhoMayDrives_data() {
        const Rows<QString, bool, bool> row("enclave", "sees", "drives");
        row("a laptop", enclave("laptop"), true, true);
        row("who may look", enclave("viewer"), true, false);
        row("keys of another store", folder_->filePath("other/enclaves/stranger"), false, false);
        row("no keys", QString(), false, false);
    }
    void onlyWhoHasKeysSeesAndOnlyWhoMayDrives() {
        FETCH(QString, enclave, bool, sees, bool, drives);
        ParticipantOptions options;
        options.domain = domain_;
        options.enclave = enclave;
        auto participant = Participant::open(options);
        QVERIFY2(participant, participant ? "" : qPrintable(participant.error().message));
        int seen = 0;
        auto reader =
            (*participant)->read("rt/odom", "nav_msgs/msg/Odometry", {}, [&](const Reader::Sample &) {
                ++seen;
            });
        QVERIFY(reader);
        auto writer = (*participant)->write("rt/cmd_vel", "geometry_msgs/msg/Twist", {true, false, 1});
        QCOMPARE(writer.ok(), drives || !sees); // who may not publish cannot even make a writer
        const auto moves = [this] { return state()["target"].toObject()["vx"].toDouble() > 0.1; };
        ros::Twist twist;
        twist.linear.x = 0.2;
        QElapsedTimer waited;
        waited.start();
        const int limit_ms = sees ? 20000 : 3000; // the laptop, before, has told how long it takes at most
        const auto isDone = [&] { return sees && seen > 0 && (moves() || !drives); };
        while (waited.elapsed() < limit_ms && !isDone()) {
            if (writer)
                (*writer)->write(ros::toCdr(twist));
            QTest::qWait(50); // the pace of a node
        }
        QCOMPARE(seen > 0, sees);
        QCOMPARE(moves(), drives);
        writer = Error();
        QTRY_VERIFY(!state()["control"].toObject()["held"].toBool());
    }
};
