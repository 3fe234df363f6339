#include "common/client/DaemonAddress.h"
#include "gui/desktop/MainWindow.h"
#include "gui/desktop/drive/Stick.h"
#include "tests/support/FakeRobot.h"

#include <QSlider>

using namespace hermes;
using namespace hermes::desktop;

/// Drives a robot with stick and keys, as an operator does.
class TestDrivePanel : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        robot_ = std::make_unique<FakeRobot>();
        open();
        client_ = std::make_unique<ConnectedClient>(robot_->address());
        QTRY_VERIFY(find<Stick>("stick")->isEnabled() && drive_->stateAge().isFresh());
    }

    void cleanup() {
        repeating_.reset();
        window_.reset();
        drive_.reset();
        fleet_.reset();
        client_.reset();
        robot_.reset();
    }

    void stickDrivesAndLettingGoStops() {
        press(0, 1);
        awaitMotion();
        QTRY_COMPARE(find<QLabel>("lease")->text(), QString("control: you"));
        QTRY_VERIFY(find<QLabel>("commanded0")->text().toDouble() > 0.3);
        letGo();
        QTimer eye; // it is no other client that has the control
        connect(&eye, &QTimer::timeout, this,
                [this] { QVERIFY(!find<QPushButton>("takeOver")->isVisible()); });
        eye.start(10);
        QTRY_COMPARE(commanded("vx"), 0.0);
        QTRY_VERIFY(speed() < 0.01);
        QTest::qWait(600); // its state was told meanwhile
        QTRY_COMPARE(find<QLabel>("lease")->text(), QString("control free"));
    }

    void keysDriveTurnAndGoSlow() {
        QTest::keyPress(window_.get(), Qt::Key_W);
        QTRY_VERIFY(commanded("vx") > 0.35);
        QTest::keyPress(window_.get(), Qt::Key_Shift);
        QTRY_VERIFY(commanded("vx") < 0.15 && commanded("vx") > 0.05);
        QTest::keyRelease(window_.get(), Qt::Key_Shift);
        QTest::keyPress(window_.get(), Qt::Key_Q);
        QTRY_VERIFY(commanded("omega") > 0.1);
        QTest::keyRelease(window_.get(), Qt::Key_Q);
        QTest::keyRelease(window_.get(), Qt::Key_W);
        QTRY_COMPARE(commanded("vx"), 0.0);
        QTest::keyPress(window_.get(), Qt::Key_Left);
        QTRY_VERIFY(commanded("vy") > 0.1);
        QTest::keyRelease(window_.get(), Qt::Key_Left);
        QTRY_VERIFY(speed() < 0.01);
    }

    // Its letter may change while it is held: by another layout, or by another key.
    void aKeyIsNotItsLetter() {
        constexpr quint32 scanCode = 25;
        QKeyEvent press(QEvent::KeyPress, Qt::Key_W, {}, scanCode, 0, 0, "w");
        QApplication::sendEvent(window_.get(), &press);
        awaitMotion();
        QKeyEvent release(QEvent::KeyRelease, Qt::Key_Z, {}, scanCode, 0, 0, "z");
        QApplication::sendEvent(window_.get(), &release);
        QTRY_VERIFY(!drive_->isDriving());
    }

    // A menu or a list has the keys: the release of the drive key goes there.
    void openingAMenuStops() {
        QMenu *const menu = find<QToolButton>("mapMenu")->menu();
        hold();
        menu->popup(window_->mapToGlobal(QPoint(300, 300)));
        QTRY_COMPARE(commanded("vx"), 0.0);
        QTest::keyRelease(menu, Qt::Key_W);
        menu->hide();
        isLeftAlone(10);
        hold(); // was let go meanwhile
        menu->popup(window_->mapToGlobal(QPoint(300, 300)));
        QTRY_COMPARE(commanded("vx"), 0.0);
        menu->hide();
        QTest::qWait(300); // is held all the time
        QCOMPARE(commanded("vx"), 0.0);
        QTest::keyRelease(window_.get(), Qt::Key_W);
    }

    void keysInAFieldDoNotDrive() {
        auto *const field = find<QLineEdit>("address");
        field->setFocus();
        QTest::keyClicks(field, "wasd qe");
        QCOMPARE(field->text(), QString("wasd qe"));
        QVERIFY(!drive_->isDriving());
        QVERIFY(!state()["control"].toObject()["held"].toBool());
    }

    void keysInADialogDoNotDrive() {
        find<QAction>("helpHere")->trigger();
        auto *const text = find<QWidget>("helpText");
        text->window()->activateWindow();
        QVERIFY(QTest::qWaitForWindowActive(text->window()));
        text->setFocus();
        QTest::keyPress(text, Qt::Key_Down); // scrolls
        QTest::qWait(200);
        QVERIFY(!drive_->isDriving());
        QTest::keyRelease(text, Qt::Key_Down);
    }

    void keysAfterAFieldHasVanishedDoNotDrive() {
        auto *const field = find<QLineEdit>("address");
        field->setFocus();
        QTest::keyClicks(field, "wheel");
        field->hide(); // as that of a mark when the recording ends
        QWidget *const next = QApplication::focusWidget() ? QApplication::focusWidget() : window_.get();
        QTest::keyPress(next, Qt::Key_S);
        QTest::qWait(200);
        QVERIFY(!drive_->isDriving());
        QTest::keyRelease(next, Qt::Key_S);
        field->show();
        window_->centralWidget()->setFocus();
        QTest::qWait(1200); // who has paused sees what has the focus
        hold();
        QTest::keyRelease(window_.get(), Qt::Key_W);
    }

    void stopIsLatchedAndNeedsNoControl_data() {
        const Rows<int> row("key");
        row("button", 0);
        row("space", int(Qt::Key_Space));
        row("escape, which was told to", int(Qt::Key_Escape));
    }

    void stopIsLatchedAndNeedsNoControl() {
        QFETCH(int, key);
        const QJsonObject asAnother{{"client", "patrol"}, {"timeout_s", 30}}; // who drives
        QVERIFY(client_->callAndWait("control.acquire", asAnother).ok());
        QVERIFY(client_->callAndWait("motor.drive", QJsonObject{{"vx", 0.3}}).ok());
        if (key == 0)
            QTest::mousePress(find<QPushButton>("stop"), Qt::LeftButton);
        else {
            find<QAction>("escapeStops")->setChecked(key == Qt::Key_Escape);
            QTest::keyClick(window_.get(), Qt::Key(key));
        }
        QTRY_VERIFY(state()["estop"].toBool());
        QTRY_COMPARE(find<QPushButton>("stop")->text(), QString("STOPPED"));
        QTRY_VERIFY(!find<Stick>("stick")->isEnabled());
        QTRY_VERIFY(find<QPushButton>("release")->isVisible());
        QTest::mouseClick(find<QPushButton>("release"), Qt::LeftButton);
        QTRY_VERIFY(!state()["estop"].toBool());
        QTRY_VERIFY(find<Stick>("stick")->isEnabled());
    }

    void afterAReleaseTheStickMustBeCentred() {
        hold();
        drive_->stop();
        QVERIFY(drive_->isStopped());
        QTRY_COMPARE(int(drive_->stopping().phase()), int(StopPhase::Confirmed));
        drive_->release();
        QTRY_VERIFY(!drive_->isStopped());
        QVERIFY(!drive_->isDriving()); // W is still down
        QTest::qWait(300);             // in which it would drive off
        QCOMPARE(commanded("vx"), 0.0);
        QTest::keyRelease(window_.get(), Qt::Key_W);
        awaitRest();
        QTest::keyPress(window_.get(), Qt::Key_W);
        QTRY_VERIFY(commanded("vx") > 0.1);
        QTest::keyRelease(window_.get(), Qt::Key_W);
    }

    void aReleaseByAnotherIsSeen() {
        QVERIFY(client_->callAndWait("motor.estop", QJsonObject{{"client", "anna on laptop7"}}).ok());
        QTest::keyPress(window_.get(), Qt::Key_W);
        QTest::keyRelease(window_.get(), Qt::Key_W);
        QTRY_COMPARE(find<QLabel>("problem")->text(),
                     QString("Stopped: emergency stop by anna on laptop7. Release it above."));
        QCOMPARE(find<QLabel>("control")->text(), QString("Control: free"));
        QVERIFY(releaseStop(*client_));
        QTRY_VERIFY(find<QLabel>("problem")->text().isEmpty() || !find<QLabel>("problem")->isVisible());
        find<QPushButton>("stop")->pressed();
        QTRY_COMPARE(find<QLabel>("problem")->text(),
                     QString("Stopped: emergency stop by you (this window). Release it above."));
    }

    void stoppedIsToldWhenItStands() {
        hold();
        const auto *const problem = find<QLabel>("problem");
        QStringList untrue;
        connect(drive_.get(), &DriveControl::changed, this, [&] {
            const double shown = find<QLabel>("measured0")->text().toDouble();
            if (problem->isVisible() && problem->text().startsWith("Stopped") && shown > 0.05)
                untrue.append(QString("%1 beside %2").arg(problem->text()).arg(shown));
        });
        QVERIFY(client_->callAndWait("motor.estop", QJsonObject{{"client", "anna"}}).ok());
        TRY_STARTS(problem->text(), "Stopped");
        disconnect(drive_.get(), &DriveControl::changed, this, nullptr);
        QVERIFY2(untrue.isEmpty(), qPrintable(untrue.join('\n')));
        QTest::keyRelease(window_.get(), Qt::Key_W);
    }

    void whoStoppedOnTheRobotIsToldSo() {
        Client nameless; // over TCP, as a program on the robot
        nameless.connectTo(asOwner(robot_->address()));
        QVERIFY(nameless.waitConnected().ok());
        QVERIFY(nameless.callAndWait("motor.estop").ok());
        QTRY_VERIFY2(find<QLabel>("problem")->text().contains("by a program on the robot's own computer"),
                     qPrintable(find<QLabel>("problem")->text()));
    }

    void whatAnotherCommandsIsShown() {
        QVERIFY(client_->callAndWait("control.acquire", QJsonObject{{"timeout_s", 30}}).ok());
        QVERIFY(client_->callAndWait("motor.drive", QJsonObject{{"vx", 0.3}}).ok());
        QTimer again;
        connect(&again, &QTimer::timeout, this, [this] {
            client_->callAndWait("motor.drive", QJsonObject{{"vx", 0.3}});
        });
        again.start(100);
        QTRY_COMPARE(find<QLabel>("commanded0")->text(), QString("0.30"));
        again.stop();
        QTRY_COMPARE(find<QLabel>("commanded0")->text(), QString("0.00"));
    }

    // Who has the control is told in one place only, when it is free.
    void whoseControlItWasEndsWithIt() {
        const QJsonObject patrol{{"client", "patrol"}, {"timeout_s", 30}};
        QVERIFY(client_->callAndWait("control.acquire", patrol).ok());
        QTest::keyPress(window_.get(), Qt::Key_W);
        QTRY_VERIFY(find<QLabel>("problem")->text().contains("patrol"));
        QTest::keyRelease(window_.get(), Qt::Key_W);
        QVERIFY(client_->callAndWait("control.release").ok());
        QTRY_VERIFY(find<QLabel>("control")->text().startsWith("Control: free"));
        QCOMPARE(find<QLabel>("problem")->text(), QString());
    }

    void losingTheFocusStops() {
        hold();
        QWidget other;
        other.show();
        other.activateWindow();
        QTRY_VERIFY(!window_->isActiveWindow());
        QTRY_COMPARE(commanded("vx"), 0.0);
        QTRY_VERIFY(speed() < 0.01);
    }

    void closingTheWindowStops() {
        press(0, 1);
        awaitMotion();
        window_->close();
        QTRY_COMPARE(commanded("vx"), 0.0);
        QTRY_VERIFY(!state()["control"].toObject()["held"].toBool());
    }

    void heldByAnotherAndTakenOver() {
        QVERIFY(client_->callAndWait("control.acquire", QJsonObject{{"client", "patrol"}, {"timeout_s", 30}})
                    .ok());
        QTest::keyPress(window_.get(), Qt::Key_W);
        QTRY_VERIFY(find<QLabel>("problem")->text().contains("patrol"));
        QCOMPARE(commanded("vx"), 0.0);
        QTest::keyRelease(window_.get(), Qt::Key_W);
        QTRY_VERIFY(find<QPushButton>("takeOver")->isVisible());
        QTest::mouseClick(find<QPushButton>("takeOver"), Qt::LeftButton);
        awaitRest();
        QTest::keyPress(window_.get(), Qt::Key_W);
        QTRY_VERIFY(commanded("vx") > 0.1);
        QTest::keyRelease(window_.get(), Qt::Key_W);
    }

    void whoTakesOverKeepsTheControl() {
        ConnectedClient owner(asOwner(robot_->address())); // who may
        hold();
        const QJsonObject request{{"client", "patrol"}, {"take_over", true}, {"timeout_s", 2}};
        const auto taken = owner.callAndWait("control.acquire", request);
        QVERIFY2(taken, taken ? "" : qPrintable(taken.error().message));
        for (int i = 0; i < 20; ++i) {
            const auto driven = owner.callAndWait("motor.drive", QJsonObject{{"vx", -0.2}});
            QVERIFY2(driven, driven ? "" : qPrintable(driven.error().message));
            QTest::qWait(50);
        }
        QCOMPARE(state()["control"].toObject()["holder"].toString(), QString("patrol"));
        QTest::keyRelease(window_.get(), Qt::Key_W);
        QVERIFY(owner.callAndWait("motor.stop").ok());
    }

    void keysDoNotDisturbTheDriveOfAnother() {
        QVERIFY(client_->callAndWait("control.acquire", QJsonObject{{"client", "patrol"}, {"timeout_s", 30}})
                    .ok());
        QVERIFY(client_->callAndWait("motor.drive", QJsonObject{{"vx", 0.3}}).ok());
        for (const Qt::Key key : {Qt::Key_W, Qt::Key_S, Qt::Key_W}) {
            QTest::keyPress(window_.get(), key);
            QTRY_VERIFY(find<QLabel>("problem")->text().contains("patrol"));
            QTest::keyRelease(window_.get(), key);
            for (int i = 0; i < 10; ++i) {
                QTest::qWait(20);
                QVERIFY(client_->callAndWait("motor.drive", QJsonObject{{"vx", 0.3}}).ok());
                QCOMPARE(commanded("vx"), 0.3);
            }
        }
        QCOMPARE(state()["control"].toObject()["holder"].toString(), QString("patrol"));
    }

    void motorControlGoneAndBack() {
        press(0, 1);
        awaitMotion();
        robot_->end();
        QTRY_VERIFY(!drive_->isDriving());
        QTRY_COMPARE(find<QLabel>("lease")->text(), QString("nothing to drive"));
        letGo();
        robot_->start();
        QTRY_VERIFY_WITH_TIMEOUT(find<Stick>("stick")->isEnabled(), 10000);
        awaitRest();
        press(0, 1);
        awaitMotion();
        letGo();
    }

    void aHeldKeyDrivesOnlyOnce_data() {
        const Rows<bool, bool> row("isKilled", "isRepeated");
        row("killed", true, false);
        row("killed, repeated", true, true);
        row("frozen, repeated", false, true);
    }

    void aHeldKeyDrivesOnlyOnce() {
        FETCH(bool, isKilled, bool, isRepeated);
        QTest::keyPress(window_.get(), Qt::Key_W);
        if (isRepeated)
            repeat(Qt::Key_W);
        awaitMotion();
        if (isKilled) {
            robot_->end();
            QTRY_VERIFY(!drive_->isPossible());
            robot_->start();
        } else {
            robot_->freeze();
            QTest::qWait(1500); // longer than the control lasts, and the time in which it may be silent
            robot_->thaw();
        }
        QTRY_VERIFY_WITH_TIMEOUT(find<Stick>("stick")->isEnabled(), 10000);
        QTRY_VERIFY(!drive_->isDriving());
        isLeftAlone(20);
        repeating_.reset();
        QTest::keyRelease(window_.get(), Qt::Key_W);
        awaitRest();
        QTest::keyPress(window_.get(), Qt::Key_W);
        QTRY_VERIFY2(commanded("vx") > 0.1, qPrintable(drive_->problem()));
        QTest::keyRelease(window_.get(), Qt::Key_W);
    }

    void aRepeatedKeyOfAMenuDoesNotDrive() {
        QMenu *const menu = find<QToolButton>("mapMenu")->menu();
        QTest::keyPress(window_.get(), Qt::Key_W);
        repeat(Qt::Key_W);
        awaitMotion();
        menu->popup(window_->mapToGlobal(QPoint(300, 300)));
        QTRY_COMPARE(commanded("vx"), 0.0);
        QTest::qWait(300);
        menu->hide();
        for (int i = 0; i < 10; ++i) {
            QTest::qWait(50);
            QVERIFY(!drive_->isDriving());
        }
        repeating_.reset();
        QTest::keyRelease(window_.get(), Qt::Key_W);
        QTest::qWait(300); // let go
        hold();
        QTest::keyRelease(window_.get(), Qt::Key_W);
    }

    void speedLimitInItsUnit() {
        auto *const speed = find<QLineEdit>("speedLimit");
        auto *const slider = find<QSlider>("limit");
        QTRY_COMPARE(speed->text(), QString("0.40")); // of 1 m/s
        slider->setFocus();
        QTest::keyClick(slider, Qt::Key_Home);
        QCOMPARE(speed->text(), QString("0.05"));
        const auto type = [&](const char *text) {
            QTest::mouseClick(speed, Qt::LeftButton);
            speed->selectAll();
            QTest::keyClicks(speed, text);
            QTest::keyClick(speed, Qt::Key_Return);
        };
        type("0.25");
        QCOMPARE(drive_->limit().vx, 0.25);
        QCOMPARE(slider->value(), 25);
        QCOMPARE(find<QLabel>("turnLimit")->text(),
                 QString("%1 rad/s").arg(0.25 * drive_->most().omega, 0, 'f', 2));
        QVERIFY(!speed->hasFocus()); // so that the keys drive
        QTest::keyPress(window_.get(), Qt::Key_W);
        QTRY_COMPARE(commanded("vx"), 0.25);
        QTest::keyRelease(window_.get(), Qt::Key_W);
        for (const char *const nonsense : {"fast", "-1", "0", ""}) {
            type(nonsense);
            QCOMPARE(drive_->limit().vx, 0.25);
            QCOMPARE(speed->text(), QString("0.25"));
            QVERIFY(find<QLabel>("problem")->text().contains("is no speed"));
        }
        QTest::mouseClick(speed, Qt::LeftButton);
        QTest::keyClick(speed, Qt::Key_A, Qt::ControlModifier);
        QSignalSpy told(drive_.get(), &DriveControl::changed);
        QTRY_VERIFY(told.count() > 2);
        QCOMPARE(speed->selectedText(), QString("0.25"));
        type("7"); // more than it can
        QCOMPARE(drive_->limit().vx, 1.0);
        QCOMPARE(speed->text(), QString("1.00"));
        ConnectedClient owner(asOwner(robot_->address()));
        const QJsonObject slower{{"motion", QJsonObject{{"vx", 0.5}}}};
        QVERIFY(owner.callAndWait("settings.set", QJsonObject{{"values", slower}}).ok());
        QTRY_COMPARE(speed->text(), QString("0.50")); // another largest speed
        QCOMPARE(slider->value(), 100);
    }

    // It is in m/s, whatever becomes of the robot's largest speed.
    void nobodyElseRaisesTheLimit() {
        auto *const speed = find<QLineEdit>("speedLimit");
        auto *const problem = find<QLabel>("problem");
        const auto type = [&](const QString &text) {
            speed->setFocus();
            speed->selectAll();
            QTest::keyClicks(speed, text);
            QTest::keyClick(speed, Qt::Key_Return);
        };
        QTRY_COMPARE(speed->text(), QString("0.40"));
        type("0.30");
        Client owner;
        owner.connectTo(asOwner(robot_->address()));
        QVERIFY(owner.waitConnected().ok());
        const auto setMost = [&](double vx) {
            const QJsonObject values{{"motion", QJsonObject{{"vx", vx}}}};
            QVERIFY(owner.callAndWait("settings.set", QJsonObject{{"values", values}}).ok());
            QTRY_COMPARE(drive_->most().vx, vx);
        };
        setMost(1.5);
        QCOMPARE(drive_->limit().vx, 0.3);
        QCOMPARE(speed->text(), QString("0.30"));
        press(0, 1);
        QTRY_VERIFY(std::abs(commanded("vx") - 0.3) < 0.001);
        find<QSlider>("limit")->setValue(100);
        QVERIFY(problem->text().contains("Let go first"));
        QCOMPARE(drive_->limit().vx, 0.3);
        find<QSlider>("limit")->setValue(10); // lower goes at once
        QTRY_VERIFY(std::abs(commanded("vx") - 0.15) < 0.001);
        QVERIFY(!problem->text().contains("Let go first"));
        letGo();
        setMost(0.1);
        setMost(1.5);
        QCOMPARE(drive_->limit().vx, 0.1); // what a smaller one has lowered stays low
    }

    void theLimitIsKept() {
        const QTemporaryDir folder;
        open(folder.filePath("gui.json"));
        QTRY_COMPARE(drive_->most().vx, 1.0);
        drive_->setLimit(0.3);
        window_->close();
        open(folder.filePath("gui.json"));
        QTRY_COMPARE(find<QLineEdit>("speedLimit")->text(), QString("0.30"));
    }

    // Why a number was refused does not hide why the drive has ended.
    void aRefusedLimitHidesNothing() {
        auto *const speed = find<QLineEdit>("speedLimit");
        speed->setFocus();
        speed->selectAll();
        QTest::keyClicks(speed, "fast");
        QTest::keyClick(speed, Qt::Key_Return);
        QVERIFY(find<QLabel>("problem")->text().contains("is no speed"));
        press(0, 1);
        awaitMotion();
        robot_->freeze();
        QTRY_VERIFY2(find<QLabel>("problem")->text().contains("did not answer"),
                     qPrintable(find<QLabel>("problem")->text()));
        robot_->thaw();
        letGo();
    }

    void theBatteryIsTold() {
        const auto *const power = find<QLabel>("power");
        const QRegularExpression full("^battery 25\\.4 V   100 %   1?[0-9] h [0-9]+ min   [0-9.]+ A   ");
        QTRY_VERIFY2_WITH_TIMEOUT(full.match(power->text()).hasMatch(), qPrintable(power->text()), 20000);
        VERIFY_CONTAINS(power->toolTip(), "Charge 100 %");
    }

    // With its source and its end. Texts of forms are those of their values.
    void theManualListsEachText() {
        QSet<QString> shown;
        for (const QLabel *const label : window_->findChildren<QLabel *>())
            if (QString name = label->objectName(); !name.isEmpty() && !name.startsWith("qt_") &&
                                                    !name.contains('/') && name != "heading" &&
                                                    name != "description")
                shown.insert(name.remove(QRegularExpression("[0-9]$")));
        const QStringList keys = listedTexts().keys();
        const QSet<QString> listed(keys.begin(), keys.end());
        const auto told = [](const QSet<QString> &names) { return QStringList(names.values()).join(' '); };
        QVERIFY2((shown - listed).isEmpty(), qPrintable("not listed: " + told(shown - listed)));
        QVERIFY2((listed - shown).isEmpty(), qPrintable("not there: " + told(listed - shown)));
    }

    // What a robot has told is gone, grey or struck out when the robot is gone.
    void noTextOutlivesItsRobot() {
        const auto labels = window_->findChildren<QLabel *>();
        const QMap<QString, QString> listed = listedTexts();
        const auto told = [&] {
            QStringList all;
            for (const QLabel *const label : labels)
                if (const QString name = QString(label->objectName()).remove(QRegularExpression("[0-9]$"));
                    listed.value(name).contains("robot") && label->isVisible() && label->isEnabled() &&
                    !label->text().isEmpty() && !label->text().startsWith("no", Qt::CaseInsensitive) &&
                    label->text() != "0.00")
                    all.append(name + ": " + label->text());
            return all;
        };
        press(0, 1);
        awaitMotion();
        QVERIFY2(told().size() >= 4, qPrintable(told().join('\n')));
        letGo();
        robot_->end();
        QTRY_VERIFY2_WITH_TIMEOUT(told().isEmpty(), qPrintable(told().join('\n')), 10000);
    }

private:
    template <typename T>
    T *find(const QString &name) const {
        return window_->findChild<T *>(name);
    }
    /// The velocity that motorcontrol has measured.
    double speed() const { return std::hypot(drive_->measured().vx, drive_->measured().vy); }
    void awaitMotion() { QTRY_VERIFY2(speed() > 0.2, qPrintable(drive_->problem())); }
    void hold() {
        QTest::keyPress(window_.get(), Qt::Key_W);
        awaitMotion();
    }
    /// So many times, 50 ms apart.
    void isLeftAlone(int times) {
        for (int i = 0; i < times; ++i) {
            QTest::qWait(50);
            QCOMPARE(commanded("vx"), 0.0);
        }
    }
    QJsonObject state() {
        const auto result = client_->callAndWait("motor.state");
        return result ? result->toObject() : QJsonObject();
    }
    double commanded(const char *axis) { return state()["target"].toObject()[axis].toDouble(); }
    QPoint onStick(double right, double up) const {
        const QPoint middle = find<Stick>("stick")->rect().center();
        return middle + QPoint(int(right * 40), int(-up * 40));
    }
    void press(double right, double up) {
        auto *const stick = find<Stick>("stick");
        QTest::mousePress(stick, Qt::LeftButton, {}, onStick(0, 0));
        QMouseEvent move(QEvent::MouseMove, onStick(right, up), Qt::NoButton, Qt::LeftButton, {});
        QApplication::sendEvent(stick, &move);
    }
    void letGo() { QTest::mouseRelease(find<Stick>("stick"), Qt::LeftButton, {}, onStick(0, 0)); }

    /// Repeats a held key as some displays do: by releases and presses that are not marked as repeats.
    void repeat(Qt::Key key) {
        repeating_ = std::make_unique<QTimer>();
        connect(repeating_.get(), &QTimer::timeout, this, [this, key] {
            QWidget *const popup = QApplication::activePopupWidget();
            QWidget *const hearing = popup ? popup : window_.get();
            QTest::keyRelease(hearing, key);
            QTest::keyPress(hearing, key);
        });
        repeating_->start(20);
    }

    void open(const QString &layoutFile = {}) {
        window_.reset();
        drive_.reset();
        fleet_ = std::make_unique<Fleet>();
        QVERIFY(fleet_->add(robot_->address()).ok());
        drive_ = std::make_unique<DriveControl>(*fleet_);
        window_ = std::make_unique<MainWindow>(*fleet_, *drive_, layoutFile);
        window_->show();
        window_->activateWindow();
        QVERIFY(QTest::qWaitForWindowActive(window_.get()));
    }

    /// Of the manual: their names with their sources.
    static QMap<QString, QString> listedTexts() {
        QFile page(TEST_DATA_DIR "/../../docs/desktop.md");
        if (!page.open(QIODevice::ReadOnly))
            return {};
        const QString section =
            QString::fromUtf8(page.readAll()).section("## What each text says\n", 1).section("\n## ", 0, 0);
        static const QRegularExpression line("^\\| `(\\w+)` \\| [^|]+ \\| ([^|]+) \\| [^|]+ \\|$",
                                             QRegularExpression::MultilineOption);
        QMap<QString, QString> found;
        for (auto row = line.globalMatch(section); row.hasNext();) {
            const QRegularExpressionMatch match = row.next();
            found[match.captured(1)] = match.captured(2);
        }
        return found;
    }

    void awaitRest() { QTRY_VERIFY(!drive_->mustLetGo()); }

    std::unique_ptr<QTimer> repeating_;
    std::unique_ptr<FakeRobot> robot_;
    std::unique_ptr<Fleet> fleet_;
    std::unique_ptr<DriveControl> drive_;
    std::unique_ptr<MainWindow> window_;
    std::unique_ptr<Client> client_; // an independent eye
};
