#include "gui/desktop/panels/EventsPanel.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/FakeRobot.h"

using namespace hermes;

/// What the line at the foot says, and how much of it is seen.
class TestEventLine : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void theFaultIsSeenInASmallWindow() {
        RobotProcesses robot;
        robot.start("scanmatcher");
        OpenWindow window(robot);
        QVERIFY(window.show());
        QTRY_VERIFY(window.fleet.robot()->withName("scanmatcher")->isKnown());
        window.window.resize(1024, 600);
        robot.kill("scanmatcher");
        QTRY_VERIFY_WITH_TIMEOUT(line(window)->text().contains("No connection"), 10000);
        QVERIFY2(!line(window)->text().contains("127.0.0.1:"), qPrintable(line(window)->text()));
        VERIFY_CONTAINS(line(window)->shownText(), "scanmatcher: No connection: ");
        QCOMPARE(line(window)->shownText(), line(window)->text()); // all of it
        PlainLabel label;
        label.letElide(Qt::ElideMiddle);
        label.setText("The beginning " + QString(500, 'x') + " and the end");
        label.resize(300, 20);
        QVERIFY(label.shownText().startsWith("The beg") && label.shownText().endsWith("the end"));
        QVERIFY(label.shownText().contains(u8"\u2026"));
    }

    void oneNameOfADaemonInAllOfTheList() {
        Events events;
        events.happened(Event::Level::Error, "motorcontrol", "killed");
        events.rename("motorcontrol", "alpha, motorcontrol");
        QCOMPARE(events.all().front().from, QString("alpha, motorcontrol"));

        RobotProcesses first, second;
        qputenv("HERMES_ROBOT", "00000000-0000-4000-8000-000000000001 first");
        first.start("scanmatcher");
        qunsetenv("HERMES_ROBOT");
        OpenWindow window(first);
        QVERIFY(window.show());
        QTRY_VERIFY(window.fleet.robot()->withName("scanmatcher")->isKnown());
        window.fleet.rename(*window.fleet.robot(), "alpha");
        first.kill("scanmatcher");
        QTRY_VERIFY_WITH_TIMEOUT(column(window, EventTable::FromColumn).contains("scanmatcher"), 10000);
        second.start("supervisor");
        QVERIFY(window.fleet.add(QString("127.0.0.1:%1").arg(second.port("supervisor"))).ok());
        QTRY_COMPARE_WITH_TIMEOUT(window.fleet.robots().size(), std::size_t(2), 10000);
        QTRY_VERIFY2_WITH_TIMEOUT(column(window, EventTable::FromColumn).contains("alpha, scanmatcher") &&
                                      !column(window, EventTable::FromColumn).contains("scanmatcher"),
                                  qPrintable(column(window, EventTable::FromColumn).join('\n')), 10000);
    }

    void otherClientTakesTheControl() {
        FakeRobot robot;
        OpenWindow window(robot.address());
        QVERIFY(window.show());
        ConnectedClient other(robot.address());
        const QJsonObject patrol{{"client", "patrol"}, {"timeout_s", 30}};
        QVERIFY(other.callAndWait("control.acquire", patrol).ok());
        QTRY_VERIFY2_WITH_TIMEOUT(
            column(window, EventTable::TextColumn).contains("patrol has taken the control"),
            qPrintable(column(window, EventTable::TextColumn).join('\n')), 10000);
        QVERIFY(other.callAndWait("control.release").ok());
    }

private:
    static PlainLabel *line(OpenWindow &window) { return window.window.findChild<PlainLabel *>("eventText"); }
    static QStringList column(OpenWindow &window, EventTable::Column column) {
        auto *const model = window.panel<EventsPanel>("events")->findChild<QTreeView *>("events")->model();
        QStringList cells;
        for (int row = 0; row < model->rowCount(); ++row)
            cells.append(model->index(row, column).data().toString());
        return cells;
    }
};
