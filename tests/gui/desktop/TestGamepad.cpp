#define SDL_MAIN_HANDLED
#include "gui/desktop/drive/DriveGamepad.h"
#include "tests/gui/desktop/OpenWindow.h"
#include "tests/gui/desktop/VirtualGamepad.h"
#include "tests/support/FakeRobot.h"

using namespace hermes;

/// A gamepad that SDL makes up drives the motors of a robot.
class TestGamepad : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        robot_ = std::make_unique<FakeRobot>();
        window_ = std::make_unique<OpenWindow>(robot_->address());
        QVERIFY(window_->show());
    }

    void cleanup() {
        QTRY_VERIFY_WITH_TIMEOUT(!isSeen(), 5000); // the pad is gone
        if (drive().isStopped())
            drive().release();
        QTRY_VERIFY_WITH_TIMEOUT(!drive().isStopped() && !drive().isDriving(), 10000);
    }

    void showsWhatIsPluggedIn() {
        QVERIFY(!isSeen());
        VirtualGamepad pad;
        QVERIFY2(pad.isThere(), SDL_GetError());
        TRY_CONTAINS(shown(), "hold the left shoulder button to drive");
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, true);
        QTRY_VERIFY2(shown().endsWith("drives"), qPrintable(shown()));
    }

    void drivesWhileTheDeadManButtonIsHeld() {
        VirtualGamepad pad;
        pad.move(SDL_CONTROLLER_AXIS_LEFTY, -1); // up
        QTRY_VERIFY(isSeen() && shown().contains("hold"));
        QTest::qWait(300);
        QVERIFY(!drive().isDriving());
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, true);
        QTRY_VERIFY2_WITH_TIMEOUT(drive().measured().vx > 0.05, qPrintable(drive().problem()), 10000);
        QVERIFY(std::abs(drive().commanded().vy) < 0.01 && std::abs(drive().commanded().omega) < 0.01);
        pad.move(SDL_CONTROLLER_AXIS_LEFTY, 0);
        pad.move(SDL_CONTROLLER_AXIS_RIGHTX, 1); // to the right
        QTRY_VERIFY_WITH_TIMEOUT(drive().measured().omega < -0.05 && drive().commanded().vx < 0.01, 10000);
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, false);
        QTRY_VERIFY_WITH_TIMEOUT(!drive().isDriving(), 1000);
        QTRY_VERIFY_WITH_TIMEOUT(std::abs(drive().measured().omega) < 0.01, 10000);
    }

    void unpluggedWhileItDrivesItStops() {
        VirtualGamepad pad;
        QTRY_VERIFY(isSeen() && shown().contains("hold"));
        pad.move(SDL_CONTROLLER_AXIS_LEFTY, -1);
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, true);
        QTRY_VERIFY_WITH_TIMEOUT(drive().measured().vx > 0.05, 10000);
        pad.unplug();
        QTRY_VERIFY_WITH_TIMEOUT(!drive().isDriving(), 1000);
        QTRY_VERIFY_WITH_TIMEOUT(std::abs(drive().measured().vx) < 0.01, 10000);
    }

    void pluggedInWithItsButtonHeldItDoesNotDrive() {
        drive().stop(); // what is held counts only after it was let go
        VirtualGamepad pad;
        pad.move(SDL_CONTROLLER_AXIS_LEFTY, -1);
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, true);
        QTRY_VERIFY(shown().endsWith("drives"));
        QTRY_VERIFY_WITH_TIMEOUT(drive().stopping().phase() == StopPhase::Confirmed, 10000);
        drive().release();
        QTRY_VERIFY_WITH_TIMEOUT(!drive().isStopped(), 10000);
        QTest::qWait(500);
        QVERIFY(!drive().isDriving());
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, false);
        QTRY_VERIFY(isSeen() && shown().contains("hold"));
        QTRY_VERIFY(!drive().mustLetGo());
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, true);
        QTRY_VERIFY_WITH_TIMEOUT(drive().isDriving(), 10000);
    }

    void afterACalibrationTheButtonMustBeLetGo() {
        VirtualGamepad pad;
        QTRY_VERIFY(isSeen() && shown().contains("hold"));
        OpenWindow::click(&window(), "calibrate");
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, true); // by habit
        pad.move(SDL_CONTROLLER_AXIS_LEFTY, -1);
        const DriveGamepad *const gamepad = window().findChild<DriveGamepad *>();
        QTRY_VERIFY(gamepad->pad().isDeadManHeld() && gamepad->step() != DriveGamepad::Step::None);
        OpenWindow::click(&window(), "calibrateOther"); // Cancel
        QTest::qWait(300);
        QVERIFY(!drive().isDriving());
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, false);
        QTRY_VERIFY(!gamepad->pad().isDeadManHeld() && !drive().mustLetGo());
        pad.press(SDL_CONTROLLER_BUTTON_LEFTSHOULDER, true);
        QTRY_VERIFY_WITH_TIMEOUT(drive().isDriving(), 10000);
    }

    void stopHoweverShort() {
        VirtualGamepad pad;
        QTRY_VERIFY(isSeen() && shown().contains("hold"));
        pad.press(SDL_CONTROLLER_BUTTON_B, true);
        SDL_JoystickUpdate(); // pressed and let go between two looks of the window
        pad.press(SDL_CONTROLLER_BUTTON_B, false);
        SDL_JoystickUpdate();
        QTRY_VERIFY_WITH_TIMEOUT(drive().isStopped(), 1000);
        QTRY_VERIFY_WITH_TIMEOUT(drive().stopping().phase() == StopPhase::Confirmed, 10000);
    }

    void measuresWhereSticksRest() {
        const std::vector<GamepadSticks> resting{{0.2, -0.1, 0}, {0.22, -0.12, 0.01}};
        const std::vector<GamepadSticks> moving{{-0.8, -1, -0.9}, {1, 0.9, 0.95}};
        const auto made = GamepadCalibration::of(resting, moving);
        QVERIFY2(made.ok(), qPrintable(made ? QString() : made.error().message));
        QCOMPARE(made->apply({0.21, -0.11, 0}), (GamepadSticks{0, 0, 0}));
        QCOMPARE(made->apply({0.25, -0.14, -0.04}), (GamepadSticks{0, 0, 0})); // within the play
        QCOMPARE(made->apply({1, -1, 0.95}), (GamepadSticks{1, -1, 1}));
        QCOMPARE(made->apply({-1, 1, -1}), (GamepadSticks{-1, 1, -1}));
        const GamepadSticks half = made->apply({0.21 + 0.05 + (0.79 - 0.05) / 2, 0, 0});
        QVERIFY(std::abs(half[0] - 0.5) < 1e-9);
        const auto read = GamepadCalibration::fromList(made->toList());
        QCOMPARE(read.apply({0.25, -0.14, 0.5}), made->apply({0.25, -0.14, 0.5}));
    }

    void calibrationsThatCannotBe_data() {
        const Rows<QVariantList> row("list");
        const double nan = std::numeric_limits<double>::quiet_NaN(),
                     inf = std::numeric_limits<double>::infinity();
        row("nothing", QVariantList());
        row("too few", {0, -1, 1, 0.1});
        row("words", {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l"});
        for (const double wrong : {nan, inf, -inf, 1e300, 2.0, -2.0})
            for (int i = 0; i < 12; ++i) {
                QVariantList list{0, -1, 1, 0.1, 0, -1, 1, 0.1, 0, -1, 1, 0.1};
                list[i] = wrong;
                QTest::addRow("%g at %d", wrong, i) << list;
            }
    }

    void calibrationsThatCannotBe() {
        QFETCH(QVariantList, list);
        const GamepadCalibration usual, read = GamepadCalibration::fromList(list);
        for (const double at : {-1.0, -0.5, 0.0, 0.1, 0.7, 1.0})
            QCOMPARE(read.apply({at, -at, at / 2}), usual.apply({at, -at, at / 2}));
    }

    void calibratesByTheWindow() {
        QTemporaryDir folder;
        Fleet fleet;
        DriveControl still(fleet);
        const auto calibrated = [&](double at) {
            MainWindow window(fleet, still, folder.filePath("gui.json"));
            window.show();
            VirtualGamepad pad;
            pad.move(SDL_CONTROLLER_AXIS_LEFTX, 0.3); // where its stick rests
            auto *const gamepad = window.findChild<DriveGamepad *>();
            auto *const button = window.findChild<QPushButton *>("calibrate");
            QTest::qWait(10);
            [&] { QTRY_VERIFY(button->isVisible() && gamepad->pad().sticks()[0] > 0.25); }();
            if (at == 0) { // measures; else it is the one that was kept
                QTest::mouseClick(button, Qt::LeftButton);
                [&] { QTRY_COMPARE(gamepad->step(), DriveGamepad::Step::Move); }();
                for (const double end : {-1.0, 1.0, 0.3})
                    for (const auto axis :
                         {SDL_CONTROLLER_AXIS_LEFTX, SDL_CONTROLLER_AXIS_LEFTY, SDL_CONTROLLER_AXIS_RIGHTX}) {
                        pad.move(axis, axis == SDL_CONTROLLER_AXIS_LEFTX || end != 0.3 ? end : 0);
                        QTest::qWait(100);
                    }
                QTest::mouseClick(button, Qt::LeftButton);
                const QString told = window.findChild<QLabel *>("gamepadMessage")->text();
                [&] { QVERIFY2(told == "Calibrated.", qPrintable(told)); }();
            }
            pad.move(SDL_CONTROLLER_AXIS_LEFTX, 0.3 + 0.7 * at);
            QTest::qWait(100);
            return gamepad->sticks()[0];
        };
        QCOMPARE(calibrated(0), 0.0);
        const double half = calibrated(0.5);
        QVERIFY2(half > 0.4 && half < 0.5, saying(half));
    }

private:
    MainWindow &window() const { return window_->window; }
    DriveControl &drive() const { return window_->drive; }
    bool isSeen() const { return window().findChild<QLabel *>("gamepad")->isVisible(); }
    QString shown() const { return window().findChild<QLabel *>("gamepad")->text(); }

    std::unique_ptr<FakeRobot> robot_;
    std::unique_ptr<OpenWindow> window_;
};
