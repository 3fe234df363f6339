// hermes-vector ring and map find the data packets of a capture by what they are, and take those of one
// sensor.
#include "VectorProgram.h"

using hermes::velodyne::Model;

namespace {

/// The ranges that ring printed, each once.
QSet<double> rangesOf(const QByteArray &csv) {
    QSet<double> ranges;
    for (const QByteArray &line : csv.trimmed().split('\n').mid(1))
        ranges.insert(line.split(',').at(3).toDouble());
    return ranges;
}

/// A datagram of other programs, of the size of a data packet.
void appendForeign(const QString &path, quint16 port) {
    using namespace hermes;
    PcapWriter writer;
    const QString copy = path + ".copy";
    const QByteArray payload(int(velodyne::packetSize), 'x');
    Datagram d;
    d.stamp_ns = 2000000000;
    d.source = 0xC0A80105;
    d.sourcePort = d.destinationPort = port;
    d.payload = reinterpret_cast<const std::uint8_t *>(payload.constData());
    d.size = std::size_t(payload.size());
    if (!writer.open(copy.toStdString()) || !writer.write(d) || !writer.close())
        qFatal("%s cannot be written", qPrintable(copy));
    const QByteArray record = contents(copy).mid(int(PcapWriter::fileHeaderBytes));
    QFile::remove(copy);
    write(path, contents(path) + record);
}

} // namespace

class TestVectorCaptures : public QObject {
    Q_OBJECT
    TestFolder folder_;
    QString path(const char *name) const { return folder_.path(name); }

private Q_SLOTS:
    void initTestCase() { QVERIFY(folder_.isValid()); }
    void init() { folder_.empty(); }

    void anyPortIsRead() {
        writeCapture(path("usual.pcap"), 400);
        writeCapture(path("other.pcap"), 400, {{0xC0A801C9, 4711}});
        appendForeign(path("other.pcap"), 5000);
        const Result usual = run({"ring", path("usual.pcap")}), other = run({"ring", path("other.pcap")});
        QCOMPARE(other.err, QByteArray());
        QCOMPARE(other.status, 0);
        QCOMPARE(other.out, usual.out);
        const Result map = run({"map", path("other.pcap")});
        QVERIFY2(map.status == 0, map.err.constData());
        QCOMPARE(json(map.out)["scans"].toInt(), 3);
    }

    // A pipe can be read only once: what tells its kind must not be lost.
    void pipesAreReadFromTheirBeginning_data() {
        QTest::addColumn<QStringList>("arguments");
        QTest::addColumn<QString>("file");
        QTest::newRow("points") << QStringList{"segment", "FILE"} << QString(data("room.csv"));
        QTest::newRow("log") << QStringList{"map", "FILE",      "--corrected", "--out-trajectory",
                                            "-",   "--summary", path("s")}
                             << QString(data("corrected.log"));
        QTest::newRow("capture") << QStringList{"ring", "FILE"} << path("capture.pcap");
        QTest::newRow("capture to map")
            << QStringList{"map", "FILE", "--out-trajectory", "-", "--summary", path("s")}
            << path("capture.pcap");
    }
    void pipesAreReadFromTheirBeginning() {
        QFETCH(QStringList, arguments);
        QFETCH(QString, file);
        writeCapture(path("capture.pcap"), 800);
        QFile content(file);
        QVERIFY(content.open(QIODevice::ReadOnly));
        const QByteArray bytes = content.readAll();
        const auto of = [&](const QString &name) {
            QFile::remove(path("s"));
            return run(QStringList(arguments).replaceInStrings("FILE", name), bytes);
        };
        const Result whole = of(file);
        QVERIFY2(whole.status == 0 && whole.out.count('\n') > 2, whole.err);
        for (const char *pipe : {"-", "/dev/stdin"}) {
            const Result piped = of(pipe);
            QVERIFY2(piped.status == 0, piped.err);
            QVERIFY2(piped.out == whole.out, pipe);
        }
    }

    void oneSensorOfSeveralIsTaken_data() {
        QTest::addColumn<QStringList>("options");
        QTest::addColumn<double>("range");
        QTest::newRow("the first") << QStringList() << 5.0;
        QTest::newRow("by its port") << QStringList{"--port", "2369"} << 6.0;
        QTest::newRow("by its address") << QStringList{"--sender", "192.168.1.203"} << 7.0;
        QTest::newRow("by both") << QStringList{"--port", "2368", "--sender", "192.168.1.203"} << 7.0;
    }
    void oneSensorOfSeveralIsTaken() {
        QFETCH(QStringList, options);
        QFETCH(double, range);
        writeCapture(path("c.pcap"), 400,
                     {{0xC0A801C9, 2368, 5}, {0xC0A801CA, 2369, 6}, {0xC0A801CB, 2368, 7}});
        const Result ring = run(QStringList{"ring", path("c.pcap")} + options);
        QCOMPARE(ring.status, 0);
        QCOMPARE(rangesOf(ring.out), QSet<double>{range});
        QCOMPARE(ring.out.count('\n'), 4801);
        for (const char *told : {"192.168.1.201:2368 to port 2368 (400 packets)",
                                 "192.168.1.202:2369 to port 2369 (400 packets)",
                                 "192.168.1.203:2368 to port 2368 (400 packets)", "--port", "--sender"})
            QVERIFY2(ring.err.contains(told), ring.err.constData());
        const Result map = run(QStringList{"map", path("c.pcap"), "--out-map", path("m.csv")} + options);
        QVERIFY2(map.status == 0, map.err.constData());
        QCOMPARE(json(map.out)["scans"].toInt(), 3);
        QVERIFY2(map.err.contains("read 192.168.1.20"), map.err.constData());
        for (const QByteArray &line : contents(path("m.csv")).trimmed().split('\n').mid(1)) {
            const QList<QByteArray> edge = line.split(',');
            QVERIFY2(std::abs(std::hypot(edge[1].toDouble(), edge[2].toDouble()) - range) < 0.1, line);
        }
    }

    void ofTwoModelsTheOneAskedForIsTaken() {
        writeCapture(path("c.pcap"), 400,
                     {{0xC0A801C9, 2368, 5, Model::Hdl32e}, {0xC0A801CA, 2368, 6, Model::Vlp16}});
        QCOMPARE(rangesOf(run({"ring", path("c.pcap"), "--model", "vlp16"}).out), QSet<double>{6});
        QCOMPARE(rangesOf(run({"ring", path("c.pcap")}).out), QSet<double>{5});
    }

    void whatIsMissingIsTold_data() {
        QTest::addColumn<QStringList>("options");
        QTest::addColumn<QByteArray>("told");
        QTest::newRow("port") << QStringList{"--port", "2370"}
                              << QByteArray(
                                     "found data packets of 192.168.1.201:4711 to port 4711 (400 packets) "
                                     "only, expected some to port 2370");
        QTest::newRow("sender") << QStringList{"--sender", "10.0.0.1"}
                                << QByteArray("only, expected some from 10.0.0.1");
    }
    void whatIsMissingIsTold() {
        QFETCH(QStringList, options);
        QFETCH(QByteArray, told);
        writeCapture(path("c.pcap"), 400, {{0xC0A801C9, 4711}});
        for (const char *command : {"ring", "map"}) {
            const Result r = run(QStringList{command, path("c.pcap"), "--out", path("out")} + options);
            QCOMPARE(r.status, 1);
            QVERIFY2(r.err.contains(told), r.err.constData());
            QCOMPARE(folder_.files(), QStringList{"c.pcap"});
        }
    }

    // As tcpdump writes that keeps the beginnings of frames only.
    void whatIsLeftOutIsTold() {
        writeCapture(path("c.pcap"), 400);
        const QByteArray whole = contents(path("c.pcap"));
        const int header = int(hermes::PcapWriter::fileHeaderBytes), record = (whole.size() - header) / 400;
        QByteArray cut = whole.left(header);
        for (int i = 0; i < 400; ++i) {
            QByteArray one = whole.mid(header + i * record, 16 + 96);
            qToLittleEndian<quint32>(96, one.data() + 8);
            cut += one;
        }
        write(path("cut.pcap"), cut);
        write(path("half.pcap"), whole + cut.mid(header));
        for (const char *command : {"ring", "map"}) {
            const Result none = run({command, path("cut.pcap")}), half = run({command, path("half.pcap")});
            QCOMPARE(none.status, 1);
            QVERIFY2(none.err.contains("400 cut to their beginning"), none.err.constData());
            QCOMPARE(half.status, 0);
            QVERIFY2(half.err.contains("of 800 records were left out: 400 cut"), half.err.constData());
        }
    }

    void capturesWithoutDataPacketsAreRefused() {
        writeCapture(path("c.pcap"), 0);
        appendForeign(path("c.pcap"), 2368);
        for (const char *command : {"ring", "map"}) {
            const Result r = run({command, path("c.pcap")});
            QCOMPARE(r.status, 1);
            QVERIFY2(r.err.contains("1206 bytes whose blocks begin with FF EE"), r.err.constData());
        }
    }
};

QTEST_GUILESS_MAIN(TestVectorCaptures)
#include "TestVectorCaptures.moc"
