#include "gui/desktop/panels/CloudPanel.h"
#include "gui/desktop/panels/MapPanel.h"
#include "gui/desktop/view/CloudView.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/LoopWatch.h"

#include <QMenuBar>
#include <QToolButton>

using namespace hermes;
using namespace hermes::desktop;

namespace {

/// An application that remembers which event took longest, and whom it was for.
class WatchedApplication : public QApplication {
public:
    using QApplication::QApplication;
    bool notify(QObject *receiver, QEvent *event) override {
        if (depth_ > 0)
            return QApplication::notify(receiver, event);
        const QByteArray name = QByteArray(receiver->metaObject()->className()) + ' ' +
                                receiver->objectName().toUtf8() + ", event " +
                                QByteArray::number(event->type());
        QElapsedTimer time;
        time.start();
        ++depth_;
        const bool done = QApplication::notify(receiver, event);
        --depth_;
        if (const double ms = double(time.nsecsElapsed()) * 1e-6; ms > longest_ms) {
            longest_ms = ms;
            longest = name;
        }
        return done;
    }

    double longest_ms = 0;
    QByteArray longest;

private:
    int depth_ = 0;
};

double resident_mb() {
    QFile status("/proc/self/status");
    if (status.open(QIODevice::ReadOnly))
        for (const QByteArray &line : status.readAll().split('\n'))
            if (line.startsWith("VmRSS:"))
                return line.mid(6).trimmed().split(' ')[0].toDouble() * 1024 / 1e6;
    return 0;
}

QByteArray load() {
    QFile file("/proc/loadavg");
    return file.open(QIODevice::ReadOnly) ? file.readAll().split(' ').value(0) : QByteArray();
}

} // namespace

/// An operator's hour: drives, maps, looks, records and stops with real keys and a real mouse, on a display
/// with a window manager. HERMES_MINUTES: how long, one by default. Neither memory nor the event loop may
/// show it.
class TestLongDrive : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase();
    void drivesAndLooks();

private:
    struct Doing {
        const char *name;
        std::function<void()> begin;
        int time_ms;
    };

    /// The hands of another process: words of xdotool, one after the other.
    static void hands(const QString &words) { QProcess::startDetached("xdotool", words.split(' ')); }
    static QString at(const QWidget *widget, double x = 0.5, double y = 0.5) {
        const QPoint point = widget->mapToGlobal(QPoint(int(x * widget->width()), int(y * widget->height())));
        return QString("mousemove %1 %2").arg(point.x()).arg(point.y());
    }
    void click(const char *name);
    void lookAround();
    bool eventFilter(QObject *watched, QEvent *event) override;
    std::vector<Doing> doings();
    void report(int minute);

    std::unique_ptr<RobotProcesses> robot_;
    std::unique_ptr<OpenWindow> open_;
    CloudView *cloud_ = nullptr;
    int frames_ = 0;         // of the cloud
    double leastRate_ = 1e9; // frames a second while it is turned
    double longest_ms_ = 0, longestCpu_ms_ = 0;
    int over50_ = 0, turns_ = 0;
    double driven_m_ = 0;
};

void TestLongDrive::initTestCase() {
    if (QGuiApplication::platformName() != "xcb")
        QSKIP("needs a display: tests/gui/desktop/with_display");
    robot_ = std::make_unique<RobotProcesses>();
    robot_->startAllWithGps();
    open_ = std::make_unique<OpenWindow>(*robot_);
    open_->window.resize(1280, 800);
    QVERIFY(open_->show());
    cloud_ = open_->window.findChild<CloudView *>();
    QVERIFY(cloud_);
    cloud_->installEventFilter(this);
    QTRY_VERIFY_WITH_TIMEOUT(open_->drive.isPossible(), 10000);
    QTRY_VERIFY_WITH_TIMEOUT(open_->window.map().model().pose(), 20000);
}

bool TestLongDrive::eventFilter(QObject *watched, QEvent *event) {
    frames_ += watched == cloud_ && event->type() == QEvent::Paint;
    return false;
}

/// At a button of the window, if it can be pressed.
void TestLongDrive::click(const char *name) {
    auto *const button = open_->window.findChild<QAbstractButton *>(name);
    if (button && button->isEnabled() && !button->visibleRegion().isEmpty())
        hands(at(button) + " click 1");
}

/// Turns the cloud by the mouse, two seconds of it.
void TestLongDrive::lookAround() {
    QString words = at(cloud_, 0.3) + " mousedown 1";
    for (int i = 0; i < 130; ++i)
        words +=
            ' ' + at(cloud_, 0.5 + 0.2 * std::cos(0.1 * i), 0.5 + 0.1 * std::sin(0.1 * i)) + " sleep 0.013";
    hands(words + " mouseup 1");
}

std::vector<TestLongDrive::Doing> TestLongDrive::doings() {
    const QWidget *const map = open_->window.centralWidget();
    const auto key = [](const char *words) { return [words] { hands(words); }; };
    const char *const left = "keydown w keydown q sleep 7 keyup q keyup w";
    const char *const right = "keydown w keydown e sleep 7 keyup e keyup w";
    return {
        {"plots", key("key ctrl+5"), 500},
        {"a suggestion of plots", [this] { click("suggestion"); }, 500},
        {"drive to the left", key(left), 7500},
        {"cloud", key("key ctrl+0"), 1000},
        {"turn the cloud", [this] { lookAround(); }, 3000},
        {"drive to the right", key(right), 3000},
        {"turn the cloud while it drives", [this] { lookAround(); }, 4500},
        {"zoom the map",
         [map] { hands(at(map) + " click --repeat 8 --delay 60 4 click --repeat 8 --delay 60 5"); }, 2000},
        {"move the map",
         [map] {
             hands(at(map) + " mousedown 1 " + at(map, 0.3, 0.3) + " sleep 0.1 " + at(map, 0.7, 0.6) +
                   " mouseup 1");
         },
         1000},
        {"all of the map", key("key 0"), 500},
        {"recordings", key("key ctrl+7"), 500},
        {"record", [this] { click("record"); }, 2000},
        {"mark", key("key ctrl+m"), 1000},
        {"drive while it records", key(left), 7500},
        {"end the recording", [this] { click("record"); }, 3000},
        {"menus",
         key("key F10 sleep 0.2 key Right sleep 0.2 key Right sleep 0.2 key Right sleep 0.2 key Escape key "
             "Escape"),
         2000},
        {"save the map", key("key F10 sleep 0.2 key Right sleep 0.2 key s"), 2000},
        {"help", key("key F1 sleep 1 key Escape"), 2500},
        {"STOP", key("key F12"), 2000},
        {"release", [this] { click("release"); }, 1000},
        {"log", key("key ctrl+4"), 1000},
        {"events", key("key ctrl+9"), 1000},
        {"settings", key("key ctrl+2"), 1000},
        {"commands", key("key ctrl+3"), 1000},
        {"daemons", key("key ctrl+1"), 1000},
        {"setup", key("key ctrl+8"), 1000},
        {"smaller", [this] { hands(QString("windowsize %1 1024 600").arg(open_->window.winId())); }, 1500},
        {"larger", [this] { hands(QString("windowsize %1 1280 800").arg(open_->window.winId())); }, 1500},
        {"drive by the panel", key("key ctrl+6"), 500},
        {"drive to the right once more", key(right), 7500},
    };
}

void TestLongDrive::report(int minute) {
    const MapModel &model = open_->window.map().model();
    qInfo("minute %d: %.1f MB, longest turn %.1f ms (processor %.1f), %d over 50 ms, least %.0f frames/s of "
          "the "
          "cloud, %.0f m driven, %d edges, %d key scans, load %s",
          minute, resident_mb(), longest_ms_, longestCpu_ms_, over50_, leastRate_, driven_m_,
          model.edges().size(), model.graph().size(), load().constData());
}

void TestLongDrive::drivesAndLooks() {
    const int minutes = std::max(1, qEnvironmentVariableIntValue("HERMES_MINUTES"));
    auto &application = static_cast<WatchedApplication &>(*qApp);
    const MapModel &model = open_->window.map().model();
    std::optional<Pose2D> last;
    connect(&model, &MapModel::changed, this, [&] {
        if (last && model.pose())
            driven_m_ += std::hypot(model.pose()->x - last->x, model.pose()->y - last->y);
        last = model.pose();
    });
    const std::vector<Doing> all = doings();
    LoopWatch watch;
    QElapsedTimer time;
    time.start();
    double settled_mb = 0;
    int stops = 0, minute = 0;
    for (std::size_t next = 0; time.elapsed() < 60000LL * minutes; next = (next + 1) % all.size()) {
        const Doing &doing = all[next];
        const int framesBefore = frames_;
        watch.restart();
        application.longest_ms = 0;
        doing.begin();
        QElapsedTimer since;
        since.start();
        QTest::qWait(doing.time_ms);
        ++turns_;
        const double wall = watch.longest_ms(), cpu = watch.longestCpu_ms();
        if (wall > 50) {
            ++over50_;
            qInfo("%s: a turn of %.1f ms (processor %.1f); the longest event %.1f ms: %s; load %s",
                  doing.name, wall, cpu, application.longest_ms, application.longest.constData(),
                  load().constData());
        }
        longest_ms_ = std::max(longest_ms_, wall);
        longestCpu_ms_ = std::max(longestCpu_ms_, cpu);
        if (QByteArray(doing.name).startsWith("turn the cloud"))
            leastRate_ =
                std::min(leastRate_, (frames_ - framesBefore) / 1.9); // of 130 times 13 ms and their way
        stops += open_->drive.isStopped() && doing.name == QByteArray("STOP");
        // Plots keep ten minutes, and what is drawn or listed has been by then.
        if (settled_mb == 0 && time.elapsed() > std::min(60000LL * minutes / 2, 12LL * 60000))
            settled_mb = resident_mb();
        if (int(time.elapsed() / 60000) > minute)
            report(++minute);
    }
    const double growth = resident_mb() / settled_mb - 1;
    qInfo("figure memory grew: %.1f %% of %.1f MB", 100 * growth, settled_mb);
    qInfo("figure longest turn: %.1f ms, of the processor %.1f ms", longest_ms_, longestCpu_ms_);
    qInfo("figure turns over 50 ms: in %d of %d doings", over50_, turns_);
    qInfo("figure frames of the cloud: %.0f a second at least", leastRate_);
    QVERIFY2(driven_m_ > 3 * minutes, qPrintable(QString("%1 m").arg(driven_m_)));
    QVERIFY(stops >= minutes / 2);
    QVERIFY(model.edges().size() > 10);
    QVERIFY(leastRate_ >= 10);
    QVERIFY2(longestCpu_ms_ < 50, qPrintable(QString::number(longestCpu_ms_)));
    if (minutes >= 10)
        QVERIFY2(growth < 0.05, qPrintable(QString::number(growth)));
}

int main(int argc, char **argv) {
    WatchedApplication application(argc, argv);
    TestLongDrive test;
    return QTest::qExec(&test, argc, argv);
}
#include "TestLongDrive.moc"
