#include "tests/gui/desktop/ButtonsWindow.h"

using namespace hermes;

/// The operator's own buttons run, ask and end.
class TestButtons : public QObject, protected ButtonsWindow {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() { startRobot(); }
    void init() { begin(); }
    void cleanup() { close(); }

    void stepsRunOneAfterTheOther() {
        open({macro("Tour", {place(0.1, 0.4), place(0.2, 0.4), place(0.3)})});
        auto clock = runningTimer();
        press(0);
        TRY_CONTAINS(text(), "step 2 of 3");
        QTRY_COMPARE(x(), 0.2);
        QTRY_COMPARE(text(), QString("Tour: done"));
        QVERIFY(clock.elapsed() >= 800);
        QCOMPARE(x(), 0.3);
    }

    // It does not take the control by itself, either.
    void endsAtTheFirstError() {
        open({macro("Drive", {place(0.1), step("motorcontrol", "motor.drive", {{"vx", 0.1}}), place(0.9)})});
        press(0);
        TRY_STARTS(text(), "Drive ended at step 2 of 3, motorcontrol, motor.drive: ");
        QCOMPARE(x(), 0.1);
        QVERIFY(!ask("control.state")["held"].toBool(true));
        QVERIFY(button(0)->isEnabled());
    }

    void whatForgetsAsksOnce() {
        open(
            {macro("Fresh",
                   {place(0.1), step("simulator", "settings.reset", {{"paths", QJsonArray{"log.records"}}}),
                    step("simulator", "settings.reset", {{"paths", QJsonArray{"log.level"}}}), place(0.6)})});
        const double before = x();
        press(0);
        VERIFY_STARTS(text(), "Press Fresh once more: it replaces or forgets the settings");
        QTest::mouseClick(button(0), Qt::LeftButton); // a double click
        QTest::qWait(600);
        QVERIFY(text().startsWith("Press"));
        QCOMPARE(x(), before);
        press(0);
        QTRY_COMPARE(text(), QString("Fresh: done"));
        QCOMPARE(title(0), QString("Fresh"));
        QCOMPARE(x(), 0.6);
    }

    // Which is another one at that place then.
    void removedWhileItAsks() {
        const QJsonObject reset = step("simulator", "settings.reset", {{"paths", QJsonArray{"log.level"}}});
        open({macro("Asks", {reset}), macro("Other", {reset})});
        click("editButtons");
        press(0);
        QVERIFY(text().startsWith("Press Asks once more"));
        click("buttonRemove");
        QTRY_COMPARE(title(0), QString("Other"));
        QVERIFY(text().isEmpty());
        press(0);
        QVERIFY(text().startsWith("Press Other once more"));
    }

    void runsOnlyOnceAtATime() {
        open({macro("Slow", {place(0.1, 1), place(0.2)}), macro("Other", {place(0.9)})});
        press(0);
        QTRY_VERIFY(text().startsWith("Slow: "));
        QVERIFY(!button(0)->isEnabled() && !button(1)->isEnabled());
        QTest::mouseClick(button(1), Qt::LeftButton);
        QTRY_COMPARE(text(), QString("Slow: done"));
        QCOMPARE(x(), 0.2);
        QVERIFY(button(0)->isEnabled() && button(1)->isEnabled());
    }

    void endedByHand() {
        open({macro("Slow", {place(0.1, 30), place(0.9)})});
        QVERIFY(!find<QPushButton>("endMacro")->isEnabled());
        press(0);
        QTRY_COMPARE(x(), 0.1);
        click("endMacro");
        VERIFY_STARTS(text(), "Slow ended before step 2 of 2, ");
        QVERIFY(!find<QPushButton>("endMacro")->isEnabled());
        QCOMPARE(x(), 0.1);
    }

    void stopEndsIt_data() { rowsOf("by", {"button", "F12", "another client"}); }

    void stopEndsIt() {
        QFETCH(QString, by);
        open({macro("Slow", {place(0.1, 30), place(0.9)})});
        press(0);
        QTRY_COMPARE(x(), 0.1);
        TRY_STARTS(text(), "Slow: waits 30 s before step 2 of 2, ");
        if (by == "button")
            QTest::mouseClick(find<QPushButton>("stop"), Qt::LeftButton);
        else if (by == "F12")
            QTest::keyClick(window_.get(), Qt::Key_F12);
        else
            QVERIFY(client_->callAndWait("motor.estop").ok());
        QTRY_VERIFY2(text().startsWith("Slow ended before step 2 of 2, ") && text().endsWith(": STOP"),
                     qPrintable(text()));
        QVERIFY(!find<QPushButton>("endMacro")->isEnabled());
    }
};
