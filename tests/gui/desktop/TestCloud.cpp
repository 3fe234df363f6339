#include "gui/desktop/Theme.h"
#include "tests/gui/desktop/CloudSession.h"
#include "tests/gui/desktop/HostileRows.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

static void drag(QWidget &view, Qt::MouseButton button, QPoint way) {
    const QPoint from = view.rect().center();
    QTest::mousePress(&view, button, {}, from);
    QMouseEvent move(QEvent::MouseMove, from + way, Qt::NoButton, button, {});
    QApplication::sendEvent(&view, &move);
    QTest::mouseRelease(&view, button, {}, from + way);
}

/// The lidar's cloud in the window: of a simulated lidar, and of daemons that send nonsense.
class TestCloud : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void cloudOfTheSimulator() {
        RobotProcesses robot;
        robot.startAll();
        OpenWindow open(robot);
        QVERIFY(open.show());
        auto *const panel = open.panel<CloudPanel>("cloud");
        const CloudModel &model = panel->model();
        QTRY_VERIFY_WITH_TIMEOUT(model.points().size() > 3000, 20000);
        QVERIFY2(std::abs(model.lowest_m() + 0.5) < 0.35, saying(model.lowest_m()));
        for (const CloudPoint &point : model.points()) // of a hall of 9.4 m x 7.5 m
            QVERIFY(std::hypot(point.x, point.y) < 13 && point.z > -0.7F);
        const QString summary = panel->findChild<QLabel *>("cloudSummary")->text();
        QVERIFY2(QRegularExpression("^HDL-32E: \\d{4} points of \\d{5} beams$").match(summary).hasMatch(),
                 qPrintable(summary));
        QTRY_VERIFY(colouredPixels(panel->view()) > 300);
        QTRY_VERIFY(model.age().isFresh());
        const auto first = panel->view().scene().revision();
        QTRY_VERIFY(panel->view().scene().revision() > first + 5); // it goes on

        LoopWatch watch;
        QTest::qWait(2000);
        figure("event loop busy at most, the cloud of the simulator is shown", watch.longestCpu_ms(),
               "ms of the processor");
        robot.signal("velodynelogger", SIGSTOP);
        QTRY_VERIFY_WITH_TIMEOUT(!model.age().isFresh(), 2000);
        QTRY_COMPARE(colouredPixels(panel->view()), 0);
        robot.signal("velodynelogger", SIGCONT);
        QTRY_VERIFY_WITH_TIMEOUT(model.age().isFresh() && colouredPixels(panel->view()) > 300, 20000);
    }

    void subscribedToOnlyInSight() {
        FakeDaemon daemon{Mischief{}};
        OpenWindow open;
        QVERIFY(open.show());
        QVERIFY(open.fleet.add(daemon.address()).ok());
        QTRY_VERIFY(daemon.subscriptions("pose") > 0);
        QTest::qWait(100);
        QCOMPARE(daemon.subscriptions("cloud"), 0);
        auto *const panel = open.panel<CloudPanel>("cloud");
        QTRY_COMPARE(daemon.subscriptions("cloud"), 1);
        daemon.say("cloud", cloudOf("[1]", "[2]", "[3]"));
        QTRY_COMPARE(panel->model().points().size(), std::size_t(1));
        open.window.findChild<QDockWidget *>("settings")->raise();
        QTRY_VERIFY(!panel->model().isEnabled());
        QTRY_VERIFY(daemon.calls("topics.unsubscribe") > 0);
        QVERIFY(panel->model().points().empty()); // it would be an old one
        open.window.findChild<QDockWidget *>("cloud")->raise();
        QTRY_COMPARE(daemon.subscriptions("cloud"), 2);
        open.window.findChild<QDockWidget *>("cloud")->close();
        QTRY_VERIFY(!panel->model().isEnabled());
    }

    void mouseAndKeys() {
        CloudSession s;
        s.daemon.say("cloud", cloudOf("[10,-10]", "[0,0]", "[0,0]"));
        QTRY_COMPARE(s.model().points().size(), std::size_t(2));
        CloudView &view = s.panel.view();
        const CloudCamera &camera = view.scene().camera;
        const double turn = camera.turn_deg(), lift = camera.lift_deg(), distance = camera.distance_m();
        drag(view, Qt::LeftButton, {50, 20});
        QVERIFY(camera.turn_deg() < turn && camera.lift_deg() > lift);
        QVERIFY(camera.point().isNull());
        drag(view, Qt::LeftButton, {0, 5000});
        QCOMPARE(camera.lift_deg(), 90.0);
        for (const auto button : {Qt::RightButton, Qt::MiddleButton}) {
            const QVector3D before = camera.point();
            drag(view, button, {30, 10});
            QVERIFY(camera.point() != before);
        }
        const QPoint here = view.rect().center();
        QWheelEvent wheel(here, view.mapToGlobal(here), {}, {0, 120}, Qt::NoButton, {}, Qt::NoScrollPhase,
                          false);
        QApplication::sendEvent(&view, &wheel);
        QVERIFY(camera.distance_m() < distance);
        OpenWindow::click(&s.panel, "resetCloud");
        QVERIFY(camera.point().isNull());
        QCOMPARE(camera.distance_m(), distance);
        QCOMPARE(camera.turn_deg(), turn);
        QTest::keyClick(&view, Qt::Key_Home);
        QTest::keyClick(&view, Qt::Key_PageUp);
        QTest::keyClick(&view, Qt::Key_Plus);
        QVERIFY(camera.turn_deg() != turn && camera.lift_deg() > lift && camera.distance_m() < distance);
        QTest::keyClick(&view, Qt::Key_End);
        QTest::keyClick(&view, Qt::Key_PageDown);
        QTest::keyClick(&view, Qt::Key_Minus);
        QVERIFY(std::abs(camera.distance_m() - distance) < 1e-9);
        QTest::keyClick(&view, Qt::Key_0);
        QCOMPARE(camera.lift_deg(), lift);
        // What is ahead of the robot is up, what is left of it is left.
        const QMatrix4x4 matrix = camera.matrix(view.size());
        QVERIFY(matrix.map(QVector3D(5, 0, 0)).y() > matrix.map(QVector3D(-5, 0, 0)).y());
        QVERIFY(matrix.map(QVector3D(0, 5, 0)).x() < matrix.map(QVector3D(0, -5, 0)).x());
        QVERIFY(matrix.map(QVector3D(0, 0, 1)).y() > matrix.map(QVector3D(0, 0, 0)).y());
    }

    void keysOfDrivingAreNotTaken() {
        CloudSession s;
        for (const int key :
             {Qt::Key_W, Qt::Key_A, Qt::Key_S, Qt::Key_D, Qt::Key_Q, Qt::Key_E, Qt::Key_Up, Qt::Key_Down,
              Qt::Key_Left, Qt::Key_Right, Qt::Key_Space, Qt::Key_Escape, Qt::Key_F12, Qt::Key_F}) {
            QKeyEvent press(QEvent::KeyPress, key, {});
            press.ignore();
            QApplication::sendEvent(&s.panel.view(), &press);
            QVERIFY2(!press.isAccepted(), qPrintable(QKeySequence(key).toString()));
        }
    }

    void onlyWhatMakesSenseIsShown_data() {
        const Rows<QByteArray, int> row("cloud", "points");
        row("good", cloudOf("[1,2]", "[1,2]", "[1,2]", "[3,4]", "[5,6]"), 2);
        row("lists of different lengths", cloudOf("[1,2,3]", "[1,2,3,4]", "[1]", "[]", "[1,2,3,4,5]"), 1);
        row("empty", cloudOf("[]", "[]", "[]"), 0);
        row("no number", cloudOf("[1,nan]", "[1,1]", "[1,1]"), -2);
        row("beyond all numbers", cloudOf("[1,1e300]", "[1,1]", "[1,1]"), -1);
        row("far away", cloudOf("[1,1e30,-1e30,1001]", "[1,1,1,1]", "[1,1,1,1]"), 1);
        row("all at one place", cloudOf(listOf("0", 1000), listOf("0", 1000), listOf("0", 1000)), 1000);
        row("many", cloudOf(listOf("1", 50000), listOf("2", 50000), listOf("3", 50000)), 50000);
        row("a text for a list", cloudOf("\"x\"", "[1]", "[1]"), -1);
        row("texts in a list", cloudOf("[\"x\"]", "[1]", "[1]"), -1);
        row("lists in a list", cloudOf("[[1]]", "[1]", "[1]"), -1);
        row("null", "null", -1);
        row("a number", "5", -1);
        row("no lists", R"({"turn":1,"stamp":1})", -1);
        row("an intensity beyond", cloudOf("[1]", "[1]", "[1]", "[70000]"), -1);
        row("ten million points", cloudOf(listOf("1", 10000000), "[1]", "[1]"), -2);
    }

    // points: -1: it is no cloud, -2: it is no message that can be read.
    void onlyWhatMakesSenseIsShown() {
        FETCH(QByteArray, cloud, int, points);
        CloudSession s;
        LoopWatch watch;
        s.daemon.say("cloud", cloud);
        watch.restart(); // the text was made here
        if (points >= 0) {
            QTRY_VERIFY(s.model().age().state() != Freshness::State::None);
            QCOMPARE(int(s.model().points().size()), points);
        } else if (points == -1) {
            QTRY_VERIFY(s.model().ignored() > 0);
            QVERIFY(s.model().points().empty());
        } else {
            DaemonLink *const link = s.fleet.robot()->daemons().front();
            QTRY_VERIFY_WITH_TIMEOUT(link->client().rejected().unreadable > 0, 20000);
            VERIFY_CONTAINS(link->reason(), "could not be read");
        }
        s.panel.view().repaint();
        QVERIFY2(watch.longestCpu_ms() < 50 * slowness, saying(watch.longestCpu_ms()));
        for (const CloudVertex &vertex : s.panel.view().scene().vertices())
            QVERIFY(std::abs(vertex.x) <= CloudModel::farthest_m);
    }

    void noNumbersAmongOthers() {
        Fleet fleet;
        CloudModel model(fleet);
        const float nan = std::numeric_limits<float>::quiet_NaN(),
                    inf = std::numeric_limits<float>::infinity();
        CloudMessage cloud;
        cloud.x = {1, nan, 1, 1};
        cloud.y = {1, 1, inf, 1};
        cloud.z = {1, 1, 1, -inf};
        model.take(cloud);
        QCOMPARE(model.points().size(), std::size_t(1));
        QCOMPARE(model.ignored(), quint64(3));
        cloud.x = cloud.y = cloud.z = {nan, nan};
        model.take(cloud);
        QVERIFY(model.points().empty());
        QVERIFY(model.lowest_m() < model.highest_m());
    }

    // The points of one lidar are not shown as those of another.
    void otherLidar() {
        CloudSession s;
        s.daemon.say("cloud", cloudOf("[1]", "[2]", "[3]").replace("HDL-32E", QByteArray(10000, 'W')));
        QTRY_COMPARE(s.model().points().size(), std::size_t(1));
        QVERIFY(s.summary().size() < 100);
        QVERIFY(s.fleet.add("127.0.0.2:1").ok());
        s.fleet.choose(s.fleet.robots().back().get());
        QTRY_VERIFY(s.model().points().empty());
        QCOMPARE(s.summary(), QString());
    }

    void agesAndSaysSo() {
        CloudSession s;
        auto *const summary = s.panel.findChild<QLabel *>("cloudSummary");
        s.daemon.say("cloud", cloudOf("[1,2]", "[2,3]", "[3,4]", "[1,2]", "[0,31]").replace("false", "true"));
        QTRY_COMPARE(s.summary(), QString("HDL-32E: 2 points of 3200 beams, replayed"));
        const QColor old = theme::colour(Condition::Unreachable);
        const auto isGrey = [&] {
            const auto colour = s.panel.view().scene().vertices().front().colour;
            return QColor(colour[0], colour[1], colour[2]) == old;
        };
        QVERIFY(!isGrey());
        QTRY_VERIFY_WITH_TIMEOUT(isGrey() && !summary->isEnabled(), 2000);
        QTRY_VERIFY_WITH_TIMEOUT(summary->font().strikeOut(), 5000);
        VERIFY_CONTAINS(s.summary(), "no data for ");
        s.daemon.say("cloud", cloudOf("[1]", "[2]", "[3]", "[1]", "[0]"));
        QTRY_VERIFY(!isGrey() && summary->isEnabled() && !summary->font().strikeOut());
    }
};
