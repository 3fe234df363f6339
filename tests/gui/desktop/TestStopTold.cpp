#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// "STOPPED" is never said of a robot that is not known to stand, whatever has stopped it.
class TestStopTold : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void onlyOfOneThatStands_data() {
        const Rows<QString> row("cause");
        row("the stop of another client", "estop");
        row("a controller that keeps turning", "encoder");
    }

    void onlyOfOneThatStands() {
        QFETCH(QString, cause);
        const auto state = [&](const char *standing) {
            return QString(
                       R"({"latched":{"%1":"controller 1 kept turning"},"control":{"held":false},"standing":%2})")
                .arg(cause, standing)
                .toLatin1();
        };
        Mischief motors;
        motors.isMotors = true;
        FakeDaemon daemon(motors);
        OpenWindow open;
        QVERIFY(open.fleet.add(daemon.address()).ok());
        QVERIFY(open.show());
        QTRY_VERIFY(open.drive.isPossible());
        const auto *const button = open.window.findChild<QPushButton *>("stop");
        const auto *const banner = open.window.findChild<QLabel *>("stopBanner");
        QCOMPARE(button->text(), QString("STOP"));
        bool isSaid = false;
        connect(&open.drive, &DriveControl::changed, this, [&] {
            isSaid = isSaid || button->text() == "STOPPED" ||
                     (banner->isVisible() && banner->text().contains("STOPPED"));
        });
        daemon.setResult("motor.state", state(R"({"confirmed":false,"text":"wheel 1 turns with 2 rad/s"})"));
        QTRY_VERIFY(open.drive.isStopped());
        QTRY_VERIFY2_WITH_TIMEOUT(banner->isVisible() && banner->text().contains("NOT KNOWN TO STAND") &&
                                      banner->text().contains("wheel 1 turns"),
                                  qPrintable(banner->text()), 4000);
        QVERIFY(!isSaid);
        daemon.setResult("motor.state", state(R"({"confirmed":true,"text":""})"));
        QTRY_COMPARE(button->text(), QString("STOPPED"));
        TRY_STARTS(banner->text(), "STOPPED: controller 1 kept turning");
        daemon.setResult("motor.state", R"({"latched":{},"control":{"held":false}})");
        QTRY_COMPARE(button->text(), QString("STOP"));
        QTRY_VERIFY(!banner->isVisible());
    }
};
