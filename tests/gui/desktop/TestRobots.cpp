#include "gui/desktop/panels/CommandsPanel.h"
#include "gui/desktop/panels/DaemonsPanel.h"
#include "gui/desktop/panels/SettingsPanel.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/FakeRobot.h"

#include <QAbstractItemView>

using namespace hermes;

/// Two robots on one host, each with a supervisor and motors, in one window.
class TestRobots : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        red_ = std::make_unique<One>();
        blue_ = std::make_unique<One>();
        red_->name = "red";
        blue_->name = "blue";
        for (One *one : {red_.get(), blue_.get()}) {
            one->processes.add("motorcontrol", one->motors.port());
            one->eye.connectTo(motorsOf(*one));
        }
        for (One *one : {red_.get(), blue_.get()})
            QVERIFY(one->eye.waitConnected());
        open_ = std::make_unique<OpenWindow>();
        QVERIFY(open_->show());
    }

    void cleanup() {
        open_.reset();
        red_.reset();
        blue_.reset();
    }

    void drivingOneNeverMovesTheOther() {
        openBoth();
        QTRY_COMPARE(find<QComboBox>("robots")->count(), 2);
        drive(*red_);
        QCOMPARE(speed(*blue_), 0.0);
        choose(*blue_);
        QCOMPARE(find<QComboBox>("robots")->currentText(), QString("blue"));
        QTRY_COMPARE(open_->window.windowTitle(), QString("blue - Hermes"));
        QTRY_COMPARE(state(*red_)["target"].toObject()["vx"].toDouble(), 0.0);
        QTRY_VERIFY(speed(*red_) < 0.01);
        QCOMPARE(speed(*blue_), 0.0); // the key is held still
        QTest::keyRelease(&open_->window, Qt::Key_W);
        drive(*blue_);
        QVERIFY(speed(*red_) < 0.01);
        red_->motors.end();
        blue_->motors.end(); // nobody else is driven instead
        QTRY_VERIFY(!open_->drive.isPossible());
        QTest::keyRelease(&open_->window, Qt::Key_W);
    }

    void stopGoesToTheChosenOne() {
        openBoth();
        choose(*blue_);
        pressStop();
        QTRY_VERIFY(open_->drive.stopping().phase() == StopPhase::Confirmed);
        QVERIFY(isStopped(*blue_));
        QVERIFY(!isStopped(*red_));
        TRY_CONTAINS(banner(), "motorcontrol of blue");
        choose(*red_);
        QCOMPARE(open_->drive.stopping().phase(), StopPhase::None);
        QVERIFY(!isStopped(*red_));
    }

    void panelsShowTheChosenOne() {
        openBoth();
        QVERIFY(open_->choose(robot(*red_)->withName("motorcontrol")));
        auto *const settings = open_->panel<SettingsPanel>("settings");
        auto *const commands = open_->panel<CommandsPanel>("commands");
        const auto title = [](QWidget *panel) { return panel->findChild<QLabel *>("title")->text(); };
        QTRY_COMPARE(title(settings), QString("motorcontrol of red"));
        choose(*blue_);
        QCOMPARE(title(settings), QString("Choose a daemon to see its settings."));
        QCOMPARE(title(commands), QString("Choose a daemon to see its commands."));
        QVERIFY(!commands->findChild<QPushButton *>("call")->isEnabled());
        QTRY_COMPARE(find<QTreeWidget>("tree")->currentItem(), rowOf(*blue_));
        choose(*red_);
        QCOMPARE(title(settings), QString("motorcontrol of red")); // as it was
    }

    void aSupervisorThatDiesLosesNobody() {
        openBoth();
        const auto daemons = robot(*red_)->daemons();
        QCOMPARE(int(daemons.size()), 2);
        Robot *const before = robot(*red_);
        red_->processes.kill("supervisor");
        QTRY_VERIFY(!before->withMethod("process.list"));
        drive(*red_);
        QTest::keyRelease(&open_->window, Qt::Key_W);
        QCOMPARE(red_->processes.supervise("crimson"), red_->processes.port("supervisor"));
        QTRY_VERIFY_WITH_TIMEOUT(before->withMethod("process.list"), 10000);
        QTRY_COMPARE(before->name(), QString("crimson"));
        QVERIFY(robot(*red_) == before && before->daemons() == daemons);
        QCOMPARE(int(open_->fleet.robots().size()), 2);
    }

    void aDriveEndsWhenItsDaemonMoves() {
        QVERIFY(open_->fleet.add(motorsOf(*red_)));
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.isPossible(), 10000);
        drive(*red_);
        addSupervisor(*red_);
        QTRY_VERIFY_WITH_TIMEOUT(robot(*red_) && robot(*red_)->withName("motorcontrol"), 20000);
        QTRY_COMPARE(state(*red_)["target"].toObject()["vx"].toDouble(), 0.0);
        QTRY_VERIFY(speed(*red_) < 0.01);
        QTRY_COMPARE(find<QLabel>("problem")->text(),
                     QString("The drive has ended: motorcontrol belongs to the robot red now."));
        QTest::qWait(300);
        QVERIFY(speed(*red_) < 0.01); // the key is held all the time
        QCOMPARE(open_->fleet.robot(), robot(*red_));
        QTest::keyRelease(&open_->window, Qt::Key_W);
        drive(*red_);
        QTest::keyRelease(&open_->window, Qt::Key_W);
    }

    void theSameWheelsAreDrivenAfterTheMove() {
        addBothMotors();
        QCOMPARE(open_->fleet.robot()->id(), QString("127.0.0.1"));
        drive(*red_);
        addSupervisor(*blue_); // the only one there: both are of its robot
        QTRY_VERIFY_WITH_TIMEOUT(robot(*blue_) && robot(*blue_)->daemons().size() == 3, 20000);
        QCOMPARE(open_->fleet.robot(), robot(*blue_));
        QTRY_VERIFY(robot(*blue_)->problem().startsWith("2 of its daemons can be driven"));
        QTRY_VERIFY(speed(*red_) < 0.01);
        QTest::keyRelease(&open_->window, Qt::Key_W);
        drive(*red_);
        QCOMPARE(speed(*blue_), 0.0);
        QTest::keyRelease(&open_->window, Qt::Key_W);
    }

    void aStopSurvivesTheMove() {
        addBothMotors();
        red_->motors.freeze();
        pressStop();
        QTRY_VERIFY(isStopped(*blue_)); // it is of the same set
        addSupervisor(*red_);
        QTRY_VERIFY_WITH_TIMEOUT(robot(*red_) && robot(*red_)->daemons().size() == 3, 20000);
        QCOMPARE(open_->fleet.robot(), robot(*red_)); // who would be driven
        QTRY_VERIFY(open_->drive.stopping().isLate());
        TRY_CONTAINS(banner(), "motorcontrol");
        QVERIFY(open_->drive.isStopped());
        OpenWindow::click(&open_->window, "release"); // of a robot that does not answer: it is not lost
        QTest::qWait(300);
        QVERIFY(!banner().isEmpty());
        pressStop();
        red_->motors.thaw();
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.stopping().phase() == StopPhase::Confirmed, 10000);
        QVERIFY(isStopped(*red_));
        OpenWindow::click(&open_->window, "release");
        QTRY_VERIFY(!isStopped(*red_));
        QTRY_VERIFY(!isStopped(*blue_)); // it is of the same robot
    }

    void aStopForNobodyGoesToWhoIsFound() {
        One &late = *red_;
        late.processes.supervise(late.name);
        late.processes.signal("supervisor", SIGSTOP); // it has not answered as yet
        late.supervisor = QString("127.0.0.1:%1").arg(late.processes.port("supervisor"));
        QVERIFY(open_->fleet.add(late.supervisor));
        pressStop();
        TRY_CONTAINS(banner(), "REACHES NOBODY");
        late.processes.signal("supervisor", SIGCONT);
        QTRY_VERIFY_WITH_TIMEOUT(robot(late), 20000);
        QTRY_VERIFY_WITH_TIMEOUT(isStopped(late), 20000);
        QTRY_VERIFY(open_->drive.stopping().phase() == StopPhase::Confirmed);
        QVERIFY2(!banner().contains("NOBODY"), qPrintable(banner()));
        QVERIFY(!isStopped(*blue_));
    }

    void whoIsDrivenOrStoppedIsNotRemoved() {
        openBoth();
        drive(*red_);
        const auto refusal = [&] {
            const auto removed = open_->fleet.remove(robot(*red_));
            return removed ? QString() : removed.error().message;
        };
        QCOMPARE(refusal(), QString("red is driven: let go first."));
        QTest::keyRelease(&open_->window, Qt::Key_W);
        pressStop();
        QTRY_VERIFY(open_->drive.stopping().phase() == StopPhase::Confirmed);
        QCOMPARE(refusal(), QString("STOP was pressed for red: release it first."));
        choose(*blue_);
        QVERIFY(!refusal().isEmpty());
        QVERIFY(open_->fleet.remove(robot(*blue_))); // the other may go
        QCOMPARE(open_->fleet.robot(), robot(*red_));
        OpenWindow::click(&open_->window, "release");
        QTRY_VERIFY(!open_->drive.isStopped());
        QCOMPARE(refusal(), QString());
        QVERIFY(open_->fleet.robots().empty());
        QVERIFY(!open_->drive.isPossible());
    }

    void removedAndBroughtBackByHand() {
        openBoth();
        open_->window.resize(1024, 600);
        auto *const panel = open_->panel<DaemonsPanel>("daemons");
        QTRY_VERIFY(rowOf(*blue_));
        fromMenu(rowOf(*blue_), "removeRobot");
        QTRY_COMPARE(int(open_->fleet.robots().size()), 1);
        QTRY_VERIFY(!rowOf(*blue_));
        QCOMPARE(open_->fleet.robot(), robot(*red_));
        auto *const back = panel->findChild<QPushButton *>("undoRemoval");
        QCOMPARE(back->text(), QString("Bring blue back"));
        QTRY_VERIFY(!back->visibleRegion().isEmpty()); // in a low window, too
        OpenWindow::click(panel, "undoRemoval");
        QTRY_VERIFY_WITH_TIMEOUT(robot(*blue_) && robot(*blue_)->withMethod("motor.drive"), 20000);
        QTRY_VERIFY(rowOf(*blue_));
        QVERIFY(!back->isVisible());
    }

    void renamedByHand() {
        openBoth();
        open_->panel<DaemonsPanel>("daemons");
        auto *const tree = find<QTreeWidget>("tree");
        QTRY_VERIFY(rowOf(*blue_));
        fromMenu(rowOf(*blue_), "renameRobot");
        QCOMPARE(open_->fleet.robot(), robot(*red_)); // a menu chooses nobody
        QTRY_VERIFY(tree->findChild<QLineEdit *>());
        QTest::qWait(100); // daemons tell of themselves meanwhile
        auto *const editor = tree->findChild<QLineEdit *>();
        QVERIFY(editor);
        open_->window.activateWindow(); // which a menu without a window manager does not give back
        QTRY_COMPARE(QApplication::focusWidget(), editor);
        editor->selectAll();
        QTest::keyClicks(editor, "north pole");
        QTest::keyClick(editor, Qt::Key_Return);
        QTRY_COMPARE(robot(*blue_)->name(), QString("north pole"));
        QTRY_COMPARE(rowOf(*blue_)->text(0), QString("north pole"));
        QTRY_COMPARE(find<QComboBox>("robots")->itemText(1), QString("north pole"));
        QCOMPARE(speed(*red_) + speed(*blue_), 0.0); // the letters drove nobody
        QVERIFY(!isStopped(*red_) && !isStopped(*blue_));
    }

private:
    /// One of the robots, with an independent eye on its motors.
    struct One {
        FakeRobot motors;
        RobotProcesses processes; ///< the supervisor
        Client eye;
        QString name, supervisor;
    };

    void openBoth() {
        for (One *one : {red_.get(), blue_.get()}) {
            addSupervisor(*one);
            QTRY_VERIFY_WITH_TIMEOUT(robot(*one) && robot(*one)->withMethod("motor.drive"), 20000);
        }
        QCOMPARE(int(open_->fleet.robots().size()), 2);
        QCOMPARE(open_->fleet.robot(), robot(*red_));
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.isPossible(), 10000);
    }

    /// Of the robot of their host; those of red are the ones that are driven.
    void addBothMotors() {
        QVERIFY(open_->fleet.add(motorsOf(*red_)));
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.isPossible(), 10000);
        QVERIFY(open_->fleet.add(motorsOf(*blue_)));
        QTRY_COMPARE_WITH_TIMEOUT(int(open_->fleet.robot()->allWithMethod("motor.estop").size()), 2, 10000);
    }
    void addSupervisor(One &one) {
        one.supervisor = QString("127.0.0.1:%1").arg(one.processes.supervise(one.name));
        QVERIFY(open_->fleet.add(one.supervisor));
    }
    Robot *robot(const One &one) const { return open_->fleet.robotAt(one.supervisor); }
    static QString motorsOf(const One &one) { return one.motors.address(); }
    static QJsonObject state(One &one) {
        const auto told = one.eye.callAndWait("motor.state");
        return told ? told->toObject() : QJsonObject();
    }
    static double speed(One &one) { return state(one)["twist"].toObject()["vx"].toDouble(); }
    /// By the key, which stays down. Again where a busy machine has held up a command, which ends a drive.
    void drive(One &one) {
        for (int i = 0; i < 4 && speed(one) <= 0.2; ++i) {
            QTest::keyRelease(&open_->window, Qt::Key_W);
            QTest::qWait(200); // a press that follows at once is the repeat of a held key
            QTRY_VERIFY(!open_->drive.mustLetGo());
            QTest::keyPress(&open_->window, Qt::Key_W);
            if (QTest::qWaitFor([&] { return speed(one) > 0.2; }, 4000))
                return;
        }
        QVERIFY2(speed(one) > 0.2, qPrintable(open_->drive.problem()));
    }
    static bool isStopped(One &one) { return state(one)["estop"].toBool(); }
    template <typename T>
    T *find(const QString &name) const {
        return open_->window.findChild<T *>(name);
    }
    /// With the list above.
    void choose(const One &one) {
        auto *const robots = find<QComboBox>("robots");
        robots->setFocus();
        const int before = robots->currentIndex();
        QTest::keyClick(robots, Qt::Key_Down); // opens the list, and chooses nothing
        QTRY_VERIFY(robots->view()->isVisible());
        QCOMPARE(robots->currentIndex(), before);
        while (robots->view()->currentIndex().row() > 0)
            QTest::keyClick(robots->view(), Qt::Key_Up);
        while (robots->itemData(robots->view()->currentIndex().row()) != robot(one)->id())
            QTest::keyClick(robots->view(), Qt::Key_Down);
        QTest::keyClick(robots->view(), Qt::Key_Return);
        QTRY_COMPARE(open_->fleet.robot(), robot(one));
        QTRY_VERIFY(open_->window.centralWidget()->isAncestorOf(open_->window.focusWidget())); // keys drive
        open_->window.activateWindow(); // as a window manager does when the list goes
        QTRY_VERIFY(QApplication::focusWidget());
    }
    void pressStop() { QTest::mousePress(find<QPushButton>("stop"), Qt::LeftButton); }
    QString banner() const {
        const auto *const label = find<QLabel>("stopBanner");
        return label->isVisible() ? label->text() : QString();
    }
    QTreeWidgetItem *rowOf(const One &one) const {
        auto *const tree = find<QTreeWidget>("tree");
        for (int i = 0; i < tree->topLevelItemCount(); ++i)
            if (tree->topLevelItem(i)->toolTip(0).contains(one.supervisor))
                return tree->topLevelItem(i);
        return nullptr;
    }
    /// Chooses from the menu of a row.
    void fromMenu(QTreeWidgetItem *row, const QString &name) {
        auto *const tree = find<QTreeWidget>("tree");
        QVERIFY(row);
        const QPoint place = tree->visualItemRect(row).center();
        QTest::mouseClick(tree->viewport(), Qt::RightButton, {}, place);
        QContextMenuEvent event(QContextMenuEvent::Mouse, place, tree->viewport()->mapToGlobal(place));
        QApplication::sendEvent(tree->viewport(), &event);
        auto *const menu = tree->findChild<QMenu *>("rowMenu");
        QTRY_VERIFY(menu && menu->isVisible());
        auto *const action = menu->findChild<QAction *>(name);
        QVERIFY(action);
        QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
    }

    std::unique_ptr<One> red_, blue_;
    std::unique_ptr<OpenWindow> open_;
};
