// Makes the pictures of the operator's window for the documentation: screenshots FOLDER [SUFFIX [WIDTHxHEIGHT
// [DOCK]]], of all docks or of one.
#include "gui/desktop/MainWindow.h"
#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/panels/TopicTree.h"
#include "tests/gui/desktop/RobotProcesses.h"
#include "tests/support/ReleaseStop.h"

#include <QAbstractButton>
#include <QApplication>
#include <QDir>
#include <QDockWidget>
#include <QTreeWidget>
#include <cstdio>

using namespace hermes;

class Screenshots : public QObject {
    Q_OBJECT
public:
    static QStringList arguments; // those of the program

private Q_SLOTS:
    void all();
    void setup();
};

QStringList Screenshots::arguments;

/// Plots heading and velocity, and below them how the wheels turn.
static void plot(MainWindow &window) {
    PlotBoard &board = window.findChild<PlotsPanel *>()->board();
    auto *const tree = window.findChild<TopicTree *>();
    const auto tick = [tree](const QString &topic, const QStringList &names) {
        for (QTreeWidgetItem *item : tree->findItems(topic, Qt::MatchExactly | Qt::MatchRecursive)) {
            item->setExpanded(true);
            for (int i = 0; i < item->childCount(); ++i)
                if (names.contains(item->child(i)->text(0)))
                    item->child(i)->setCheckState(0, Qt::Checked);
        }
    };
    tick("odometry", {"pose.theta", "twist.vx"});
    board.addPane();
    tick("wheels", {"front_left.speed", "front_right.speed"});
    board.time().setSpan(10);
    tree->scrollToItem(tree->findItems("pose.theta", Qt::MatchExactly | Qt::MatchRecursive).value(0));
}

/// Whether the picture of this dock is asked for.
static bool isWanted(const QString &dock) {
    return Screenshots::arguments.size() <= 4 || Screenshots::arguments[4] == dock;
}

static void resize(MainWindow &window) {
    const QStringList size = Screenshots::arguments.value(3, "1280x720").split('x');
    window.resize(size.value(0).toInt(), size.value(1).toInt());
    window.show();
}

static void take(MainWindow &window, QDockWidget &dock) {
    const bool isCloud = dock.objectName() == "cloud";
    if (isCloud) // more of it is to be seen
        window.resizeDocks({&dock}, {window.height() / 2}, Qt::Vertical);
    dock.raise();
    QTest::qWait(isCloud ? 1000 : 400);
    if (auto *const plots = dock.findChild<PlotsPanel *>()) {
        QTest::qWait(2000); // rates are those of a second
        plots->board().time().setCursor(-3.2);
        QTest::qWait(200);
    }
    const QString file =
        QString("%1/desktop-%2%3.png")
            .arg(Screenshots::arguments[1], dock.objectName(), Screenshots::arguments.value(2));
    QVERIFY2(window.grab().save(file), qPrintable(file));
    if (isCloud)
        window.resizeDocks({&dock}, {220}, Qt::Vertical);
}

/// Somebody stops the robot and releases it, then a daemon is killed.
static void letSomethingHappen(RobotProcesses &robot) {
    Client anna;
    anna.connectTo(QString("127.0.0.1:%1").arg(robot.port("motorcontrol")));
    QTRY_VERIFY(anna.isConnected());
    const QJsonObject name{{"client", "anna on laptop7"}};
    QVERIFY(anna.callAndWait("motor.estop", name).ok());
    QTest::qWait(1200);
    QVERIFY(releaseStop(anna, name));
    QTest::qWait(1200);
    robot.kill("velodynelogger");
    QTest::qWait(2000);
}

void Screenshots::all() {
    if (arguments.value(4) == "setup")
        return;
    RobotProcesses robot;
    robot.startAll();
    Fleet fleet;
    robot.connectTo(fleet);
    DriveControl drive(fleet);
    MainWindow window(fleet, drive, {});
    resize(window);
    fleet.choose(fleet.robot()->withName("scanmatcher"));
    plot(window);
    const auto drives = [&drive] { // what was refused at first, is until one lets go
        drive.steer("pictures", {}, false);
        QTest::qWait(200);
        drive.steer("pictures", {1, 0, 0.35}, true);
        QTest::qWait(1500);
        return drive.measured().vx > 0.1;
    };
    QVERIFY(QTest::qWaitFor(drives, 20000));
    QTest::qWait(qEnvironmentVariable("HERMES_PICTURE_S", "8").toInt() *
                 1000); // so that there is a map to see
    for (auto *const dock : window.findChildren<QDockWidget *>())
        if (isWanted(dock->objectName()) && dock->objectName() != "setup" && dock->objectName() != "events")
            take(window, *dock);
    if (!isWanted("events"))
        return;
    letSomethingHappen(robot);
    take(window, *window.findChild<QDockWidget *>("events"));
}

/// A robot that nobody has set up yet.
void Screenshots::setup() {
    if (!isWanted("setup"))
        return;
    RobotProcesses robot;
    const int lidar = reservePort();
    robot.start("simulator",
                {"world=" + qEnvironmentVariable("HERMES_SOURCE") + "/deploy/worlds/pillars.json",
                 "motors.link=" + robot.path("motors"), "gps.link=" + robot.path("gps"),
                 QString("lidar.port=%1").arg(lidar)});
    robot.startSupervisor({robot.path("motors"), robot.path("gps")}, lidar);
    Fleet fleet;
    robot.connectTo(fleet);
    DriveControl drive(fleet);
    MainWindow window(fleet, drive, {});
    resize(window);
    auto *const dock = window.findChild<QDockWidget *>("setup");
    dock->raise();
    const auto button = [dock](const char *name) { return dock->findChild<QAbstractButton *>(name); };
    QTRY_VERIFY(button("findDevices")->isEnabled());
    button("ask")->setChecked(true);
    button("findDevices")->click();
    QTRY_VERIFY_WITH_TIMEOUT(button("applySetup")->isEnabled(), 30000);
    take(window, *dock);
}

int main(int argc, char **argv) {
    QCoreApplication::setAttribute(Qt::AA_EnableHighDpiScaling); // as hermes-gui does
    QCoreApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);
    QApplication application(argc, argv);
    theme::apply();
    Screenshots::arguments = QApplication::arguments();
    if (argc < 2) {
        std::fprintf(stderr, "screenshots FOLDER [SUFFIX [WIDTHxHEIGHT [DOCK]]]\n");
        return 2;
    }
    QDir().mkpath(Screenshots::arguments[1]);
    Screenshots screenshots;
    return QTest::qExec(&screenshots, {argv[0]});
}

#include "screenshots.moc"
