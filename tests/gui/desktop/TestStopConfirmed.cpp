#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/FakeRobot.h"

using namespace hermes;

/// Forwards to a port; what has been forwarded so far can be made to carry nothing any more, as behind a
/// router that has forgotten it.
class Router : public QTcpServer {
public:
    explicit Router(quint16 port)
        : port_(port) {
        connect(this, &QTcpServer::newConnection, this, [this] {
            QTcpSocket *const near = nextPendingConnection();
            auto *const far = new QTcpSocket(near);
            far->connectToHost(QHostAddress::LocalHost, port_);
            const int generation = generation_;
            const auto forward = [this, generation](QTcpSocket *from, QTcpSocket *to) {
                connect(from, &QTcpSocket::readyRead, to, [this, generation, from, to] {
                    const QByteArray bytes = from->readAll();
                    if (generation == generation_)
                        to->write(bytes);
                });
            };
            forward(near, far);
            forward(far, near);
            connect(near, &QTcpSocket::disconnected, near, &QObject::deleteLater);
        });
        listen(QHostAddress::LocalHost);
    }
    void forgetConnections() { ++generation_; }

private:
    const quint16 port_;
    int generation_ = 0;
};

/// The operator sees how far a STOP has come, and it goes on until the robot has measured that it stands.
class TestStopConfirmed : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        robot_ = std::make_unique<FakeRobot>();
        client_ = std::make_unique<ConnectedClient>(robot_->address());
    }

    void cleanup() {
        open_.reset();
        client_.reset();
        robot_.reset();
    }

    void isConfirmedByAMeasurement() {
        openWindow(robot_->port());
        QCOMPARE(button(), QString("STOP"));
        QCOMPARE(banner(), QString());
        driveOff();
        std::vector<StopPhase> seen;
        connect(&open_->drive.stopping(), &StopControl::changed, this, [&] {
            if (seen.empty() || seen.back() != phase())
                seen.push_back(phase());
        });
        press();
        QVERIFY(button() == "STOP pressed" || button() == "STOP sent");
        QVERIFY(banner().startsWith("STOP "));
        QTRY_VERIFY_WITH_TIMEOUT(phase() == StopPhase::Confirmed, 1500);
        open_->drive.stopping().disconnect(this);
        QVERIFY(state()["standing"].toObject()["confirmed"].toBool());
        const QString who = state()["latched"].toObject()["estop"].toString();
        QVERIFY2(who.startsWith("emergency stop by hermes-gui ") && who.contains(" on "), qPrintable(who));
        QTRY_COMPARE(button(), QString("STOPPED"));
        VERIFY_CONTAINS(banner(), "measured that the robot stands");
        const std::vector<StopPhase> all{StopPhase::Pressed, StopPhase::Sent, StopPhase::Taken,
                                         StopPhase::Confirmed};
        QVERIFY(seen == all);
        QTest::keyRelease(&open_->window, Qt::Key_W);
        OpenWindow::click(&open_->window, "release");
        QTRY_COMPARE(button(), QString("STOP"));
        QTRY_COMPARE(banner(), QString());
    }

    void isSaidAloudWhileFrozen() {
        openWindow(robot_->port());
        driveOff();
        robot_->freeze();
        press();
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.stopping().isLate(), 1000);
        for (const char *part : {"NOT CONFIRMED by motorcontrol", "does not answer",
                                 "stops by itself after 1 s", "its motor controllers", "switch on the robot"})
            TRY_CONTAINS(banner(), part);
        QTest::qWait(4000); // it goes on for longer than a call waits
        QVERIFY2(open_->drive.stopping().isLate(), qPrintable(banner()));
        robot_->thaw();
        QTRY_VERIFY(phase() == StopPhase::Confirmed);
        QVERIFY(state()["estop"].toBool());
        robot_->freeze(); // not known to stand any more
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.stopping().isLate(), 3000);
        robot_->thaw();
        QTRY_VERIFY(phase() == StopPhase::Confirmed);
        QTest::keyRelease(&open_->window, Qt::Key_W);
    }

    void closingTheWindowAsksMeanwhile() {
        openWindow(robot_->port());
        robot_->freeze();
        press();
        open_->window.close();
        QVERIFY(open_->window.isVisible());
        const auto *const notice = open_->window.findChild<QLabel *>("noticeBanner");
        VERIFY_STARTS(notice->text(), "STOP is not confirmed");
        robot_->thaw();
        QTRY_COMPARE_WITH_TIMEOUT(phase(), StopPhase::Confirmed, 10000);
        open_->window.close();
        QVERIFY(!open_->window.isVisible());

        openWindow(robot_->port());
        robot_->freeze();
        press();
        open_->window.close();
        QVERIFY(open_->window.isVisible());
        open_->window.close(); // said twice
        QVERIFY(!open_->window.isVisible());
        robot_->thaw();
    }

    void goesOutWhenTheRobotIsBack() {
        openWindow(robot_->port());
        robot_->end();
        QTRY_VERIFY(!open_->drive.isPossible());
        press();
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.stopping().isLate(), 1000);
        TRY_CONTAINS(banner(), "no connection");
        QCOMPARE(button(), QString("STOP pressed"));
        robot_->start();
        QTRY_VERIFY_WITH_TIMEOUT(phase() == StopPhase::Confirmed, 20000);
        QTRY_VERIFY(state()["estop"].toBool());
    }

    void goesOverANewConnection() {
        Router router(robot_->port());
        openWindow(router.serverPort());
        driveOff();
        router.forgetConnections();
        press();
        QTRY_VERIFY_WITH_TIMEOUT(state()["estop"].toBool(), 2500);
        QTRY_VERIFY_WITH_TIMEOUT(phase() == StopPhase::Confirmed, 2500);
        QTest::keyRelease(&open_->window, Qt::Key_W);
    }

    void goesOutWhenARobotIsFound() {
        openWindow(0);
        press();
        VERIFY_CONTAINS(banner(), "REACHES NOBODY");
        QVERIFY(open_->fleet.add(robot_->address()).ok());
        QTRY_VERIFY_WITH_TIMEOUT(phase() == StopPhase::Confirmed, 10000);
        QVERIFY(state()["estop"].toBool());
    }

    void isOverWhenSomebodyReleases() {
        openWindow(robot_->port());
        press();
        QTRY_VERIFY(phase() == StopPhase::Confirmed);
        QVERIFY(!client_->callAndWait("motor.reset_estop", QJsonObject{{"confirm", true}}).ok()); // too early
        QVERIFY(releaseStop(*client_));
        QTRY_VERIFY(phase() == StopPhase::None);
        QTRY_COMPARE(button(), QString("STOP"));
        QVERIFY(client_->callAndWait("motor.estop").ok()); // by somebody else
        QTRY_COMPARE(button(), QString("STOPPED"));
        TRY_STARTS(banner(), "STOPPED");
    }

    void theStopOfAnotherIsWatched() {
        openWindow(robot_->port());
        driveOff();
        robot_->setSilent(true); // the controllers answer no more
        QVERIFY(client_->callAndWait("motor.estop").ok());
        QTest::keyRelease(&open_->window, Qt::Key_W);
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.stopping().isLate(), 4000);
        TRY_CONTAINS(banner(), "NOT KNOWN TO STAND");
        robot_->setSilent(false);
        QTRY_VERIFY_WITH_TIMEOUT(phase() == StopPhase::Confirmed, 10000);
        TRY_STARTS(banner(), "STOPPED: emergency stop by");
        OpenWindow::click(&open_->window, "release");
        TRY_STARTS(banner(), "Not stopped from here");
        QTest::qWait(600); // as a person, who reads it
        QVERIFY(state()["estop"].toBool());
        OpenWindow::click(&open_->window, "release");
        QTRY_COMPARE(button(), QString("STOP"));
        QVERIFY(!state()["estop"].toBool());
    }

    void pressedAgainItStaysLate() {
        openWindow(robot_->port());
        robot_->freeze();
        press();
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.stopping().isLate(), 1000);
        for (int i = 0; i < 10; ++i) {
            QTest::mouseRelease(open_->window.findChild<QPushButton *>("stop"), Qt::LeftButton);
            press();
            QTest::qWait(50);
            QVERIFY(open_->drive.stopping().isLate());
        }
        robot_->thaw();
        QTRY_VERIFY(phase() == StopPhase::Confirmed);
    }

    void aReleaseIsOfTheChosenRobot() {
        openWindow(robot_->port());
        const FakeRobot other;
        RobotProcesses own, processes;
        own.add("motorcontrol", robot_->port());
        QVERIFY(open_->fleet.add(QString("127.0.0.1:%1").arg(own.supervise("first"))).ok());
        processes.add("motorcontrol", other.port());
        const QString supervisor = QString("127.0.0.1:%1").arg(processes.supervise("other"));
        QVERIFY(open_->fleet.add(supervisor).ok());
        QTRY_VERIFY_WITH_TIMEOUT(open_->fleet.robotAt(supervisor), 10000);
        Robot *const second = open_->fleet.robotAt(supervisor);
        QTRY_COMPARE_WITH_TIMEOUT(int(second->allWithMethod("motor.estop").size()), 1, 10000);
        robot_->end();
        QTRY_VERIFY(!open_->drive.isPossible());
        press();
        QTRY_VERIFY(open_->drive.stopping().isLate());
        open_->fleet.choose(second);
        QTRY_VERIFY(open_->drive.isPossible());
        QCOMPARE(phase(), StopPhase::None); // of this one
        QVERIFY(open_->drive.stopping().isLate());
        press();
        QTRY_VERIFY(phase() == StopPhase::Confirmed);
        OpenWindow::click(&open_->window, "release");
        QTRY_VERIFY(phase() == StopPhase::None);
        TRY_CONTAINS(banner(), "NOT CONFIRMED"); // the first one still is not
        robot_->start();
        QVERIFY(client_->waitConnected(std::chrono::milliseconds(10000)).ok());
        QTRY_VERIFY_WITH_TIMEOUT(state()["estop"].toBool(), 10000);
    }

    void aReleaseIsToldWhenItIsNotTaken() {
        openWindow(robot_->port());
        press();
        QTRY_VERIFY(phase() == StopPhase::Confirmed);
        robot_->freeze();
        OpenWindow::click(&open_->window, "release");
        QTest::qWait(700);
        QVERIFY(phase() != StopPhase::None); // it has not answered
        QVERIFY(!banner().isEmpty());
        robot_->thaw();
        QTRY_VERIFY(state().contains("estop"));
        QTest::qWait(1500);
        QCOMPARE(state()["estop"].toBool(), phase() != StopPhase::None); // the window tells what is
        if (state()["estop"].toBool() && !QTest::qWaitFor([&] { return !state()["estop"].toBool(); }, 2500))
            OpenWindow::click(&open_->window, "release");
        QTRY_VERIFY(!state()["estop"].toBool());
        QTRY_COMPARE(button(), QString("STOP"));
    }

private:
    void openWindow(quint16 port) {
        open_ = std::make_unique<OpenWindow>();
        if (port)
            QVERIFY(open_->fleet.add(QString("127.0.0.1:%1").arg(port)).ok());
        QVERIFY(open_->show());
        if (port)
            QTRY_VERIFY_WITH_TIMEOUT(open_->drive.stateAge().isFresh(), 10000);
    }

    QString banner() const {
        const auto *const label = open_->window.findChild<QLabel *>("stopBanner");
        return label->isVisible() ? label->text() : QString();
    }
    QString button() const { return open_->window.findChild<QPushButton *>("stop")->text(); }
    StopPhase phase() const { return open_->drive.stopping().phase(); }
    QJsonObject state() {
        const auto result = client_->callAndWait("motor.state");
        return result ? result->toObject() : QJsonObject();
    }
    void driveOff() {
        QTest::keyPress(&open_->window, Qt::Key_W);
        QTRY_VERIFY(state()["twist"].toObject()["vx"].toDouble() > 0.2);
    }
    void press() { QTest::mousePress(open_->window.findChild<QPushButton *>("stop"), Qt::LeftButton); }

    std::unique_ptr<FakeRobot> robot_;
    std::unique_ptr<OpenWindow> open_;
    std::unique_ptr<Client> client_; // an independent eye
};
