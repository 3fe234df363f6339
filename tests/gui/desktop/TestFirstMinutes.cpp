#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/view/PlotPane.h"
#include "tests/gui/desktop/OpenWindow.h"

#include "common/client/DaemonAddress.h"

using namespace hermes;

/// The first minutes of somebody who has never seen the window, with a real mouse and real keys on a display
/// with a window manager: how many actions (a click, a double click, a key) it takes to come to something.
class TestFirstMinutes : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        if (QGuiApplication::platformName() != "xcb")
            QSKIP("needs a display: tests/gui/desktop/with_display");
        robot_ = std::make_unique<RobotProcesses>();
        robot_->startAll();
        robot_->startRecorder();
        const QString supervisor = QString("127.0.0.1:%1").arg(robot_->supervise("rover"));
        open_ =
            std::make_unique<OpenWindow>(); // as `hermes-gui` does, which finds the daemons of this computer
        QVERIFY(open_->fleet.add(supervisor).ok());
        QVERIFY(open_->show());
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.isPossible(), 10000);
        QTRY_VERIFY_WITH_TIMEOUT(open_->window.map().model().pose(), 20000);
    }

    void init() { actions_ = 0; }

    void driveInThree() {
        const MapModel &model = open_->window.map().model();
        const Pose2D begin = *model.pose();
        click(middleOf(*open_->window.centralWidget())); // into the window
        act("keydown w");
        QTRY_VERIFY_WITH_TIMEOUT(std::hypot(model.pose()->x - begin.x, model.pose()->y - begin.y) > 0.2,
                                 10000);
        act("keyup w");
        QTRY_VERIFY(!open_->drive.isDriving());
        QVERIFY2(actions_ <= 3, saying(actions_));
    }

    void plotInTwo() {
        auto *const panel = open_->window.findChild<PlotsPanel *>();
        clickTab("Plots");
        const auto suggestion = [panel]() -> const QPushButton * {
            for (const auto *const button : panel->findChildren<QPushButton *>("suggestion"))
                if (!button->visibleRegion().isEmpty())
                    return button;
            return nullptr;
        };
        QTRY_VERIFY_WITH_TIMEOUT(suggestion(), 10000);
        click(middleOf(*suggestion()));
        QTRY_VERIFY(panel->board().curves() > 0);
        const PlotPane *const pane = panel->board().panes()[0];
        QTRY_VERIFY(!pane->visibleRegion().isEmpty());
        TRY_CONTAINS(pane->valueText(0), QRegularExpression("[0-9]"));
        QCOMPARE(actions_, 2);
    }

    void savedMapInTwo() {
        QCOMPARE(maps(), QStringList());
        const QMenuBar *const bar = open_->window.menuBar();
        auto *const menu = open_->window.findChild<QMenu *>("map");
        click(bar->mapToGlobal(bar->actionGeometry(menu->menuAction()).center()));
        QTRY_VERIFY(menu->isVisible() && QTest::qWaitForWindowExposed(menu));
        click(menu->mapToGlobal(menu->actionGeometry(menu->findChild<QAction *>("saveMap")).center()));
        QTRY_COMPARE_WITH_TIMEOUT(maps().size(), 1, 10000);
        QCOMPARE(actions_, 2);
    }

    void replayInThree() {
        QTRY_VERIFY_WITH_TIMEOUT(open_->fleet.robot()->withMethod("session.start"), 10000);
        DaemonLink *const recorder = open_->fleet.robot()->withMethod("session.start");
        int answers = 0;
        const auto answered = [&answers](const Result<QJsonValue> &answer) { answers += answer.ok(); };
        recorder->call("session.start", {{"name", "yesterday"}}, this, answered);
        QTRY_COMPARE(answers, 1);
        const auto isTold = [this] { // on the tab, whatever lies before it
            return open_->window.findChild<QDockWidget *>("recordings")
                ->windowTitle()
                .contains(QChar(0x25cf));
        };
        QTRY_VERIFY(isTold());
        const auto *const amount = open_->window.findChild<QLabel *>("amount");
        TRY_CONTAINS(amount->text(), QRegularExpression(": [2-9] s"));
        recorder->call("session.stop", {}, this, answered);
        QTRY_COMPARE_WITH_TIMEOUT(answers, 2, 10000);

        clickTab("Recordings");
        const auto *const list = open_->window.findChild<QTreeWidget *>("sessions");
        QVERIFY(list);
        QTRY_VERIFY_WITH_TIMEOUT(list->topLevelItemCount() == 1 && !list->visibleRegion().isEmpty(), 10000);
        QTRY_VERIFY(
            open_->window.findChild<QPushButton *>("replay")->isEnabled()); // it has seen that it ended
        QVERIFY(!isTold());
        click(list->viewport()->mapToGlobal(list->visualItemRect(list->topLevelItem(0)).center()),
              "click --repeat 2 --delay 80 1");
        QTRY_VERIFY_WITH_TIMEOUT(isReplaying(), 10000);
        QVERIFY2(actions_ <= 3, saying(actions_));
    }

private:
    /// The hands of another process: words of xdotool.
    void act(const QString &words) {
        ++actions_;
        QProcess::startDetached("xdotool", words.split(' '));
    }
    void click(QPoint place, const char *how = "click 1") {
        act(QString("mousemove %1 %2 %3").arg(place.x()).arg(place.y()).arg(how));
    }
    static QPoint middleOf(const QWidget &widget) { return widget.mapToGlobal(widget.rect().center()); }

    void clickTab(const QString &text) {
        for (const QTabBar *const bar : open_->window.findChildren<QTabBar *>())
            for (int i = 0; i < bar->count(); ++i)
                if (bar->isVisible() && bar->tabText(i).startsWith(text))
                    return click(bar->mapToGlobal(bar->tabRect(i).center()));
        QFAIL(qPrintable("no tab " + text));
    }

    QStringList maps() const { return QDir(robot_->path("maps")).entryList({"*.csv"}, QDir::Files); }
    bool isReplaying() const { return open_->drive.sessions().isReplaying(); }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> open_;
    int actions_ = 0;
};
