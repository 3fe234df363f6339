#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/OpenWindow.h"

using namespace hermes;

/// A thousand robots in one window: it goes on, and STOP is of the chosen one.
class TestThousandRobots : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void windowGoesOn() {
        constexpr int count = 1000;
        Mischief motors;
        motors.isMotors = motors.isEverywhere = true;
        motors.hasTopics = false;
        const FakeDaemon all(motors); // a host for each address of this computer
        OpenWindow open;
        QVERIFY(open.show());
        LoopWatch watch;
        for (int i = 0; i < count; ++i) {
            QVERIFY(
                open.fleet.add(QString("127.0.%1.%2:%3").arg(1 + i / 250).arg(1 + i % 250).arg(all.port()))
                    .ok());
            if (i % 10 == 0)
                QCoreApplication::processEvents();
        }
        const auto isAny = [&open](bool (*is)(const DaemonLink &), bool areAll) {
            int found = 0;
            for (const auto &robot : open.fleet.robots())
                for (const DaemonLink *daemon : robot->daemons())
                    found += is(*daemon);
            return areAll ? found == count : found > 0;
        };
        QTRY_VERIFY_WITH_TIMEOUT(isAny([](const DaemonLink &link) { return link.isConnected(); }, true),
                                 60000);
        QTRY_VERIFY_WITH_TIMEOUT(open.fleet.robot() && open.drive.isPossible(), 60000);
        qInfo("figure a thousand come, event loop busy at most: %.1f ms of the processor",
              watch.longestCpu_ms());
        watch.restart();
        for (auto *const dock : open.window.findChildren<QDockWidget *>()) {
            dock->show();
            dock->raise();
            QTest::qWait(200);
        }
        QTest::qWait(1000);
        qInfo("figure they are there, event loop busy at most: %.1f ms of the processor",
              watch.longestCpu_ms());
        // 20 to 35 on a quiet machine.
        QVERIFY2(watch.longestCpu_ms() < 150 * slowness, saying(watch.longestCpu_ms()));
        watch.restart();
        auto *const robots = open.window.findChild<QComboBox *>("robots");
        QCOMPARE(robots->count(), count);
        robots->showPopup();
        QTest::qWait(100);
        robots->hidePopup();
        for (const int index : {0, 999, 500}) {
            robots->setCurrentIndex(index);
            Q_EMIT robots->activated(index);
            QTest::qWait(200);
            QCOMPARE(open.fleet.robot()->address(), robots->itemData(index).toString());
        }
        qInfo("figure others are chosen, event loop busy at most: %.1f ms of the processor",
              watch.longestCpu_ms());
        const QSize least = open.window.minimumSizeHint();
        QVERIFY2(least.width() <= 1024 && least.height() <= 600,
                 saying("%1 x %2", least.width(), least.height()));
        QTRY_VERIFY_WITH_TIMEOUT(open.drive.isPossible(), 60000); // who was too busy to say so before
        const int before = all.calls("motor.estop");
        auto time = runningTimer();
        QTest::mouseClick(open.window.findChild<QPushButton *>("stop"), Qt::LeftButton);
        QTRY_VERIFY_WITH_TIMEOUT(all.calls("motor.estop") > before, 1000);
        qInfo("figure STOP was there after: %lld ms", time.elapsed());
    }
};
