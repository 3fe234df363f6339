#include "common/capture/Frame.h"
#include "common/capture/PcapReader.h"
#include "common/capture/PcapWriter.h"
#include "protocol/velodyne/TurnAssembler.h"
#include "tests/support/Texts.h"

using namespace hermes;

class TestCapture : public QObject {
    Q_OBJECT

    static constexpr std::uint32_t sensorAddress = 0xC0A801C8; // 192.168.1.200

    static Datagram datagram(const QByteArray &payload, std::int64_t stamp_ns = 1700000000123456789) {
        Datagram d;
        d.stamp_ns = stamp_ns;
        d.source = sensorAddress;
        d.destination = 0xFFFFFFFF;
        d.sourcePort = d.destinationPort = 2368;
        d.payload = reinterpret_cast<const std::uint8_t *>(payload.constData());
        d.size = std::size_t(payload.size());
        return d;
    }

    static QByteArray frameOf(const Datagram &d) {
        const auto header = makeFrameHeader(d);
        return QByteArray(reinterpret_cast<const char *>(header.data()), int(header.size())) +
               QByteArray(reinterpret_cast<const char *>(d.payload), int(d.size));
    }

    static FrameFault parse(const QByteArray &frame, Datagram &d, LinkType link = LinkType::Ethernet) {
        // A copy of its exact size, so that a sanitizer sees a read beyond it.
        const std::vector<std::uint8_t> bytes(frame.begin(), frame.end());
        const FrameFault fault = parseFrame(link, bytes.data(), bytes.size(), d);
        d.payload = nullptr;
        return fault;
    }

    /// A capture of count datagrams of 100 bytes, the first byte counting; its path.
    static std::string makeCapture(const QTemporaryDir &folder, int count) {
        const std::string path = folder.filePath(QStringLiteral("c.pcap")).toStdString();
        PcapWriter writer;
        if (const auto done = writer.open(path, true); !done)
            qFatal("%s", done.error().c_str());
        for (int i = 0; i < count; ++i)
            writer.write(datagram(QByteArray(100, char(i)), 1700000000123456789 + i));
        if (const auto done = writer.close(); !done)
            qFatal("%s", done.error().c_str());
        return path;
    }

private Q_SLOTS:
    void checksumIsThatOfARealSensor() {
        // The real frame has identification 0, no fragments, time to live 255 and checksum B4 AA; ours lives
        // 64: BF00 more.
        const QByteArray frame = frameOf(datagram(QByteArray(1206, 'x')));
        const auto *bytes = reinterpret_cast<const uchar *>(frame.constData());
        QCOMPARE(qFromBigEndian<quint16>(bytes + 16), quint16(1234));
        quint32 sum = 0;
        for (int i = 14; i < 34; i += 2)
            sum += qFromBigEndian<quint16>(bytes + i);
        QCOMPARE((sum & 0xFFFF) + (sum >> 16), 0xFFFFu);
        QCOMPARE(quint32(qFromBigEndian<quint16>(bytes + 24)), (0xB4AAu + 0xBF00u) % 0xFFFFu);
    }

    void readsWhatItWrote() {
        QTemporaryDir folder;
        PcapReader reader;
        QVERIFY2(reader.open(makeCapture(folder, 200)), reader.error().c_str());
        Datagram d;
        for (int i = 0; i < 200; ++i) {
            QCOMPARE(reader.next(d), PcapReader::Next::Datagram);
            QCOMPARE(qint64(d.stamp_ns), qint64(1700000000123456789 + i));
            QCOMPARE(d.source, sensorAddress);
            QCOMPARE(d.destinationPort, quint16(2368));
            QCOMPARE(QByteArray(reinterpret_cast<const char *>(d.payload), int(d.size)),
                     QByteArray(100, char(i)));
        }
        QCOMPARE(reader.next(d), PcapReader::Next::End);
        QCOMPARE(reader.next(d), PcapReader::Next::End);
        QCOMPARE(reader.counts().datagrams, std::uint64_t(200));
    }

    // A quarter of an hour of an HDL-32E is more than a long of 32 bits can count. The file has a hole.
    void readsBehindTwoGigabytes() {
        QTemporaryDir folder;
        const std::string path = makeCapture(folder, 2);
        QFile file(QString::fromStdString(path));
        QVERIFY(file.open(QIODevice::ReadWrite));
        const qint64 begin = qint64(PcapWriter::fileHeaderBytes), size = (file.size() - begin) / 2;
        QVERIFY(file.seek(begin + size));
        const QByteArray second = file.read(size);
        constexpr qint64 far = qint64(3) << 30;
        QVERIFY(file.seek(far));
        QCOMPARE(file.write(second), size);
        file.close();
        PcapReader reader;
        Datagram d;
        QVERIFY2(reader.open(path), reader.error().c_str());
        QVERIFY2(reader.seek({far, 2}), reader.error().c_str());
        QCOMPARE(reader.next(d), PcapReader::Next::Datagram);
        QCOMPARE(int(d.payload[0]), 1);
        QCOMPARE(qint64(reader.place().offset), far + size);
    }

    void lengthOfUdpCounts() {
        QByteArray frame = frameOf(datagram(QByteArray(512, 'p')));
        frame[16] = char(0x04); // the total length of a data packet, as real position packets have it
        frame[17] = char(0xD2);
        Datagram d;
        QCOMPARE(parse(frame, d), FrameFault::None);
        QCOMPARE(d.size, std::size_t(512));
        QCOMPARE(parse(frame + QByteArray(6, '\0'), d), FrameFault::None); // padding of the link layer
        QCOMPARE(d.size, std::size_t(512));
    }

    void tagsAreSteppedOver() {
        QByteArray frame = frameOf(datagram("payload"));
        Datagram d;
        frame.insert(12, QByteArray::fromHex("8100000a"));
        QCOMPARE(parse(frame, d), FrameFault::None);
        frame.insert(12, QByteArray::fromHex("88a8000b"));
        QCOMPARE(parse(frame, d), FrameFault::None);
        for (const char *old : {"91000001", "92000002", "93000003"}) {
            frame.insert(12, QByteArray::fromHex(old));
            QCOMPARE(parse(frame, d), FrameFault::None);
        }
        QCOMPARE(d.size, std::size_t(7));
    }

    void otherFramesAreTold_data() {
        const Rows<QByteArray, int> row("frame", "fault");
        const QByteArray good = frameOf(datagram("payload"));
        const auto with = [&](int offset, int value) {
            return QByteArray(good).replace(offset, 1, QByteArray(1, char(value)));
        };
        row("empty", QByteArray(), int(FrameFault::Short));
        row("link header only", good.left(14), int(FrameFault::Short));
        row("cut in IPv4", good.left(30), int(FrameFault::Short));
        row("cut in UDP", good.left(40), int(FrameFault::Short));
        row("cut in payload", good.left(45), int(FrameFault::Short));
        row("UDP length 7", with(39, 7), int(FrameFault::Short));
        row("header length 16", with(14, 0x44), int(FrameFault::Short));
        row("header length 60", with(14, 0x4F), int(FrameFault::Short));
        row("ARP", with(13, 6), int(FrameFault::NotUdp));
        row("version 6", with(14, 0x65), int(FrameFault::NotUdp));
        row("TCP", with(23, 6), int(FrameFault::NotUdp));
        row("first fragment", with(20, 0x20), int(FrameFault::Fragment));
        row("later fragment", with(21, 0x10), int(FrameFault::Fragment));
    }

    void otherFramesAreTold() {
        FETCH(QByteArray, frame, int, fault);
        Datagram d;
        QCOMPARE(int(parse(frame, d)), fault);
    }

    void randomFramesDoNoHarm() {
        std::mt19937 random(newSeed());
        const QByteArray good = frameOf(datagram(QByteArray(60, 'x')));
        for (int round = 0; round < 20000; ++round) {
            QByteArray frame = good.left(int(random() % unsigned(good.size() + 1)));
            for (int i = 0; i < 3 && !frame.isEmpty(); ++i)
                frame[int(random() % unsigned(frame.size()))] = char(random());
            Datagram d;
            for (const LinkType link :
                 {LinkType::Null, LinkType::Ethernet, LinkType::Raw, LinkType::LinuxCooked2})
                parse(frame, d, link);
        }
    }

    void refusesToOverwrite() {
        QTemporaryDir folder;
        const std::string path = makeCapture(folder, 3);
        PcapWriter writer;
        const auto exists = writer.open(path);
        QVERIFY(!exists);
        QVERIFY2(exists.error().find("exists already") != std::string::npos, exists.error().c_str());
        QVERIFY(!writer.write(datagram("x")));
        QCOMPARE(QFile(QString::fromStdString(path)).size(), qint64(24 + 3 * (16 + 142)));
        QCOMPARE(writer.open("/nonexistent/c.pcap").error(),
                 std::string("/nonexistent/c.pcap: cannot be created: No such file or directory"));
    }

    void fullDiskIsReported() {
        if (!QFile::exists(QStringLiteral("/dev/full")))
            QSKIP("there is no /dev/full");
        // A link, so that cleaning up removes the link and not the device.
        QTemporaryDir folder;
        const QString path = folder.filePath(QStringLiteral("full.pcap"));
        QVERIFY(QFile::link(QStringLiteral("/dev/full"), path));
        PcapWriter writer;
        const auto full = writer.open(path.toStdString(), true);
        QVERIFY(!full);
        QVERIFY2(full.error().find("No space left on device") != std::string::npos, full.error().c_str());
        QVERIFY(full.error().find(path.toStdString()) == 0);
        QVERIFY(!QFileInfo(path).isSymLink());
    }

    void cutFilesNameRecordAndByte_data() {
        const Rows<int> row("keep"); // bytes of the third record, which has 16 + 142
        row("in the record's header", 7);
        row("behind the header", 16);
        row("in the frame", 100);
        row("one byte short", 157);
    }

    void cutFilesNameRecordAndByte() {
        QFETCH(int, keep);
        QTemporaryDir folder;
        const std::string path = makeCapture(folder, 5);
        const int third = 24 + 2 * 158;
        QVERIFY(QFile::resize(QString::fromStdString(path), third + keep));
        PcapReader reader;
        QVERIFY(reader.open(path));
        Datagram d;
        QCOMPARE(reader.next(d), PcapReader::Next::Datagram);
        QCOMPARE(reader.next(d), PcapReader::Next::Datagram);
        QCOMPARE(reader.next(d), PcapReader::Next::Failed);
        const std::string begin =
            path + ": record 3 at byte " + std::to_string(third) + " cannot be read, the 2 before it";
        QVERIFY2(reader.error().find(begin) == 0, reader.error().c_str());
        QCOMPARE(reader.next(d), PcapReader::Next::Failed);
    }

    void filesThatAreNoCapture_data() {
        const Rows<QByteArray> row("content");
        row("empty", QByteArray());
        row("cut in the file header", QByteArray::fromHex("4d3cb2a10200"));
        row("text", "1.0,2.0\n1.1,2.1\n1.2,2.2\n");
    }

    void filesThatAreNoCapture() {
        QFETCH(QByteArray, content);
        QTemporaryDir folder;
        const QString file = folder.filePath(QStringLiteral("c.pcap"));
        put(file, content);
        PcapReader reader;
        QVERIFY(!reader.open(file.toStdString()));
        QVERIFY2(reader.error().find(file.toStdString() + ": not a capture") == 0, reader.error().c_str());
        QVERIFY(!reader.open("/nonexistent/c.pcap"));
        QCOMPARE(QByteArray::fromStdString(reader.error()),
                 QByteArray("/nonexistent/c.pcap: cannot be opened: No such file or directory"));
        QCOMPARE(::mkfifo(qPrintable(folder.filePath("pipe")), 0600), 0); // nobody writes
        QVERIFY(!reader.open(folder.filePath("pipe").toStdString()));
        VERIFY_CONTAINS(QString::fromStdString(reader.error()), "pipe: not a regular file");
        Datagram d;
        QCOMPARE(reader.next(d), PcapReader::Next::Failed);
    }

    /// pcapng: a section, an Ethernet interface whose stamps count seconds, and a datagram far in the future.
    void stampsBeyondNanosecondsAreRefused() {
        const auto words = [](std::initializer_list<quint32> values) {
            QByteArray bytes;
            for (const quint32 value : values)
                bytes += QByteArray(reinterpret_cast<const char *>(&value), 4);
            return bytes;
        };
        const QByteArray frame = frameOf(datagram("ab")); // 44 bytes: nothing to fill up
        const auto record = [&](quint32 high, quint32 low) {
            return words({6, 76, 0, high, low, 44, 44}) + frame + words({76});
        };
        QTemporaryDir folder;
        const QString file = folder.filePath("future.pcapng");
        put(file, words({0x0A0D0D0A, 28, 0x1A2B3C4D, 1, 0xFFFFFFFF, 0xFFFFFFFF, 28}) +
                      words({1, 32, 1, 0, 0x00010009, 0, 0, 32}) + // option 9: a tick is 10^-0 s
                      record(0, 1700000000) + record(0x7FFFFFFF, 0));
        PcapReader reader;
        QVERIFY2(reader.open(file.toStdString()), reader.error().c_str());
        Datagram d;
        QCOMPARE(reader.next(d), PcapReader::Next::Datagram);
        QCOMPARE(qint64(d.stamp_ns), qint64(1700000000) * 1000000000);
        QCOMPARE(reader.next(d), PcapReader::Next::Failed);
        QVERIFY2(reader.error().find("record 2 at byte 136 has a stamp of") != std::string::npos,
                 reader.error().c_str());
    }

    void tsharkReadsIt() {
        if (QStandardPaths::findExecutable(QStringLiteral("tshark")).isEmpty())
            QSKIP("tshark is not installed");
        QTemporaryDir folder;
        const QString path = QString::fromStdString(makeCapture(folder, 10));
        QProcess tshark;
        tshark.start(QStringLiteral("tshark"),
                     {QStringLiteral("-r"), path, QStringLiteral("-o"),
                      QStringLiteral("ip.check_checksum:TRUE"), QStringLiteral("-T"),
                      QStringLiteral("fields"), QStringLiteral("-e"), QStringLiteral("frame.time_epoch"),
                      QStringLiteral("-e"), QStringLiteral("ip.src"), QStringLiteral("-e"),
                      QStringLiteral("ip.checksum.status"), QStringLiteral("-e"),
                      QStringLiteral("udp.length"), QStringLiteral("-e"), QStringLiteral("_ws.malformed")});
        QVERIFY(tshark.waitForFinished(60000));
        QCOMPARE(tshark.exitCode(), 0);
        const QList<QByteArray> lines = tshark.readAllStandardOutput().trimmed().split('\n');
        QCOMPARE(lines.size(), 10);
        QCOMPARE(lines[9], QByteArray("1700000000.123456798\t192.168.1.200\t1\t108"));
    }

    void realRecording() {
        REAL_DATA(path, "hdl32e-outdoor.pcap");
        PcapReader reader;
        QVERIFY2(reader.open(path.toStdString()), reader.error().c_str());
        std::vector<bool> partial;
        std::size_t points = 0;
        velodyne::TurnAssembler assembler({}, [&](const velodyne::Turn &turn) {
            partial.push_back(turn.partial);
            points += turn.points.size();
        });
        Datagram d;
        PcapReader::Next next;
        while ((next = reader.next(d)) == PcapReader::Next::Datagram)
            QCOMPARE(assembler.feed(d.payload, d.size, d.stamp_ns), velodyne::PacketFault::None);
        QCOMPARE(next, PcapReader::Next::End);
        assembler.finish();
        QCOMPARE(partial, (std::vector<bool>{true, false, partial.size() == 4 ? false : true, true}));
        QVERIFY(points > 1000 && points < 6000);
        QCOMPARE(assembler.counts().packets, std::uint64_t(500));
        QCOMPARE(assembler.counts().lost + assembler.counts().outOfOrder, std::uint64_t(0));
    }

    void realPositionPacketHasAWrongLength() {
        REAL_DATA(path, "velodyne-position-packet.pcap");
        PcapReader reader;
        QVERIFY2(reader.open(path.toStdString()), reader.error().c_str());
        Datagram d;
        QCOMPARE(reader.next(d), PcapReader::Next::Datagram);
        QCOMPARE(d.size, velodyne::positionPacketSize);
        QCOMPARE(d.destinationPort, velodyne::positionPort);
    }
};
