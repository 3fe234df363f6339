#include "gui/desktop/panels/CloudPanel.h"
#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/view/CloudView.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/gui/desktop/ProcessFigures.h"
#include "tests/gui/desktop/TurnedFrames.h"
#include "tests/gui/desktop/WatchedApplication.h"
#include "tests/support/LoopWatch.h"

#include <QMenuBar>

using namespace hermes;
using namespace hermes::desktop;

/// An operator's hour: drives, maps, looks, records and stops with real keys and a real mouse, on a display
/// with a window manager. HERMES_MINUTES: how long; a few seconds by default. Neither memory nor the event
/// loop may show it, and each thing that is done must be seen to have happened.
class TestLongDrive : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        if (QGuiApplication::platformName() != "xcb")
            QSKIP("needs a display: tests/gui/desktop/with_display");
        robot_ = std::make_unique<RobotProcesses>();
        robot_->startAllWithGps();
        robot_->startRecorder();
        open_ = std::make_unique<OpenWindow>(*robot_);
        open_->window.resize(1280, 800);
        QVERIFY(open_->show());
        cloud_ = open_->window.findChild<CloudView *>();
        QVERIFY(cloud_);
        turned_ = std::make_unique<TurnedFrames>(cloud_);
        open_->window.map().view().installEventFilter(this);
        QTRY_VERIFY_WITH_TIMEOUT(open_->drive.isPossible(), 10000);
        QTRY_VERIFY_WITH_TIMEOUT(open_->window.map().model().pose(), 20000);
    }

    void drivesAndLooks() {
        const int minutes = qEnvironmentVariableIntValue("HERMES_MINUTES");
        const qint64 whole_ms = minutes > 0 ? 60000LL * minutes : 17000;
        const MapModel &model = open_->window.map().model();
        std::optional<Pose2D> last;
        const auto measuring = connect(&model, &MapModel::changed, this, [&] {
            if (last && model.pose())
                driven_m_ += std::hypot(model.pose()->x - last->x, model.pose()->y - last->y);
            last = model.pose();
        });
        std::vector<Doing> all = doings();
        addPanels(all);
        addSizes(all);
        all.push_back({"nothing", [] {}, 5000, {}});
        if (const QRegularExpression only(qEnvironmentVariable("HERMES_DOINGS")); !only.pattern().isEmpty())
            all.erase(std::remove_if(all.begin(), all.end(),
                                     [&](const Doing &one) { return !only.match(one.name).hasMatch(); }),
                      all.end()); // to find out which of them costs
        LoopWatch watch;
        QElapsedTimer time;
        time.start();
        double settled_mb = 0;
        int minute = 0;
        const auto isMeasured = [&] { return leastRate_ < 1e9 || time.elapsed() > 5 * whole_ms; };
        for (std::size_t next = 0; time.elapsed() < whole_ms || !isMeasured();
             next = (next + 1) % all.size()) {
            perform(all[next], watch);
            // Plots keep ten minutes, and what is drawn or listed has been by then.
            if (settled_mb == 0 && time.elapsed() > std::min(whole_ms / 2, 12LL * 60000))
                settled_mb = resident_mb();
            if (int(time.elapsed() / 60000) > minute)
                report(++minute);
        }
        disconnect(measuring);
        judge(all);
        const double growth = resident_mb() / settled_mb - 1;
        qInfo("figure memory grew: %.1f %% of %.1f MB", 100 * growth, settled_mb);
        if (minutes >= 10)
            QVERIFY2(growth < 0.05, qPrintable(QString::number(growth)));
    }

private:
    struct Doing {
        const char *name;
        std::function<void()> begin;
        int time_ms;
        std::function<bool()> isDone; // afterwards
        int times = 0, done = 0;
    };

    // A circle each: the robot stays where it is free.
    static constexpr char leftCircle[] = "keydown w keydown q sleep 10.4 keyup q keyup w";
    static constexpr char rightCircle[] = "keydown w keydown e sleep 10.4 keyup e keyup w";

    /// The hands of another process: words of xdotool, one after the other.
    static void hands(const QString &words) { QProcess::startDetached("xdotool", words.split(' ')); }
    static QString at(const QWidget *widget, double x = 0.5, double y = 0.5) {
        const QPoint point = widget->mapToGlobal(QPoint(int(x * widget->width()), int(y * widget->height())));
        return QString("mousemove %1 %2").arg(point.x()).arg(point.y());
    }

    /// At the button of that name that is in sight and can be pressed.
    void click(const char *name) {
        for (const auto *const button : open_->window.findChildren<QAbstractButton *>(name))
            if (button->isEnabled() && !button->visibleRegion().isEmpty())
                return hands(at(button) + " click 1");
    }

    void chooseFromMenu(const char *name, const char *actionName) {
        QMenuBar *const bar = open_->window.menuBar();
        auto *const menu = open_->window.findChild<QMenu *>(name);
        const QPoint title = bar->mapToGlobal(bar->actionGeometry(menu->menuAction()).center());
        hands(QString("mousemove %1 %2 click 1").arg(title.x()).arg(title.y()));
        QTimer::singleShot(500, menu, [menu, actionName] { // it is open, or this goes nowhere
            auto *const action = menu->findChild<QAction *>(actionName);
            if (!menu->isVisible() || !action)
                return;
            const QPoint place = menu->mapToGlobal(menu->actionGeometry(action).center());
            hands(QString("mousemove %1 %2 click 1").arg(place.x()).arg(place.y()));
        });
    }

    /// Turns the cloud by the mouse, two seconds of it.
    void lookAround() {
        QString words = at(cloud_, 0.3) + " mousedown 1";
        for (int i = 0; i < 130; ++i)
            words += ' ' + at(cloud_, 0.5 + 0.2 * std::cos(0.1 * i), 0.5 + 0.1 * std::sin(0.1 * i)) +
                     " sleep 0.013";
        hands(words + " mouseup 1");
    }

    bool isInFront(const char *dock) const {
        const QWidget *const content = open_->window.findChild<QDockWidget *>(dock)->widget();
        const QWidget *const seen = QApplication::widgetAt(content->mapToGlobal(content->rect().center()));
        return seen && (seen == content || content->isAncestorOf(seen));
    }

    int recordings() const { return QDir(robot_->path("recordings")).entryList({"2*"}, QDir::Dirs).size(); }

    bool isMapSaved() const {
        const QDir maps(robot_->path("maps"));
        return maps.entryInfoList({"*.csv"}, QDir::Files, QDir::Time).value(0).lastModified() >= began_;
    }

    bool hasDriven() const { return driven_m_ > drivenBefore_m_ + 0.3; }
    bool hasShown() const { return static_cast<WatchedApplication *>(qApp)->shown > shownBefore_; }

    void addPanels(std::vector<Doing> &all) {
        const std::pair<const char *, const char *> panels[]{
            {"log", "key ctrl+4"},      {"events", "key ctrl+9"},  {"settings", "key ctrl+2"},
            {"commands", "key ctrl+3"}, {"daemons", "key ctrl+1"}, {"setup", "key ctrl+8"}};
        for (const auto &[dock, words] : panels)
            all.push_back({dock, [words = words] { hands(words); }, 1000,
                           [this, dock = dock] { return isInFront(dock); }});
    }

    void addSizes(std::vector<Doing> &all) {
        const auto size = [this](int width, int height) {
            return [this, width, height] {
                hands(QString("windowsize %1 %2 %3").arg(open_->window.winId()).arg(width).arg(height));
            };
        };
        all.push_back({"smaller", size(1024, 600), 1500, [this] { return open_->window.width() < 1100; }});
        all.push_back({"larger", size(1280, 800), 1500, [this] { return open_->window.width() > 1200; }});
        all.push_back({"the default layout", [this] { chooseFromMenu("layoutMenu", "resetLayout"); }, 2000,
                       [this] { return hasShown(); }});
        all.push_back(
            {"drive by the panel", [] { hands("key ctrl+6"); }, 500, [this] { return isInFront("drive"); }});
        all.push_back({"drive to the right once more", [] { hands(rightCircle); }, 11000,
                       [this] { return hasDriven(); }});
    }

    void judge(const std::vector<Doing> &all) {
        const auto &application = static_cast<const WatchedApplication &>(*qApp);
        qInfo("figure longest turn: %.1f ms, of the processor %.1f ms", longest_ms_, longestCpu_ms_);
        qInfo("figure turns over 50 ms: in %d of %d doings", slowDoings_, doings_);
        qInfo("figure events over 50 ms: %d, of the processor %d", application.over50, application.over50Cpu);
        qInfo("figure frames of the cloud: %.0f a second at least", leastRate_);
        for (const Doing &doing : all) // a busy machine loses a key now and then
            QVERIFY2(4 * doing.done >= 3 * doing.times,
                     qPrintable(QString("%1: %2 of %3").arg(doing.name).arg(doing.done).arg(doing.times)));
        QVERIFY(open_->window.map().model().edges().size() > 10);
        QVERIFY2(leastRate_ >= 10 && leastRate_ < 1e9, qPrintable(QString::number(leastRate_)));
        QVERIFY2(longestCpu_ms_ < 50, qPrintable(QString::number(longestCpu_ms_)));
    }

    void perform(Doing &doing, LoopWatch &watch) {
        auto &application = static_cast<WatchedApplication &>(*qApp);
        shownBefore_ = application.shown;
        mapInputsBefore_ = mapInputs_;
        recordingsBefore_ = recordings();
        drivenBefore_m_ = driven_m_;
        began_ = QDateTime::currentDateTime();
        turned_->restart();
        application.longest_ms = 0;
        watch.restart();
        doing.begin();
        QTest::qWait(doing.time_ms);
        const double wall = watch.longest_ms(), cpu = watch.longestCpu_ms();
        if (wall > 50)
            qInfo("%s: a turn of %.1f ms (processor %.1f); the longest event %.1f ms: %s; load %s",
                  doing.name, wall, cpu, application.longest_ms, application.longest.constData(),
                  load().constData());
        ++doings_;
        slowDoings_ += wall > 50;
        longest_ms_ = std::max(longest_ms_, wall);
        longestCpu_ms_ = std::max(longestCpu_ms_, cpu);
        if (turned_->time_s() > 1)
            leastRate_ = std::min(leastRate_, turned_->perSecond());
        const bool isDone = !doing.isDone || doing.isDone();
        if (!isDone)
            qInfo("%s: not seen to have happened", doing.name);
        ++doing.times;
        doing.done += isDone;
    }

    bool eventFilter(QObject *, QEvent *event) override {
        mapInputs_ += event->type() == QEvent::MouseButtonRelease || event->type() == QEvent::Wheel;
        return false;
    }

    std::vector<Doing> doings() {
        const QWidget *const map = &open_->window.map().view();
        const auto key = [](const char *words) { return [words] { hands(words); }; };
        const auto front = [this](const char *dock) { return [this, dock] { return isInFront(dock); }; };
        const auto driven = [this] { return hasDriven(); };
        const auto turned = [this] { return turned_->time_s() > 1; };
        const auto moved = [this] { return mapInputs_ > mapInputsBefore_; };
        const auto shown = [this] { return hasShown(); };
        return {
            {"plots", key("key ctrl+5"), 500, front("plots")},
            {"a suggestion of plots", [this] { click("suggestion"); }, 500,
             [this] { return !open_->window.findChild<QWidget *>("suggestions")->isVisible(); }},
            {"drive to the left", key(leftCircle), 11000, driven},
            {"cloud", key("key ctrl+0"), 1000, front("cloud")},
            {"turn the cloud", [this] { lookAround(); }, 3000, turned},
            {"drive to the right", key(rightCircle), 3000, driven},
            {"turn the cloud while it drives", [this] { lookAround(); }, 8000, turned},
            {"zoom the map",
             [map] { hands(at(map) + " click --repeat 8 --delay 60 4 click --repeat 8 --delay 60 5"); }, 2000,
             moved},
            {"move the map",
             [map] {
                 hands(at(map) + " mousedown 1 " + at(map, 0.3, 0.3) + " sleep 0.1 " + at(map, 0.7, 0.6) +
                       " mouseup 1");
             },
             1000, moved},
            {"all of the map", key("key 0"), 500, {}},
            {"recordings", key("key ctrl+7"), 500, front("recordings")},
            {"record", [this] { click("record"); }, 2000,
             [this] { return recordings() > recordingsBefore_; }},
            {"mark", key("key ctrl+m"), 1000, {}},
            {"drive while it records", key(leftCircle), 11000, driven},
            {"end the recording", [this] { click("record"); }, 3000, {}},
            {"save the map",
             [this] {
                 chooseFromMenu("map", "saveMap");
                 QTimer::singleShot(1500, this, [this] { click("accept"); }); // where it is to replace one
             },
             3000, [this] { return isMapSaved(); }},
            {"a menu", [this] { chooseFromMenu("viewMenu", "none"); }, 1000, shown},
            {"no menu", key("key Escape"), 500, [] { return !QApplication::activePopupWidget(); }},
            {"help", key("key F1 sleep 1 key Escape"), 2500, shown},
            {"STOP", key("key F12"), 2000, [this] { return open_->drive.isStopped(); }},
            {"release", [this] { click("release"); }, 1000, [this] { return !open_->drive.isStopped(); }},
        };
    }

    void report(int minute) {
        const MapModel &model = open_->window.map().model();
        const auto &application = static_cast<const WatchedApplication &>(*qApp);
        const Pose2D pose = model.pose() ? *model.pose() : Pose2D{};
        qInfo("minute %d: %.1f MB (%.3f MB of the heap), longest turn %.1f ms (processor %.1f), events over "
              "50 ms: "
              "%d (processor %d), "
              "least %.0f frames/s of the cloud, %.0f m driven, at %.2f %.2f m, %d edges, %d key scans, %d "
              "doings, "
              "load %s",
              minute, resident_mb(), heap_mb(), longest_ms_, longestCpu_ms_, application.over50,
              application.over50Cpu, leastRate_, driven_m_, pose.x, pose.y, model.edges().size(),
              model.graph().size(), doings_, load().constData());
    }

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> open_;
    CloudView *cloud_ = nullptr;
    std::unique_ptr<TurnedFrames> turned_;                             // of the cloud
    double leastRate_ = 1e9;                                           // frames a second while it is turned
    int mapInputs_ = 0;                                                // wheel and mouse over the map
    int mapInputsBefore_ = 0, shownBefore_ = 0, recordingsBefore_ = 0; // this doing
    double drivenBefore_m_ = 0;
    QDateTime began_;
    double longest_ms_ = 0, longestCpu_ms_ = 0;
    int slowDoings_ = 0, doings_ = 0;
    double driven_m_ = 0;
};

int main(int argc, char **argv) {
    WatchedApplication application(argc, argv);
    TestLongDrive test;
    return QTest::qExec(&test, argc, argv);
}
#include "TestLongDrive.moc"
