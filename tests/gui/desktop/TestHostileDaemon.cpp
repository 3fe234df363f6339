#include "gui/desktop/MainWindow.h"
#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/HostileRows.h"

#include <QCborValue>

using namespace hermes;
using namespace hermes::desktop;

static DaemonLink *add(Fleet &fleet, const FakeDaemon &daemon) {
    const QString address = daemon.address();
    fleet.add(address);
    for (const auto &robot : fleet.robots())
        for (DaemonLink *const link : robot->daemons())
            if (link->address() == address)
                return link;
    return nullptr;
}

/// The window on a good motor control and on a daemon that says whatever no daemon should: the window lives,
/// its event loop turns, and STOP reaches the motors.
class TestHostileDaemon : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        busyMost_ms += std::max(2 * paintingTime_ms(), readingTime_ms());
        qInfo("a turn may take %.1f ms", busyMost_ms);
        QLoggingCategory::setFilterRules("*.debug=false");
    }

    void survives_data() { addHostileRows(); }

    void survives() {
        QFETCH(Mischief, mischief);
        Mischief motors;
        motors.isMotors = true;
        motors.hasTopics = false;
        FakeDaemon good(motors), hostile(mischief);
        Fleet fleet;
        DriveControl drive(fleet);
        MainWindow window(fleet, drive, {});
        window.show();
        QVERIFY(QTest::qWaitForWindowActive(&window));
        const double before_mb = resident_mb();
        if (!mischief.isMotors) // else those are driven that come first
            QTRY_VERIFY(add(fleet, good)->hasMethod("motor.estop"));

        LoopWatch watch;
        DaemonLink *const daemon = add(fleet, hostile);
        const bool agrees = mischief.noise.isEmpty() || mischief.agrees;
        QTRY_VERIFY(hostile.calls(agrees ? "daemon.info" : "protocol.use") > 0);
        const bool isHeard = mischief.noise.isEmpty() && !mischief.results.contains("rpc.discover");
        const bool isLookedAt = !mischief.topics.isEmpty() || !mischief.results.isEmpty();
        if (isHeard && isLookedAt && !mischief.results.contains("daemon.info"))
            QTRY_VERIFY(!daemon->description().isEmpty()); // before that there is nothing to look at
        lookAround(window, fleet, daemon);
        if (isHeard) {
            for (const QString &method : mischief.results.keys())
                QTRY_VERIFY2(hostile.calls(method) > 0, qPrintable(method));
            for (const QString &topic : mischief.topics.keys())
                QTRY_VERIFY2(hostile.subscriptions(topic) > 0, qPrintable(topic));
        }
        QTest::qWait(80); // what comes all the time goes on
        if (mischief.isMotors)
            QTRY_VERIFY(add(fleet, good)->hasMethod("motor.estop"));
        const double busy_ms = watch.longestCpu_ms();

        QPushButton *const stop = stopButton(window);
        QVERIFY(window.isVisible() && stop->isVisible() && stop->isEnabled());
        const QRect place(stop->mapTo(&window, QPoint()), stop->size());
        QVERIFY2(window.width() == 1280 && window.rect().contains(place), saying(window.width()));
        fleet.choose(fleet.robotOf(add(fleet, good))); // those that name processes are robots of their own
        const int stopsBefore = good.calls("motor.estop");
        QTest::mouseClick(stop, Qt::LeftButton);
        QTRY_VERIFY_WITH_TIMEOUT(good.calls("motor.estop") > stopsBefore, 1000);
        for (const QLabel *const label : window.findChildren<QLabel *>())
            QVERIFY2(label->textFormat() == Qt::PlainText, qPrintable(label->text().left(200)));
        for (const QWidget *const widget : window.findChildren<QWidget *>())
            QVERIFY2(isPlain(widget->toolTip()), qPrintable(widget->toolTip().left(200)));
        for (auto *const tree : window.findChildren<QTreeWidget *>())
            for (QTreeWidgetItemIterator i(tree); *i; ++i)
                QVERIFY2(isPlain((*i)->toolTip(0)), qPrintable((*i)->toolTip(0).left(200)));
        QVERIFY2(resident_mb() - before_mb < 60 * slowness, saying(resident_mb() - before_mb));
        qInfo("busy %.1f ms, %.1f MB", busy_ms, resident_mb() - before_mb);
        QVERIFY2(busy_ms < busyMost_ms, saying(busy_ms));
    }

    void whatCannotBeReadIsNamed() {
        Mischief mischief = ofMethod("motor.state", R"({"latched":{},"control":{"held":true,"holder":7}})");
        mischief.isMotors = true;
        mischief.topics["power"] =
            R"({"controllers":[{"ready":true,"battery_v":"full","current_a":[0,0],"temperature_c":20}]})";
        mischief.topics["processes"] = R"({"robot":"r","processes":[{"name":"p","port":70000}]})";
        const FakeDaemon daemon(mischief);
        Fleet fleet;
        DriveControl drive(fleet);
        MainWindow window(fleet, drive, {});
        add(fleet, daemon);
        auto *const power = window.findChild<QLabel *>("power");
        TRY_CONTAINS(power->text(), "controllers.0.battery_v");
        TRY_CONTAINS(drive.problem(), "member control.holder: found 7");
        QVERIFY(drive.holder().isEmpty());
        TRY_CONTAINS(fleet.robot()->problem(), "processes.0.port");
    }

    void whoDoesNotAnswerIsNamed() {
        const FakeDaemon daemon(ofNoise("HTTP/1.1 200 OK\n"));
        Fleet fleet;
        const DaemonLink *const link = add(fleet, daemon);
        QSignalSpy changed(link, &DaemonLink::changed);
        QTRY_VERIFY(changed.count() > 0 && link->reason().contains("Messages that could not be read: 1"));
        VERIFY_CONTAINS(link->reason(), ": no answer yet");
        QCOMPARE(link->condition(), Condition::Unreachable);
    }

private:
    // Of the processor, in one turn of the event loop; and what Qt takes here to paint so many lines, or to
    // read the largest frame, whichever is more.
    double busyMost_ms = 50 * slowness;

    // Two thousand lines across a window, the worst that is shown.
    static double paintingTime_ms() {
        QImage image(1280, 720, QImage::Format_ARGB32_Premultiplied);
        QPainter painter(&image);
        painter.setPen(QPen(Qt::black, 2));
        auto clock = runningTimer();
        painter.drawLines(QVector<QLineF>(2000, QLineF(0, 0, 1280, 720)));
        return double(clock.nsecsElapsed()) * 1e-6;
    }

    static double readingTime_ms() {
        auto clock = runningTimer();
        QCborValue::fromCbor(manyEmptyLists()).toJsonValue();
        return double(clock.nsecsElapsed()) * 1e-6;
    }

    /// Looks at everything that the window shows of the daemon.
    void lookAround(MainWindow &window, Fleet &fleet, DaemonLink *daemon) {
        fleet.choose(daemon);
        for (auto *const dock : window.findChildren<QDockWidget *>()) {
            dock->show();
            dock->raise();
            QTest::qWait(10);
        }
        for (QAction *const layer : window.findChild<MapPanel *>()->findChild<QMenu *>("layers")->actions())
            layer->setChecked(true);
        auto *const topics = window.findChild<QTreeWidget *>("topics");
        for (QTreeWidgetItem *item : topics->findItems("free", Qt::MatchExactly | Qt::MatchRecursive)) {
            item->setExpanded(true);
            QTest::qWait(30); // its numbers are those of the next message
            for (int i = 0; i < qMin(item->childCount(), 5); ++i)
                item->child(i)->setCheckState(0, Qt::Checked);
        }
        auto *const methods = window.findChild<QListWidget *>("methods");
        if (methods->count() > 0)
            methods->setCurrentRow(methods->count() - 1);
        QTest::qWait(10);
        if (methods->count() > 0)
            methods->setCurrentRow(0);
        QTest::qWait(10);
        if (auto *const call = window.findChild<QPushButton *>("call"); call->isEnabled())
            call->click();
    }

    static QPushButton *stopButton(MainWindow &window) { return window.findChild<QPushButton *>("stop"); }

    static double resident_mb() {
        QFile file("/proc/self/statm");
        file.open(QIODevice::ReadOnly);
        return file.readAll().split(' ').value(1).toDouble() * 4096 / 1e6;
    }

    /// Nothing in it comes to life.
    static bool isPlain(QString toolTip) {
        toolTip.remove("<span style='white-space: pre-wrap'>").remove("</span>");
        return !toolTip.contains('<');
    }
};
