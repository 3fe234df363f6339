// Makes the pictures of the operator's window for the documentation: screenshots FOLDER.
#include "gui/desktop/MainWindow.h"
#include "gui/desktop/Theme.h"
#include "tests/gui/desktop/RobotProcesses.h"

#include <QApplication>
#include <QDir>
#include <QDockWidget>
#include <QTreeWidget>

using namespace hermes;

class Screenshots : public QObject {
    Q_OBJECT
public:
    static QString folder;

private Q_SLOTS:
    void all();
};

QString Screenshots::folder;

/// Ticks the measured velocities in the panel of plots.
static void plot(MainWindow &window) {
    auto *const tree = window.findChild<QTreeWidget *>("topics");
    for (QTreeWidgetItem *item : tree->findItems("odometry", Qt::MatchExactly | Qt::MatchRecursive)) {
        item->setExpanded(true);
        QTRY_VERIFY(item->childCount() > 0);
        for (int i = 0; i < item->childCount(); ++i)
            if (item->child(i)->text(0).startsWith("twist"))
                item->child(i)->setCheckState(0, Qt::Checked);
    }
}

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
    plot(window);
    drive.steer("pictures", {1, 0, 0.35}, true);
    QTest::qWait(8000); // so that there is a map to see
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
