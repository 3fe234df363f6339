#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// Nothing that came from a robot looks live for longer than it is: daemons that freeze, and devices that
/// fall silent.
class TestAgeing : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        robot_ = std::make_unique<RobotProcesses>();
        robot_->startAll();
        open_ = std::make_unique<OpenWindow>(*robot_);
        QVERIFY(open_->show());
        QTRY_VERIFY_WITH_TIMEOUT(map().pose() && open_->isGreenSeen(), 20000);
        QTRY_COMPARE(label("measured0")->text(), QString("0.00"));
    }

    void motorControlFrozen() {
        QTest::keyPress(&open_->window, Qt::Key_W);
        QTRY_VERIFY(label("measured0")->text().toDouble() > 0.2);
        QTRY_COMPARE(label("lease")->text(), QString("control: you"));
        QVERIFY(label("measured0")->isEnabled());
        robot_->signal("motorcontrol", SIGSTOP);
        auto frozen = runningTimer();
        QTRY_VERIFY_WITH_TIMEOUT(!label("measured0")->isEnabled(), 1000);
        QTRY_VERIFY_WITH_TIMEOUT(badge("motorcontrol").startsWith("no answer for "), 2500);
        QCOMPARE(daemon("motorcontrol")->condition(), Condition::Unreachable);
        TRY_CONTAINS(label("link")->text(), "motorcontrol: no answer for ");
        QTRY_VERIFY_WITH_TIMEOUT(!label("lease")->isEnabled(), 2500);
        QVERIFY2(frozen.elapsed() < 3000, saying(frozen.elapsed()));
        QTRY_VERIFY_WITH_TIMEOUT(label("measured0")->font().strikeOut(), 4000);
        TRY_STARTS(label("measuredName")->text(), "no data for ");
        QTRY_VERIFY_WITH_TIMEOUT(label("lease")->text().contains("no data for "), 5000);
        const auto silence_s = [this] { return badge("motorcontrol").section(' ', 3, 3).toInt(); };
        QTRY_VERIFY_WITH_TIMEOUT(silence_s() >= 7, 8000); // a call has ended meanwhile
        QTest::keyRelease(&open_->window, Qt::Key_W);
        robot_->signal("motorcontrol", SIGCONT);
        QTRY_VERIFY(label("measured0")->isEnabled() && !label("measured0")->font().strikeOut());
        QTRY_COMPARE(label("measuredName")->text(), QString("measured"));
        QTRY_VERIFY(daemon("motorcontrol")->condition() != Condition::Unreachable);
        TRY_STARTS(label("link")->text(), "link ");
    }

    void sourceOfThePoseSilent_data() {
        const Rows<QString, bool> row("who", "scansGoOn");
        row("the matcher is frozen", "scanmatcher", true);
        row("the lidar is silent", "simulator", false);
    }

    void sourceOfThePoseSilent() {
        FETCH(QString, who, bool, scansGoOn);
        robot_->signal(who, SIGSTOP);
        QTRY_VERIFY_WITH_TIMEOUT(!map().poseAge().isFresh(), 1500);
        QTRY_VERIFY_WITH_TIMEOUT(!open_->isGreenSeen(), 500);
        QTRY_VERIFY_WITH_TIMEOUT(
            map().poseAge().age_s() > 4 && map().poseAge().text().startsWith("no data for "), 6000);
        QCOMPARE(map().scanAge().isFresh(), scansGoOn);
        QVERIFY(!open_->isGreenSeen());
        robot_->signal(who, SIGCONT);
        QTRY_VERIFY_WITH_TIMEOUT(map().poseAge().isFresh() && open_->isGreenSeen(), 20000);
    }

    // What comes once a second is not old after half a second.
    void periodsAreKept() {
        const auto areEnabled = [this] { return label("power")->isEnabled() && label("lease")->isEnabled(); };
        QTRY_VERIFY(!label("power")->text().isEmpty() && !label("lease")->text().isEmpty() && areEnabled());
        for (int i = 0; i < 30; ++i) {
            QTest::qWait(50);
            QVERIFY2(areEnabled(), qPrintable(label("power")->text() + label("lease")->text()));
        }
    }

private:
    QLabel *label(const QString &name) const { return open_->window.findChild<QLabel *>(name); }
    const MapModel &map() const { return open_->window.map().model(); }
    DaemonLink *daemon(const QString &name) const { return open_->fleet.robot()->withName(name); }
    QString badge(const QString &name) const { return open_->row(daemon(name))->text(1); }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> open_;
};
