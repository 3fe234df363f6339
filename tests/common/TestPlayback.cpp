#include "common/recording/Playback.h"

#include <QtTest>

#include <atomic>

using namespace hermes;

/// What a replay without a single record does: there is nothing that it would wait for.
class TestPlayback : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void beginsWhenItGoesOn_data();
    void beginsWhenItGoesOn();
    void stopsWhileItWaits();
};

void TestPlayback::beginsWhenItGoesOn_data() {
    QTest::addColumn<bool>("seek");
    QTest::newRow("released") << false;
    QTest::newRow("sought") << true;
}

void TestPlayback::beginsWhenItGoesOn() {
    QFETCH(bool, seek);
    for (int i = 0; i < 40; ++i) {
        std::atomic<bool> isAtEnd{false};
        Playback playback;
        playback.start({1, false, true}, [&isAtEnd] { isAtEnd = true; });
        for (int k = 0; k < 20; ++k) // time for the other thread
            std::this_thread::yield();
        QVERIFY(!isAtEnd);
        seek ? playback.seek(1) : playback.setPaused(false);
        QTRY_VERIFY(isAtEnd);
    }
}

void TestPlayback::stopsWhileItWaits() {
    Playback playback;
    playback.start({1, false, true}, [&playback] { playback.waitFor(1000000000); });
    playback.stop();
    QVERIFY(playback.status().paused);
}

QTEST_GUILESS_MAIN(TestPlayback)
#include "TestPlayback.moc"
