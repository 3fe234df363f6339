#pragma once

#include "daemons/velodynelogger/LidarFeed.h"
#include "tests/support/Sensor.h"

namespace hermes {

using namespace velodynelogger;

/// Everything that a feed says.
class LidarListener {
public:
    Recorder recorder;
    std::vector<velodyne::Turn> turns;
    std::vector<velodyne::Turn> clouds;
    std::atomic<int> ready{0};
    std::atomic<bool> ended{false};
    std::string error;
    LidarFeed feed{recorder, [this] { ++ready; }};

    Outcome<void> openPcap(const std::string &path, double speed, bool loop = false, bool paused = false) {
        return feed.openPcap({path}, {speed, loop, paused}, {}, [this](const Outcome<void> &played) {
            error = played ? std::string() : played.error();
            ended = true;
        });
    }

    void take() {
        while (const LidarFeed::Turn turn = feed.takeTurn())
            turns.push_back(*turn);
        while (const LidarFeed::Turn cloud = feed.takeCloud())
            clouds.push_back(*cloud);
    }
    /// Takes turns until the capture has ended.
    bool waitForEnd() {
        for (int i = 0; i < 3000 && !ended; ++i) {
            QTest::qWait(5);
            take();
        }
        take();
        return ended;
    }
};

inline bool operator==(const velodyne::Point &a, const velodyne::Point &b) {
    return a.stamp_ns == b.stamp_ns && a.azimuth == b.azimuth && a.range == b.range && a.x == b.x &&
           a.y == b.y && a.laser == b.laser && a.intensity == b.intensity;
}

inline bool same(const std::vector<velodyne::Turn> &a, const std::vector<velodyne::Turn> &b) {
    return std::equal(
        a.begin(), a.end(), b.begin(), b.end(), [](const velodyne::Turn &s, const velodyne::Turn &t) {
            return s.partial == t.partial && s.number == t.number && s.begin_ns == t.begin_ns &&
                   std::equal(s.points.begin(), s.points.end(), t.points.begin(), t.points.end(),
                              [](const auto &p, const auto &q) { return p == q; });
        });
}

/// The turns of a capture, decoded in one go.
inline std::vector<velodyne::Turn> decode(const QString &path) {
    std::vector<velodyne::Turn> turns;
    velodyne::TurnAssembler assembler({}, [&](const velodyne::Turn &turn) { turns.push_back(turn); });
    PcapReader reader;
    Datagram datagram;
    if (!reader.open(path.toStdString()))
        qFatal("%s", reader.error().c_str());
    while (reader.next(datagram) == PcapReader::Next::Datagram)
        assembler.feed(datagram.payload, datagram.size, datagram.stamp_ns);
    assembler.finish();
    return turns;
}

/// A capture of count packets.
inline QString makeCapture(const QTemporaryDir &folder, int count) {
    const QString path = folder.filePath(QStringLiteral("made.pcap"));
    const Sensor sensor;
    PcapWriter writer;
    if (const auto done = writer.open(path.toStdString()); !done)
        qFatal("%s", done.error().c_str());
    for (int i = 0; i < count; ++i)
        writer.write(sensorDatagram(sensor.packet(i), sensor.stamp(i)));
    return path;
}

struct MadeCapture {
    explicit MadeCapture(int count)
        : path(makeCapture(folder, count)) {}

    QTemporaryDir folder;
    QString path;
};

/// A listener to such a capture.
struct MadeReplay : MadeCapture, LidarListener {
    using MadeCapture::MadeCapture;
    Outcome<void> play(double speed, bool loop = false, bool paused = false) {
        return openPcap(path.toStdString(), speed, loop, paused);
    }
};

} // namespace hermes
