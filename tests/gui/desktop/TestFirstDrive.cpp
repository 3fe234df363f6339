#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/OpenWindow.h"

#include "common/client/DaemonAddress.h"

#include <QProcess>

using namespace hermes;
using namespace hermes::desktop;

/// The first minutes of somebody who has never seen the window, with a real mouse and real keys on a display
/// with a window manager: how many actions it takes from its start until the robot drives.
class TestFirstDrive : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        if (QGuiApplication::platformName() != "xcb")
            QSKIP("needs a display: tests/gui/desktop/with_display");
    }
    void threeActions();
};

void TestFirstDrive::threeActions() {
    RobotProcesses robot;
    robot.startAll();
    const QString supervisor = QString("127.0.0.1:%1").arg(robot.supervise("rover"));
    OpenWindow
        open; // as `hermes-gui --connect` and the search at the start do, of the daemons of this computer
    QVERIFY(open.fleet.add(supervisor).ok());
    QVERIFY(open.show());
    QTRY_VERIFY_WITH_TIMEOUT(open.drive.isPossible(), 10000);
    const MapModel &model = open.window.map().model();
    QTRY_VERIFY_WITH_TIMEOUT(model.pose(), 20000);
    const Pose2D begin = *model.pose();
    int actions = 0;
    const auto act = [&actions](const QString &words) {
        ++actions;
        QProcess::startDetached("xdotool", words.split(' '));
    };
    const QPoint middle =
        open.window.centralWidget()->mapToGlobal(open.window.centralWidget()->rect().center());
    act(QString("mousemove %1 %2 click 1").arg(middle.x()).arg(middle.y())); // into the window
    act("keydown w sleep 1.5 keyup w");
    QTRY_VERIFY_WITH_TIMEOUT(std::hypot(model.pose()->x - begin.x, model.pose()->y - begin.y) > 0.2, 10000);
    QTRY_VERIFY(!open.drive.isDriving());
    QVERIFY2(actions <= 3, qPrintable(QString::number(actions)));
}

QTEST_MAIN(TestFirstDrive)
#include "TestFirstDrive.moc"
