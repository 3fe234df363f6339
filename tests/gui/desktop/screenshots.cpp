// Makes the pictures of the operator's window for the documentation: screenshots FOLDER.
#include "gui/desktop/MainWindow.h"
#include "gui/desktop/Theme.h"
#include "tests/gui/desktop/RobotProcesses.h"

#include <QApplication>
#include <QDir>
#include <QDockWidget>

using namespace hermes;

class Screenshots : public QObject {
    Q_OBJECT
public:
    static QString folder;

private Q_SLOTS:
    void all();
};

QString Screenshots::folder;

void Screenshots::all() {
    RobotProcesses robot;
    robot.startAll();
    Fleet fleet;
    robot.connectTo(fleet);
    DriveControl drive(fleet);
    MainWindow window(fleet, drive, {});
    window.resize(1280, 720);
    window.show();
    fleet.choose(fleet.robot()->withName("motorcontrol"));
    fleet.robot()->withName("simulator")->client().callAndWait("sim.drive");
    QTest::qWait(12000); // so that there is a map to see
    for (auto *const dock : window.findChildren<QDockWidget *>()) {
        dock->raise();
        QTest::qWait(400);
        QVERIFY(window.grab().save(folder + "/desktop-" + dock->objectName() + ".png"));
    }
}

int main(int argc, char **argv) {
    QApplication application(argc, argv);
    theme::apply();
    Screenshots::folder = argc > 1 ? argv[1] : ".";
    QDir().mkpath(Screenshots::folder);
    Screenshots screenshots;
    return QTest::qExec(&screenshots, {argv[0]});
}

#include "screenshots.moc"
