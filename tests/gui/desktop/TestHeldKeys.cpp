#include "gui/desktop/panels/MapPanel.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/support/FakeRobot.h"

#include <QAbstractNativeEventFilter>
#include <QLibrary>

using namespace hermes;

/// A key that stays held while the keyboard repeats it drives only once: with real keys (xdotool) on a
/// display (with_display), whose releases between repeats are not always told to be repeats.
class TestHeldKeys : public QObject {
    Q_OBJECT

    /// Another program on the same display.
    class OtherProgram {
    public:
        OtherProgram()
            : display_(call<void *>("XOpenDisplay", static_cast<const char *>(nullptr))) {}
        ~OtherProgram() { call<int>("XCloseDisplay", display_); }
        void lockGroup(unsigned group) {
            constexpr unsigned coreKeyboard = 0x100;
            call<int>("XkbLockGroup", display_, coreKeyboard, group);
            call<int>("XSync", display_, 0);
        }
        bool grabKeyboard() {
            constexpr int async = 1;
            return call<int>("XGrabKeyboard", display_, call<unsigned long>("XDefaultRootWindow", display_),
                             0, async, async, 0UL) == 0;
        }

    private:
        template <typename Result, typename... Values>
        Result call(const char *name, Values... values) {
            return reinterpret_cast<Result (*)(Values...)>(QLibrary::resolve("X11", 6, name))(values...);
        }

        void *display_;
    };

    /// Loses each release of a key.
    class LostReleases : public QAbstractNativeEventFilter {
    public:
        LostReleases() { qApp->installNativeEventFilter(this); }
        bool nativeEventFilter(const QByteArray &type, void *message, long *) override {
            constexpr quint8 xInput = 35, release = 3;
            const auto *const bytes = static_cast<const quint8 *>(message);
            return type == "xcb_generic_event_t" &&
                   ((bytes[0] & 0x7f) == release || ((bytes[0] & 0x7f) == xInput && bytes[8] == release));
        }
    };

private Q_SLOTS:
    void initTestCase() {
        if (QGuiApplication::platformName() != "xcb")
            QSKIP("needs a display: tests/gui/desktop/with_display");
        QProcess::execute("xset", {"r", "rate", "200", "60"}); // where there is one; Xvfb repeats without it
        robot_ = std::make_unique<FakeRobot>();
        open_ = std::make_unique<OpenWindow>(robot_->address());
        QVERIFY(open_->show());
    }

    void cleanup() {
        letGo();
        if (open_)
            QTRY_VERIFY(!open_->drive.isDriving());
    }

    void drivesOnlyOnce_data() {
        const Rows<QString, bool> row("key", "isKilled");
        row("killed", "s", true);
        row("frozen", "Up", false);
        row("frozen, turning", "q", false);
    }

    void drivesOnlyOnce() {
        FETCH(QString, key, bool, isKilled);
        hold(key);
        awaitMotion();
        if (isKilled) {
            robot_->end();
            QTRY_VERIFY(!open_->drive.isPossible());
            QTRY_VERIFY(!open_->drive.isDriving());
            robot_->start();
            QTRY_VERIFY_WITH_TIMEOUT(open_->drive.isPossible(), 10000);
        } else {
            robot_->freeze();
            QTest::qWait(2000); // longer than the control lasts
            robot_->thaw();
        }
        staysAtRest(1500);
        if (!QTest::currentTestFailed())
            drivesAnew(key);
    }

    void refusedItDoesNotDriveLater() {
        const QString key = "Up";
        auto other = std::make_unique<ConnectedClient>(robot_->address());
        QVERIFY(
            other->callAndWait("control.acquire", QJsonObject{{"client", "patrol"}, {"timeout_s", 30}}).ok());
        hold(key);
        QTRY_VERIFY(open_->drive.problem().contains("patrol"));
        QTest::qWait(1000); // the keyboard repeats
        other.reset();      // which ends its control
        staysAtRest(1500);
        if (!QTest::currentTestFailed())
            drivesAnew(key);
    }

    // No release between two repeats stops the robot.
    void repeatsDriveEvenly() {
        hold("Up");
        awaitMotion();
        int stops = 0;
        const auto counting =
            connect(&open_->drive, &DriveControl::changed, this, [&] { stops += !open_->drive.isDriving(); });
        QTest::qWait(3000);
        disconnect(counting);
        QCOMPARE(stops, 0);
        letGo();
        auto sinceRelease = runningTimer();
        QTRY_VERIFY(!open_->drive.isDriving());
        qInfo("figure stopped %lld ms after the key", sinceRelease.elapsed());
    }

    void whatEndsTheHoldingEndsTheDrive_data() {
        const Rows<QString, QString> row("end", "reason");
        for (const char *const end : {"layout", "other letter", "group"})
            row(end, end, "layout of the keyboard");
        row("grab", "grab", QString());
        row("lost release", "lost release", "does not say that its key is held");
    }

    // Whatever becomes of the release: W has another place in the other layout.
    void whatEndsTheHoldingEndsTheDrive() {
        FETCH(QString, end, QString, reason);
        const QString key = "25"; // the key itself: W of the layout us
        QProcess::execute("setxkbmap", {end == "group" ? "us,fr" : "us"});
        OtherProgram other;
        const auto restore = qScopeGuard([&] {
            letGo();
            other.lockGroup(0);
            QProcess::execute("setxkbmap", {"us"});
        });
        QTRY_VERIFY(speed() < 0.02 && !open_->drive.mustLetGo());
        QTest::qWait(300); // a press sooner after a release would be a repeat
        hold(key);
        awaitMotion();
        QVERIFY(open_->drive.isDriving());
        std::optional<LostReleases> lost;
        if (end == "layout")
            QProcess::execute("setxkbmap", {"fr"});
        else if (end == "other letter") {
            QProcess::execute("setxkbmap", {"fr"});
            xdotool("keyup w");
        } else if (end == "group")
            other.lockGroup(1);
        else if (end == "grab") {
            QVERIFY(other.grabKeyboard());
            letGo();
        } else {
            lost.emplace();
            letGo();
        }
        QTRY_VERIFY(!open_->drive.isDriving());
        VERIFY_CONTAINS(open_->drive.problem(), reason);
    }

    void closesByCtrlQ() {
        QTest::mouseClick(&open_->window.map().view(), Qt::LeftButton);
        xdotool("key ctrl+q");
        QTRY_VERIFY(!open_->window.isVisible());
        open_->window.show();
    }

private:
    static void xdotool(const QString &words) { QProcess::execute("xdotool", words.split(' ')); }
    void hold(const QString &key) {
        QTest::mouseClick(&open_->window.map().view(), Qt::LeftButton);
        xdotool("keydown " + key);
        held_ = key;
    }
    void letGo() {
        if (!held_.isEmpty())
            xdotool("keyup " + std::exchange(held_, {}));
    }
    double speed() const {
        const Twist2D &measured = open_->drive.measured();
        return std::hypot(measured.vx, measured.vy) + std::abs(measured.omega);
    }
    void awaitMotion() { QTRY_VERIFY2(speed() > 0.1, qPrintable(open_->drive.problem())); }

    void staysAtRest(int time_ms) {
        QElapsedTimer time;
        for (time.start(); time.elapsed() < time_ms; QTest::qWait(5)) {
            QVERIFY2(!open_->drive.isDriving(), saying("after %1 ms", time.elapsed()));
            QCOMPARE(open_->drive.commanded().vx, 0.0);
        }
        QTRY_VERIFY(speed() < 0.02);
    }

    /// Let go and pressed once more it drives.
    void drivesAnew(const QString &key) {
        letGo();
        QTRY_VERIFY(!open_->drive.mustLetGo());
        hold(key);
        awaitMotion();
        letGo();
        QTRY_VERIFY(speed() < 0.02);
    }

    std::unique_ptr<FakeRobot> robot_;
    std::unique_ptr<OpenWindow> open_;
    QString held_;
};
