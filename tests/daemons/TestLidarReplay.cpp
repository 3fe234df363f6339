#include "LidarListener.h"

using namespace hermes;
using velodyne::Turn;

class TestLidarReplay : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void replayGivesWhatDirectDecodingGives_data() {
        const Rows<double> row("speed");
        row("as fast as possible", 0.0);
        row("real time", 1.0);
        row("threefold", 3.0);
    }

    void replayGivesWhatDirectDecodingGives() {
        QFETCH(double, speed);
        REAL_DATA(path, "hdl32e-outdoor.pcap");
        LidarListener listener;
        QVERIFY(listener.openPcap(path.toStdString(), speed));
        QVERIFY(listener.waitForEnd());
        QCOMPARE(listener.error, std::string());
        QVERIFY(listener.turns.size() >= 3);
        QVERIFY(same(listener.turns, decode(path)));
        QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(500));
        QCOMPARE(listener.feed.counts().packets.lost, std::uint64_t(0));
    }

    void fastReplayWaitsForItsReader() {
        MadeReplay listener(6000); // 34 turns
        QVERIFY(listener.play(0));
        QTRY_COMPARE(listener.ready.load(), 16);                   // the queue is full
        QCOMPARE(listener.feed.counts().turns, std::uint64_t(16)); // answers meanwhile
        QVERIFY(!listener.ended);
        QVERIFY(listener.waitForEnd());
        QVERIFY(same(listener.turns, decode(listener.path)));
        QCOMPARE(listener.feed.counts().turnsDropped, std::uint64_t(0));
    }

    void replayKeepsItsPace() {
        MadeReplay listener(1000); // 0.553 s
        auto timer = runningTimer();
        QVERIFY(listener.play(1));
        QVERIFY(listener.waitForEnd());
        QVERIFY(timer.elapsed() > 540);
        QVERIFY(same(listener.turns, decode(listener.path)));
    }

    void cutCaptureGivesAllBeforeTheCut() {
        MadeReplay listener(500);
        QVERIFY(QFile::resize(listener.path, 24 + 300 * (16 + 42 + 1206) + 700));
        QVERIFY(listener.play(0));
        QVERIFY(listener.waitForEnd());
        QVERIFY2(listener.error.find(listener.path.toStdString() +
                                     ": record 301 at byte 379224 cannot be read") == 0,
                 listener.error.c_str());
        QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(300));
        std::size_t points = 0;
        for (const Turn &turn : listener.turns)
            points += turn.points.size();
        QCOMPARE(points, std::size_t(300 * 12));
    }

    void replayLoops() {
        MadeReplay listener(500);
        QVERIFY(listener.play(0, true));
        QTRY_VERIFY((listener.take(), listener.turns.size() >= 12));
        QVERIFY(!listener.ended);
        listener.feed.close();
        // Each time the same four turns, numbered on; nothing counts as lost.
        for (std::size_t i = 4; i < 12; ++i) {
            QCOMPARE(listener.turns[i].number, std::uint64_t(i));
            QCOMPARE(listener.turns[i].begin_ns, listener.turns[i % 4].begin_ns);
            QCOMPARE(listener.turns[i].points.size(), listener.turns[i % 4].points.size());
        }
        const velodyne::PacketCounts counts = listener.feed.counts().packets;
        QCOMPARE(counts.lost + counts.outOfOrder + counts.clockJumps, std::uint64_t(0));
        QVERIFY(listener.feed.player().playback().status().loops >= 2);
        // A file that is cut is played to the cut, once.
        QVERIFY(QFile::resize(listener.path, 24 + 300 * (16 + 42 + 1206) + 700));
        LidarListener cut;
        QVERIFY(cut.openPcap(listener.path.toStdString(), 0, true));
        QVERIFY(cut.waitForEnd());
        QVERIFY(!cut.error.empty());
        QCOMPARE(cut.feed.counts().packets.packets, std::uint64_t(300));
    }

    void replaySeeks_data() {
        const Rows<double, bool, int> row("target_s", "pcapng", "first"); // first: packet played after it
        row("to the beginning", 0.0, false, 0);
        row("between two packets", 0.0100, false, 19);
        row("behind the first mark", 3.0, false, 5426);
        row("the last packet", 11999 * 552.96e-6, false, 11999);
        row("pcapng", 3.0, true, 5426);
    }

    /// Paused, so that nothing but a turn from the target on is played after the seek; from the front and
    /// from behind.
    void replaySeeks() {
        FETCH(double, target_s, bool, pcapng, int, first);
        QTemporaryDir folder;
        QString path = makeCapture(folder, 12000);
        if (pcapng) {
            path = folder.filePath(QStringLiteral("made.pcapng"));
            if (QProcess::execute(QStringLiteral("editcap"),
                                  {QStringLiteral("-F"), QStringLiteral("pcapng"),
                                   folder.filePath(QStringLiteral("made.pcap")), path}) != 0)
                QSKIP("editcap is not installed");
        }
        for (const double from_s : {0.5, 5.0}) { // far from the end, at which nothing is left to seek
            std::mutex mutex;
            std::vector<std::int64_t> stamps;
            std::atomic<int> jumps{0};
            PcapPlayer player(
                [&](const Datagram &datagram) {
                    const std::lock_guard<std::mutex> lock(mutex);
                    stamps.push_back(datagram.stamp_ns);
                },
                [&] {
                    const std::lock_guard<std::mutex> lock(mutex);
                    stamps.clear();
                    ++jumps;
                },
                [](const Outcome<void> &) {});
            const auto played = [&] {
                const std::lock_guard<std::mutex> lock(mutex);
                return stamps;
            };
            QVERIFY(player.start({path.toStdString()}, {1, false, false}));
            QTRY_VERIFY(player.duration_s().has_value());
            QVERIFY(std::abs(*player.duration_s() - 11999 * 552.96e-6) < 1e-5);
            Playback &playback = player.playback();
            playback.seek(from_s);
            QTRY_VERIFY(jumps == 1 && !played().empty() &&
                        played().back() - Sensor().stamp(0) >= from_s * 1e9);
            playback.setPaused(true);
            playback.seek(target_s);
            QTRY_COMPARE(jumps.load(), 2);
            QTRY_VERIFY(!played().empty());
            QCOMPARE(played().front(), Sensor().stamp(first));
            const std::int64_t shown_ns =
                std::min<std::int64_t>(250000000, Sensor().stamp(11999) - played().front());
            QTRY_VERIFY(played().back() - played().front() > shown_ns - 1000000);
            QVERIFY(!QTest::qWaitFor([&] { return played().back() - played().front() > shown_ns; }, 50));
            QCOMPARE(playback.status().position_s, target_s);
            playback.setPaused(false);
            if (first < 11000)
                QTRY_VERIFY(playback.status().position_s > target_s + 0.25);
            player.stop();
        }
    }

    void replayPauses() {
        MadeReplay listener(3000); // 1.659 s
        QVERIFY(listener.play(1));
        QTRY_VERIFY(listener.feed.counts().packets.packets > 100);
        listener.feed.player().playback().setPaused(true);
        const std::uint64_t packets = listener.feed.counts().packets.packets + 1; // one may be on its way
        auto timer = runningTimer();
        while (timer.elapsed() < 700) // in which 1200 packets would have been played
            QTest::qWait(10);
        QVERIFY(listener.feed.counts().packets.packets <= packets);
        QVERIFY(listener.feed.player().playback().status().paused && !listener.ended);
        listener.feed.player().playback().setPaused(false);
        QVERIFY(listener.waitForEnd()); // and does not hurry to catch up: the rest takes its time
        QVERIFY(timer.elapsed() > 700 + qint64(double(3000 - packets) * 0.553) - 20);
        QVERIFY(same(listener.turns, decode(listener.path)));
    }

    void closingEndsAWaitingReplay() {
        MadeReplay listener(6000);
        QVERIFY(listener.play(0));
        QTRY_COMPARE(listener.ready.load(), 16);
        listener.feed.close(); // does not hang
        QVERIFY(!listener.ended);
    }
};
