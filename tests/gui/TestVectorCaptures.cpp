// hermes-vector ring and map find the data packets of a capture by what they are, and take those of one
// sensor.
#include "VectorProgram.h"

using hermes::velodyne::Model;

class TestVectorCaptures : public QObject, protected TestFolder {
    Q_OBJECT

    /// The ranges that ring printed, each once.
    static QSet<double> rangesOf(const QByteArray &csv) {
        QSet<double> ranges;
        for (const QByteArray &line : csv.trimmed().split('\n').mid(1))
            ranges.insert(line.split(',').at(3).toDouble());
        return ranges;
    }

    /// A datagram of other programs, of the size of a data packet.
    static void appendForeign(const QString &path, quint16 port) {
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
        const QByteArray record = contentOf(copy).mid(int(PcapWriter::fileHeaderBytes));
        QFile::remove(copy);
        put(path, contentOf(path) + record);
    }

private Q_SLOTS:
    void init() { empty(); }

    void anyPortIsRead() {
        writeCapture(path("usual.pcap"), 400);
        writeCapture(path("other.pcap"), 400, {{0xC0A801C9, 4711}});
        appendForeign(path("other.pcap"), 5000);
        const Result usual = run({"ring", path("usual.pcap")}), other = run({"ring", path("other.pcap")});
        QCOMPARE(other.err, QByteArray());
        QCOMPARE(other.status, 0);
        QCOMPARE(other.out, usual.out);
        const Result map = ran({"map", path("other.pcap")});
        QCOMPARE(json(map.out)["scans"].toInt(), 3);
    }

    // A pipe can be read only once: what tells its kind must not be lost.
    void pipesAreReadFromTheirBeginning_data() {
        const Rows<QStringList, QString> row("arguments", "file");
        row("points", {"segment", "FILE"}, QString(data("room.csv")));
        row("log", {"map", "FILE", "--corrected", "--out-trajectory", "-", "--summary", path("s")},
            QString(data("corrected.log")));
        row("capture", {"ring", "FILE"}, path("capture.pcap"));
        row("capture to map", {"map", "FILE", "--out-trajectory", "-", "--summary", path("s")},
            path("capture.pcap"));
    }
    void pipesAreReadFromTheirBeginning() {
        FETCH(QStringList, arguments, QString, file);
        writeCapture(path("capture.pcap"), 800);
        const QByteArray bytes = contentOf(file);
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
        const Rows<QStringList, double> row("options", "range");
        row("the first", QStringList(), 5.0);
        row("by its port", {"--port", "2369"}, 6.0);
        row("by its address", {"--sender", "192.168.1.203"}, 7.0);
        row("by both", {"--port", "2368", "--sender", "192.168.1.203"}, 7.0);
    }
    void oneSensorOfSeveralIsTaken() {
        FETCH(QStringList, options, double, range);
        writeCapture(path("c.pcap"), 400,
                     {{0xC0A801C9, 2368, 5}, {0xC0A801CA, 2369, 6}, {0xC0A801CB, 2368, 7}});
        const Result ring = ran(QStringList{"ring", path("c.pcap")} + options);
        QCOMPARE(rangesOf(ring.out), QSet<double>{range});
        QCOMPARE(ring.out.count('\n'), 4801);
        for (const char *told : {"192.168.1.201:2368 to port 2368 (400 packets)",
                                 "192.168.1.202:2369 to port 2369 (400 packets)",
                                 "192.168.1.203:2368 to port 2368 (400 packets)", "--port", "--sender"})
            QVERIFY2(ring.err.contains(told), ring.err.constData());
        const Result map = ran(QStringList{"map", path("c.pcap"), "--out-map", path("m.csv")} + options);
        QCOMPARE(json(map.out)["scans"].toInt(), 3);
        QVERIFY2(map.err.contains("read 192.168.1.20"), map.err.constData());
        for (const QByteArray &line : contentOf(path("m.csv")).trimmed().split('\n').mid(1)) {
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
        const Rows<QStringList, QByteArray> row("options", "told");
        row("port", {"--port", "2370"},
            "found data packets of 192.168.1.201:4711 to port 4711 (400 packets) "
            "only, expected some to port 2370");
        row("sender", {"--sender", "10.0.0.1"}, "only, expected some from 10.0.0.1");
    }
    void whatIsMissingIsTold() {
        FETCH(QStringList, options, QByteArray, told);
        writeCapture(path("c.pcap"), 400, {{0xC0A801C9, 4711}});
        for (const char *command : {"ring", "map"}) {
            refused(run(QStringList{command, path("c.pcap"), "--out", path("out")} + options), 1, told);
            QCOMPARE(files(), QStringList{"c.pcap"});
        }
    }

    // As tcpdump writes that keeps the beginnings of frames only.
    void whatIsLeftOutIsTold() {
        writeCapture(path("c.pcap"), 400);
        const QByteArray whole = contentOf(path("c.pcap"));
        const int header = int(hermes::PcapWriter::fileHeaderBytes), record = (whole.size() - header) / 400;
        QByteArray cut = whole.left(header);
        for (int i = 0; i < 400; ++i) {
            QByteArray one = whole.mid(header + i * record, 16 + 96);
            qToLittleEndian<quint32>(96, one.data() + 8);
            cut += one;
        }
        put(path("cut.pcap"), cut);
        put(path("half.pcap"), whole + cut.mid(header));
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
            refused(run({command, path("c.pcap")}), 1, "1206 bytes whose blocks begin with FF EE");
        }
    }
};
