#include "tests/gui/desktop/TwoRobots.h"

using namespace hermes;

/// A button that moves a robot ends at any stop of that robot, whoever pressed it and whichever robot is
/// chosen, and at any STOP of the window.
class TestMacroStops : public QObject, TwoRobots {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        begin();
        open();
        window_->fleet.choose(robot(*red_));
        runner_ = std::make_unique<MacroRunner>(window_->fleet, window_->drive);
    }

    void cleanup() {
        runner_.reset();
        close();
    }

    void stopOfAnyRobotThatItGoesTo_data() {
        const Rows<bool, bool> row("isChosen", "isItsTurn");
        row("the chosen one, at its step", true, true);
        row("the chosen one, at the step of another", true, false);
        row("another one, at its step", false, true);
        row("another one, at the step of the chosen one", false, false);
    }

    void stopOfAnyRobotThatItGoesTo() {
        FETCH(bool, isChosen, bool, isItsTurn);
        FakeDaemon &stoppedOne = isChosen ? *red_ : *blue_, &other = isChosen ? *blue_ : *red_;
        FakeDaemon &first = isItsTurn ? stoppedOne : other, &second = isItsTurn ? other : stoppedOne;
        run({call(first, 30), call(second)});
        QTRY_COMPARE(first.calls("fake.call"), 1);
        stoppedOne.setResult("motor.state", stopped);
        QTRY_VERIFY2(!runner_->isRunning(), qPrintable(runner_->text()));
        QVERIFY2(hasEndedBy(isChosen ? "STOP of red" : "STOP of blue") || (isChosen && hasEndedBy("STOP")),
                 qPrintable(runner_->text()));
        QCOMPARE(second.calls("fake.call"), 0);
    }

    void stopOfARobotThatItDoesNotGoTo() {
        run({call(*red_, 30), call(*red_)});
        QTRY_COMPARE(red_->calls("fake.call"), 1);
        blue_->setResult("motor.state", stopped);
        const int asked = red_->calls("motor.state");
        QTRY_VERIFY(red_->calls("motor.state") > asked + 5);
        QVERIFY(runner_->isRunning());
        runner_->end("by hand");
    }

    void stopOfTheWindow_data() {
        falseAndTrue("goesToTheChosenOne", "of another robot", "of the chosen robot");
    }

    void stopOfTheWindow() {
        QFETCH(bool, goesToTheChosenOne);
        FakeDaemon &driven = goesToTheChosenOne ? *red_ : *blue_;
        run({call(driven, 30), call(driven)});
        QTRY_COMPARE(driven.calls("fake.call"), 1);
        QTest::mouseClick(window_->window.findChild<QPushButton *>("stop"), Qt::LeftButton);
        QVERIFY2(hasEndedBy("STOP"), qPrintable(runner_->text())); // at once
    }

    // It may be there to release the robot.
    void whatHoldsAtTheBeginningIsNoStop() {
        blue_->setResult("motor.state", stopped);
        run({call(*blue_, 0.5), call(*blue_)});
        QTRY_COMPARE(runner_->text(), QString("Tour: done"));
        QCOMPARE(blue_->calls("fake.call"), 2);
    }

    void anotherCauseIsAStop() {
        blue_->setResult("motor.state", R"({"latched":{"controller 1":"hot"},"control":{"held":false}})");
        run({call(*blue_, 30), call(*blue_)});
        QTRY_COMPARE(blue_->calls("fake.call"), 1);
        blue_->setResult("motor.state",
                         R"({"latched":{"controller 1":"hot","estop":"x"},"control":{"held":false}})");
        QTRY_VERIFY2(hasEndedBy("STOP of blue"), qPrintable(runner_->text()));
    }

    // The one that comes in the moment before could release it.
    void noCommandFollowsAStop() {
        blue_->holdBack("fake.call");
        run({call(*blue_), call(*blue_)});
        QTRY_COMPARE(blue_->calls("fake.call"), 1);
        blue_->holdBack("motor.state"); // so that nothing but the look before the step can know it
        const int asked = blue_->calls("motor.state");
        QTRY_VERIFY(blue_->calls("motor.state") > asked);
        blue_->setResult("motor.state", stopped);
        blue_->letGo();
        QTRY_VERIFY2(hasEndedBy("STOP of blue"), qPrintable(runner_->text()));
        QCOMPARE(blue_->calls("fake.call"), 1);
    }

    void noAnswerIsNoGo() {
        blue_->holdBack("motor.state");
        run({call(*blue_)});
        QTRY_VERIFY_WITH_TIMEOUT(!runner_->isRunning(), 10000);
        VERIFY_CONTAINS(runner_->text(), "does not tell whether the robot is stopped");
        QCOMPARE(blue_->calls("fake.call"), 0);
    }

    // The link to it was lost when the stop was pressed.
    void comingBackStopped() {
        run({call(*red_, 30), call(*blue_)});
        QTRY_COMPARE(red_->calls("fake.call"), 1);
        blue_->dropAll();
        blue_->setResult("motor.state", stopped);
        QTRY_VERIFY2_WITH_TIMEOUT(hasEndedBy("STOP of blue"), qPrintable(runner_->text()), 15000);
    }

private:
    static constexpr const char *free = R"({"latched":{},"control":{"held":false}})";
    static constexpr const char *stopped =
        R"({"latched":{"estop":"somebody else"},"control":{"held":false}})";

    static MacroStep call(const FakeDaemon &robot, double pause_s = 0) {
        return {robot.address(), "fake", "fake.call", {}, pause_s};
    }
    void run(const std::vector<MacroStep> &steps) {
        QTRY_VERIFY(runner_->hindrance({"Tour", steps}).isEmpty());
        runner_->run({"Tour", steps});
        QVERIFY(runner_->isRunning());
    }
    bool hasEndedBy(const QString &why) const {
        return !runner_->isRunning() && runner_->hasFailed() && runner_->text().endsWith(": " + why);
    }

    std::unique_ptr<MacroRunner> runner_;
};
