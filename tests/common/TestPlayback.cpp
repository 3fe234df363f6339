#include "common/recording/Playback.h"

using namespace hermes;

/// What a replay without a single record does: there is nothing that it would wait for.
class TestPlayback : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void beginsWhenItGoesOn_data() { falseAndTrue("seek", "released", "sought"); }

    void beginsWhenItGoesOn() {
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

    void stopsWhileItWaits() {
        Playback playback;
        playback.start({1, false, true}, [&playback] { playback.waitFor(1000000000); });
        playback.stop();
        QVERIFY(playback.status().paused);
    }

    /// From where it is, also after it waited for nothing.
    void goesOnAtAnotherSpeed() {
        constexpr std::int64_t second_ns = 1000000000, hour_ns = 3600 * second_ns;
        std::atomic<int> played{0};
        Playback playback;
        playback.start({0, false, false}, [&] {
            for (const std::int64_t time_ns : {hour_ns, hour_ns, hour_ns + second_ns / 10, 3 * hour_ns})
                if (playback.waitFor(time_ns) == Playback::Turn::Due && ++played == 2)
                    playback.setPaused(true);
        });
        QTRY_COMPARE(played.load(), 2);
        playback.setSpeed(1);
        playback.setPaused(false);
        auto timer = runningTimer();
        QTRY_COMPARE(played.load(), 3);
        QVERIFY(timer.elapsed() >= 50);
        QVERIFY(!QTest::qWaitFor([&] { return played == 4; }, 200)); // two hours away
        playback.setSpeed(1e9);
        QTRY_COMPARE(played.load(), 4);
    }

    /// A quarter of a second from there, and no more; the time stays.
    void aSeekWhileItWaitsShowsThePlace() {
        constexpr std::int64_t step_ns = 10000000;
        std::atomic<std::int64_t> last_ns{-1};
        Playback playback;
        playback.start({1, true, true}, [&] {
            std::int64_t time_ns = 0;
            for (;;) {
                const Playback::Turn turn = playback.waitFor(time_ns);
                if (turn == Playback::Turn::End)
                    return;
                if (turn == Playback::Turn::Seek)
                    playback.jump(time_ns = playback.takeSeek());
                else
                    last_ns = std::exchange(time_ns, time_ns + step_ns);
            }
        });
        for (const double time_s : {5.0, 2.0, 2.0, 3.0}) {
            last_ns = -1;
            playback.seek(time_s);
            const auto end_ns = std::int64_t(time_s * 1e9) + 250000000;
            QTRY_COMPARE(std::int64_t(last_ns), end_ns);
            QVERIFY(!QTest::qWaitFor([&] { return last_ns != end_ns; }, 50));
            QCOMPARE(playback.status().position_s, time_s);
        }
        auto timer = runningTimer();
        playback.setPaused(false); // goes on as if it had not been shown
        QTRY_VERIFY(last_ns >= 3300000000);
        QVERIFY(timer.elapsed() >= 290);
    }

    void waitsAtItsEnd() {
        std::atomic<int> turn{-1};
        Playback playback;
        const auto play = [&] {
            if (playback.waitFor(0) == Playback::Turn::Seek) // shown while it waits
                playback.jump(playback.takeSeek());
            turn = int(playback.waitToEnd());
        };
        playback.start({1, false, true}, play);
        playback.seek(0);
        QVERIFY(!QTest::qWaitFor([&] { return turn >= 0; }, 50));
        playback.setPaused(false);
        QTRY_COMPARE(turn.load(), int(Playback::Turn::Due));
    }
};
