// Who may drive, and what becomes of the robot when he is silent, goes, or is overtaken.
#include "MachineStalls.h"
#include "MotorFixture.h"

#include <QUrl>

using namespace hermes;
using namespace hermes::motorcontrol;
using namespace hermes::simulator;

class TestMotorClients : public QObject, MotorFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { setUp(); }
    void cleanup() { tearDown(); }

    void leaseIsExclusiveAndRunsOut() {
        launchReady();
        ConnectedClient other(address());
        QCOMPARE(call("control.acquire", {{"client", "anna"}, {"timeout_s", 1}})["holder"].toString(),
                 QString("anna"));
        const auto refused = other.callAndWait("motor.drive", QJsonObject{{"vx", 0.1}});
        QVERIFY(!refused.ok() && refused.error().is(ErrorCode::ControlHeld));
        QCOMPARE(refused.error().data["holder"].toString(), QString("anna"));
        QTRY_VERIFY(other.callAndWait("control.acquire", QJsonObject{{"client", "bert"}}).ok());
        QCOMPARE(failure("motor.drive", {{"vx", 0.1}}).data["holder"].toString(), QString("bert"));
        QCOMPARE(call("control.state")["holder"].toString(), QString("bert"));
    }

    // Sent in one go: the stop is done first, and what was sent before it must not undo it.
    void whatAStopOvertakesIsVoid() {
        launchReady();
        QTcpSocket socket;
        const QStringList place = address().split(':');
        socket.connectToHost("127.0.0.1", quint16(place.last().section(',', 0, 0).toUInt()));
        QVERIFY(socket.waitForConnected(1000));
        socket.write(R"({"jsonrpc":"2.0","id":1,"method":"motor.reset_estop"})"
                     "\n"
                     R"({"jsonrpc":"2.0","id":2,"method":"control.acquire"})"
                     "\n"
                     R"({"jsonrpc":"2.0","id":3,"method":"motor.drive","params":{"vx":0.3}})"
                     "\n"
                     R"({"jsonrpc":"2.0","id":4,"method":"motor.estop"})"
                     "\n"
                     R"({"jsonrpc":"2.0","id":5,"method":"motor.reset_estop"})"
                     "\n");
        QMap<int, QJsonObject> replies;
        QTRY_VERIFY((replies.size() == 5) || [&] {
            while (socket.canReadLine()) {
                const QJsonObject reply = QJsonDocument::fromJson(socket.readLine()).object();
                replies.insert(reply["id"].toInt(), reply);
            }
            return replies.size() == 5;
        }());
        for (int before : {1, 2, 3})
            QVERIFY2(replies[before].contains("error"), saying(before));
        QVERIFY(replies[4].contains("result"));
        QVERIFY(replies[5].value("error")["data"]["retry_after_s"].toDouble() >
                1); // it counts, but comes too early
        QVERIFY(state()["estop"].toBool());
        QCOMPARE(rig_->fastest(), 0.0);
    }

    void takingOverStopsTheRobot() {
        launchReady();
        ConnectedClient other(address());
        call("control.acquire", {{"client", "anna"}, {"timeout_s", 10}});
        driveOff({{"vx", 0.5}});
        const QJsonObject ask{{"client", "bert"}, {"timeout_s", 10}};
        QVERIFY(other.callAndWait("control.acquire", ask).error().is(ErrorCode::ControlHeld));
        QJsonObject takeOver = ask;
        takeOver["take_over"] = true;
        // An operator may ask for it, not take it.
        QVERIFY(other.callAndWait("control.acquire", takeOver).error().is(ErrorCode::NotAuthorised));
        QVERIFY(other.callAndWait("control.ask", QJsonObject{{"client", "bert"}}).ok());
        QCOMPARE(call("control.state")["wanted"].toString(), QString("bert"));
        QCOMPARE(call("control.state")["holder"].toString(), QString("anna"));
        QVERIFY(other.connectTo(asOwner(address())).ok());
        QVERIFY(other.waitConnected().ok());
        const auto taken = other.callAndWait("control.acquire", takeOver);
        QVERIFY(taken.ok());
        QVERIFY(call("control.state")["wanted"].isNull());
        QCOMPARE(taken->toObject()["holder"].toString(), QString("bert"));
        const Error told = failure("motor.drive", {{"vx", 0.5}});
        QCOMPARE(told.code, int(ErrorCode::ControlHeld));
        QCOMPARE(told.data["holder"].toString(), QString("bert"));
        QTRY_VERIFY(rig_->fastest() < 10);
        QCOMPARE(state()["halted"].toString(), QString("bert took the control over from anna"));
        QVERIFY(other.callAndWait("motor.drive", QJsonObject{{"vx", 0.5}}).ok());
    }

    void silentClientIsStopped() {
        launchReady({"safety.command_timeout_s=0.25"});
        call("control.acquire", {{"timeout_s", 10}});
        driveOff({{"vx", 0.5}});
        QTRY_VERIFY(rig_->zeroSince() < RoboClawRig::now());
        QCOMPARE(state()["halted"].toString(), QString("no command for 0.25 s"));
        drive({{"vx", 0.5}}, 0.2); // the control was kept
    }

    // As often as it does.
    void eachHaltIsToldByATopic() {
        launchReady();
        QStringList told;
        client_->subscribe("control", {{"queue", 20}}, [&](const TopicUpdate &update) {
            const QJsonObject data = update.json().toObject();
            told.append(data["control"].toObject()["holder"].toString() + ": " + data["cause"].toString() +
                        ", " + data["halted"].toString());
        });
        call("control.acquire", {{"client", "anna"}, {"timeout_s", 10}});
        const QString follows = "anna: , ", late = "anna: time-out, no command for 1 s";
        for (int times = 1; times <= 2; ++times) {
            call("motor.drive", {{"vx", 0.5}});
            QTRY_COMPARE(told.count(late), times);
            QCOMPARE(told.count(follows), times);
        }
        call("motor.estop", {{"client", "bert"}});
        QTRY_VERIFY2(told.last().startsWith(": estop, emergency stop by bert"), qPrintable(told.last()));
    }

    // Longer than the mail to it holds: the cycle goes on, and tells how much was not read.
    void aBusyMainThreadDelaysNoStop() {
        plugServer();
        launchReady({"safety.command_timeout_s=0.25"});
        call("control.acquire", {{"timeout_s", 10}});
        driveOff({{"vx", 0.5}});
        client_->notify("control.acquire", QJsonObject{{"timeout_s", 10}});
        client_->notify("motor.drive", QJsonObject{{"vx", 0.5}}); // read when the daemon goes on
        MachineStalls stalls;
        const double commanded = RoboClawRig::now();
        while (RoboClawRig::now() < commanded + 2) {
        } // the daemon's main thread is this one
        const double stopped = rig_->zeroSince() - commanded, most = 0.5 + stalls.takeLongest();
        QVERIFY2(stopped < most, saying("%1 of %2", stopped, most));
        QCOMPARE(failure("motor.drive", {{"vx", 0.5}}).code, int(ErrorCode::NotReady));
        QTRY_VERIFY(state()["cycle"].toObject()["unread"].toInt() > 10);
        QVERIFY(state()["ready"].toBool());
        QVERIFY(!state()["control"].toObject()["held"].toBool());
        QTRY_VERIFY(!call("control.acquire", {{"timeout_s", 10}}).contains("failed"));
        QVERIFY(rig_->zeroSince() - commanded < most); // nothing else since
        drive({{"vx", 0.5}}, 0.2);
    }

    // More than the mail to the loop holds.
    void manyCommandsAtOnceAreAllAnswered() {
        launchReady();
        constexpr int count = 300;
        QStringList names;
        for (int i = 0; i < count; ++i)
            client_->call("control.acquire", QJsonObject{{"client", QString::number(i)}},
                          [&](const Result<QJsonValue> &result) {
                              names.append(result ? result->toObject()["holder"].toString()
                                                  : result.error().message);
                          });
        QTRY_COMPARE(names.size(), count);
        for (int i = 0; i < count; ++i)
            QVERIFY2(names[i] == QString::number(i), saying("%1: %2", i, names[i]));
    }

    void clientThatGoesIsStopped() {
        launchReady();
        call("control.acquire", {{"timeout_s", 10}});
        driveOff({{"vx", 0.5}});
        const QString where = address();
        client_ = std::make_unique<PatientClient>();
        QTRY_VERIFY(rig_->zeroSince() < RoboClawRig::now());
        QVERIFY(client_->connectTo(where).ok());
        QVERIFY(client_->waitConnected().ok());
        QCOMPARE(state()["halted"].toString(), QString("the client that held the control has gone"));
        call("control.acquire");
    }
};
