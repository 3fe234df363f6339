#include "gui/desktop/drive/OwnName.h"
#include "tests/gui/desktop/TwoRobots.h"

using namespace hermes;

/// The control of a robot that is given when another one is chosen already drives nobody.
class TestLateControl : public QObject, TwoRobots {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        begin();
        blue_->setResult("motor.state", // whatever it says, it has not given the control as yet
                         "{\"latched\":{},\"control\":{\"held\":true,\"holder\":\"" + ownName().toUtf8() +
                             "\"}}");
        open();
        QTRY_VERIFY(robot(*red_)->withMethod("motor.drive") && robot(*blue_)->withMethod("motor.drive"));
        choose(*red_);
    }

    void cleanup() { close(); }

    void drivesNobody_data() { falseAndTrue("takesOver", "asked for by driving", "taken over"); }

    void drivesNobody() {
        QFETCH(bool, takesOver);
        askRed(takesOver);
        choose(*blue_);
        letRedAnswer();
        hold(true);
        letCommandsGo();
        QCOMPARE(red_->calls("motor.drive"), 0);
        if (takesOver)
            return; // nothing was held before: blue is driven now
        QVERIFY(!window_->drive.isDriving());
        QCOMPARE(blue_->calls("motor.drive") + blue_->calls("control.acquire"), 0); // let go first
    }

    void isNotThatOfTheOther_data() { drivesNobody_data(); }

    void isNotThatOfTheOther() {
        QFETCH(bool, takesOver);
        askRed(takesOver);
        choose(*blue_);
        blue_->holdBack("control.acquire");
        QVERIFY(holdUntil([&] { return blue_->calls("control.acquire") == 1; }));
        letRedAnswer();
        letCommandsGo();
        QVERIFY(!window_->drive.isDriving());
        QCOMPARE(blue_->calls("motor.drive") + red_->calls("motor.drive"), 0);
        QCOMPARE(blue_->calls("control.acquire"), 1); // the question is still open
        blue_->letGo();
        QTRY_VERIFY(blue_->calls("motor.drive") > 0);
        QCOMPARE(red_->calls("motor.drive"), 0);
        hold(false);
    }

    void refusalIsNotTold() {
        red_->setResult("control.acquire", R"(null,"error":{"code":-32003,"message":"red says no"})");
        askRed(false);
        choose(*blue_);
        QVERIFY(holdUntil([&] { return blue_->calls("motor.drive") > 0; }));
        letRedAnswer();
        const int driven = blue_->calls("motor.drive");
        letCommandsGo();
        QVERIFY(window_->drive.isDriving());
        QVERIFY(blue_->calls("motor.drive") > driven);
        QCOMPARE(window_->drive.problem(), QString());
        hold(false);
    }

    // The timer of the commands comes before the key that was let go meanwhile.
    void whatWasLetGoWhileTheWindowStoodStill() {
        red_->setResult("motor.state", // so does red, which gives it
                        "{\"latched\":{},\"control\":{\"held\":true,\"holder\":\"" + ownName().toUtf8() +
                            "\"}}");
        choose(*red_);
        QTRY_VERIFY(window_->drive.isPossible());
        QVERIFY(holdUntil([&] { return red_->calls("motor.drive") > 5; }));
        for (int i = 0; i < 5; ++i) {
            QThread::msleep(400);
            const int before = red_->calls("motor.drive");
            bool isLetGo = false;
            QTimer::singleShot(1, this, [&] {
                hold(false);
                isLetGo = true;
            });
            QThread::msleep(5);
            QTRY_VERIFY(isLetGo && !window_->drive.isDriving());
            QTest::qWait(100);
            QCOMPARE(red_->calls("motor.drive"), before);
            QVERIFY(holdUntil([&] { return red_->calls("motor.drive") > before + 5; }));
        }
        hold(false);
    }

private:
    void choose(const FakeDaemon &daemon) {
        window_->fleet.choose(robot(daemon));
        QCOMPARE(window_->fleet.robot(), robot(daemon));
        QTRY_VERIFY(window_->drive.stateAge().isFresh()); // it is the one that is driven
    }
    void hold(bool isHeld) { window_->drive.steer("test", isHeld ? Twist2D{1, 0, 0} : Twist2D(), isHeld); }
    /// As an operator: lets go where what is held does not count, as after another robot was chosen or when
    /// the window stood still, and presses again.
    template <typename Done>
    bool holdUntil(const Done &done) {
        return QTest::qWaitFor(
            [&] {
                const bool mustLetGo = window_->drive.mustLetGo();
                hold(!mustLetGo);
                return !mustLetGo && done();
            },
            patience * 20000);
    }
    /// Asks for the control of red, by driving or by hand; the answer is held back.
    void askRed(bool takesOver) {
        red_->holdBack("control.acquire");
        const auto isAsked = [&] { return red_->calls("control.acquire") == 1; };
        if (takesOver)
            window_->drive.takeOver();
        QVERIFY(takesOver ? QTest::qWaitFor(isAsked, patience * 5000) : holdUntil(isAsked));
    }
    /// Sends what red has held back, and waits until it was read.
    void letRedAnswer() {
        red_->letGo();
        bool isRead = false;
        robot(*red_)->daemons().front()->call("fake.call", {}, this, [&](const auto &) { isRead = true; });
        QTRY_VERIFY(isRead);
    }
    /// A turn of the loop in which commands go out, with time to spare.
    void letCommandsGo() {
        const int asked = blue_->calls("motor.state");
        QTRY_VERIFY(blue_->calls("motor.state") > asked + 1); // twice a second
    }
};
