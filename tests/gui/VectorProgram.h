#pragma once

#include "common/capture/PcapWriter.h"
#include "protocol/velodyne/DataPacket.h"
#include "protocol/velodyne/Hdl32e.h"

#include <QXmlStreamReader>

struct Result {
    int status = -1;
    QByteArray out;
    QByteArray err;
};

/// Runs hermes-vector to its end.
inline Result run(const QStringList &arguments, const QByteArray &input = QByteArray()) {
    QProcess process;
    process.start(qEnvironmentVariable("HERMES_BIN") + QStringLiteral("/hermes-vector"), arguments);
    process.write(input);
    process.closeWriteChannel();
    process.waitForFinished(60000);
    Result r;
    r.status = process.exitStatus() == QProcess::NormalExit ? process.exitCode() : -1;
    r.out = process.readAllStandardOutput();
    r.err = process.readAllStandardError();
    return r;
}

/// The same where it must succeed.
inline Result ran(const QStringList &arguments, const QByteArray &input = {},
                  const char *file = __builtin_FILE(), int line = __builtin_LINE()) {
    const Result r = run(arguments, input);
    QTest::qVerify(r.status == 0, "it succeeds", r.err.constData(), file, line);
    return r;
}

/// It ended with that status and said so.
inline void refused(const Result &r, int status, const QByteArray &words, const char *file = __builtin_FILE(),
                    int line = __builtin_LINE()) {
    QTest::qCompare(r.status, status, "status", "expected", file, line);
    QTest::qVerify(r.err.contains(words), words.constData(), r.err.constData(), file, line);
}

/// A file of tests/data/vector.
inline QString data(const char *name) {
    return QStringLiteral(TEST_DATA_DIR "/vector/") + QLatin1String(name);
}

/// A picture can be read, and knows where all of it lies.
inline void isWellFormed(const QByteArray &svg) {
    QXmlStreamReader xml(svg);
    while (!xml.atEnd())
        xml.readNext();
    QVERIFY2(!xml.hasError(), qPrintable(xml.errorString()));
    QVERIFY(!svg.contains("nan"));
}

inline QJsonObject json(const QByteArray &text) {
    return QJsonDocument::fromJson(text).object();
}

/// Who sends to which port, and how far it sees.
struct CapturedSensor {
    std::uint32_t address = 0xC0A801C9; ///< 192.168.1.201
    std::uint16_t port = hermes::velodyne::dataPort;
    double range = 5; ///< of the wall all around; metres
    hermes::velodyne::Model model = hermes::velodyne::Model::Hdl32e;
};

/// A capture of `packets` data packets of each sensor in turn, 10 turns a second, a wall all around on every
/// laser.
inline void writeCapture(const QString &path, int packets,
                         const std::vector<CapturedSensor> &sensors = {CapturedSensor()}) {
    using namespace hermes;
    PcapWriter writer;
    if (const auto done = writer.open(path.toStdString(), true); !done)
        qFatal("%s", done.error().c_str());
    int azimuth = 18000;
    for (int p = 0; p < packets; ++p) {
        velodyne::DataPacketWriter packet;
        for (int block = 0; block < velodyne::blocksPerPacket; ++block, azimuth = (azimuth + 17) % 36000)
            packet.setAzimuth(block, std::uint16_t(azimuth));
        Datagram d;
        d.stamp_ns = 1000000000 + p * velodyne::hdl32e.packetPeriod_ns();
        d.payload = packet.bytes().data();
        d.size = packet.bytes().size();
        for (const CapturedSensor &sensor : sensors) {
            for (int block = 0; block < velodyne::blocksPerPacket; ++block)
                for (int slot = 0; slot < velodyne::slotsPerBlock; ++slot)
                    packet.setReturn(block, slot, velodyne::toDistanceCounts(sensor.range), 100);
            packet.setTail(std::uint32_t(d.stamp_ns / 1000), velodyne::ReturnMode::Strongest, sensor.model);
            d.source = sensor.address;
            d.sourcePort = d.destinationPort = sensor.port;
            writer.write(d);
        }
    }
    if (const auto done = writer.close(); !done)
        qFatal("%s", done.error().c_str());
}

/// A folder of the test class that inherits it; empty() removes its files.
class TestFolder {
protected:
    TestFolder() {
        if (!folder_.isValid())
            qFatal("no temporary folder: %s", qPrintable(folder_.errorString()));
    }
    QString path(const char *name = "") const { return folder_.filePath(QLatin1String(name)); }
    /// What is left in it, temporary files too.
    QStringList files() const {
        return QDir(folder_.path()).entryList(QDir::Files | QDir::Hidden, QDir::Name);
    }
    void empty() {
        for (const QString &name : files())
            QFile::remove(folder_.filePath(name));
    }
    /// What a sensor at the pose sees of world.json, as a file of the folder: a scan of points, or exact
    /// segments. The noise of points differs with the first letter of the name.
    QString seen(const char *name, const char *pose, bool points) const {
        QStringList arguments{"observe", data("world.json"), QStringLiteral("--pose=") + QLatin1String(pose),
                              "--out", path(name)};
        if (points)
            arguments += {"--scan", "1000", "--noise", "0.01", "--seed", QString::number(name[0])};
        ran(arguments);
        return path(name);
    }

private:
    QTemporaryDir folder_;
};
