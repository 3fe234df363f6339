// Replays of several files, with pauses and steps of the clock between and in them.
#include "LidarListener.h"

using namespace hermes;

class TestLidarRecordings : public QObject {
    Q_OBJECT
private Q_SLOTS:
    /// With a mark in each of them, found again by a seek back.
    void severalFilesAreOneReplay() {
        QTemporaryDir folder;
        const QString whole = makeCapture(folder, 9000);
        const Sensor sensor;
        std::vector<std::string> paths;
        for (int begin = 0; begin < 9000; begin += 3000) {
            paths.push_back(folder.filePath(QString::number(begin)).toStdString());
            PcapWriter writer;
            QVERIFY(writer.open(paths.back()));
            for (int i = begin; i < begin + 3000; ++i)
                writer.write(sensorDatagram(sensor.packet(i), sensor.stamp(i)));
            QVERIFY(writer.close());
        }
        LidarListener listener;
        const auto ended = [&](const Outcome<void> &played) {
            listener.error = played ? std::string() : played.error();
            listener.ended = true;
        };
        QVERIFY(listener.feed.openPcap(paths, {0}, {}, ended));
        QVERIFY(listener.waitForEnd());
        QCOMPARE(listener.error, std::string());
        QVERIFY(same(listener.turns, decode(whole)));

        std::mutex mutex;
        std::int64_t last = 0;
        PcapPlayer player(
            [&](const Datagram &datagram) {
                const std::lock_guard<std::mutex> lock(mutex);
                last = datagram.stamp_ns;
            },
            [] {}, [](const Outcome<void> &) {});
        const auto at = [&](int packet) {
            const std::lock_guard<std::mutex> lock(mutex);
            return last >= sensor.stamp(packet) && last < sensor.stamp(packet + 2000);
        };
        QVERIFY(player.start(paths, {1, false, false}));
        QTRY_VERIFY(player.duration_s().has_value());
        QVERIFY(std::abs(*player.duration_s() - 8999 * 552.96e-6) < 1e-5);
        for (const int packet : {7000, 2000, 4000}) {
            player.playback().seek(packet * 552.96e-6);
            QTRY_VERIFY(at(packet));
        }
        QVERIFY(QFile::remove(QString::fromStdString(paths[2])));
        listener.ended = false;
        QVERIFY(listener.feed.openPcap(paths, {0}, {}, ended));
        QVERIFY(listener.waitForEnd());
        QVERIFY2(listener.error.find("cannot be opened") != std::string::npos, listener.error.c_str());
        QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(6000));
    }

    /// It began 100 s before, which is no jump of the clock, and is played 0.3 s after others.
    void aRecordingBeginsBeforeItsFirstPacket() {
        QTemporaryDir folder;
        const QString path = makeCapture(folder, 500); // 0.276 s
        const std::int64_t begin_ns = Sensor().stamp(0) - 100000000000;
        LidarListener listener;
        const auto opened = listener.feed.openPcap(
            {path.toStdString()}, {100, false, true}, {},
            [&](const Outcome<void> &) { listener.ended = true; },
            PlayTime(begin_ns, 101000000000, 300000000));
        QVERIFY(opened);
        QTRY_VERIFY(listener.feed.player().duration_s().has_value());
        QVERIFY(std::abs(*listener.feed.player().duration_s() - 100.3 - 499 * 552.96e-6) < 1e-5);
        auto timer = runningTimer();
        listener.feed.player().playback().setPaused(false);
        QVERIFY(listener.waitForEnd());
        QVERIFY(timer.elapsed() >= 1003);
        QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(500));
    }

    /// The clock of the recording host was set back by an hour, then forward by a day.
    void clockStepsAreNotWaitedFor() {
        QTemporaryDir folder;
        const QString path = folder.filePath(QStringLiteral("steps.pcap"));
        const Sensor sensor;
        PcapWriter writer;
        QVERIFY(writer.open(path.toStdString()));
        for (int i = 0; i < 300; ++i) {
            const std::int64_t off_s = i < 100 ? 0 : i < 200 ? -3600 : 86400;
            writer.write(sensorDatagram(sensor.packet(i), sensor.stamp(i) + off_s * 1000000000));
        }
        QVERIFY(writer.close());
        LidarListener listener;
        auto timer = runningTimer();
        QVERIFY(listener.openPcap(path.toStdString(), 1));
        QVERIFY(listener.waitForEnd());
        QVERIFY(timer.elapsed() > 160 - 20); // 297 steps of 0.553 ms
        QCOMPARE(listener.feed.counts().packets.packets, std::uint64_t(300));
        QCOMPARE(listener.feed.counts().packets.clockJumps, std::uint64_t(2));
        QCOMPARE(listener.feed.counts().packets.lost, std::uint64_t(0));
    }
};
