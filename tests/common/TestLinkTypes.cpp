// Capture files of every link type, written byte by byte: what the message lists is read, and nothing else.
#include "common/capture/Frame.h"
#include "common/capture/PcapReader.h"

using namespace hermes;

class TestLinkTypes : public QObject {
    Q_OBJECT

    // IPv4 from 192.168.1.201, UDP from port 2368 to 2369, "payload".
    static inline const QByteArray ipFrame = QByteArray::fromHex("450000230000400040117859c0a801c9ffffffff"
                                                                 "09400941000f0000"
                                                                 "7061796c6f6164");

    /// What stands before the IPv4 header, by the number of the link type in the file.
    static inline const QMap<int, QByteArray> linkHeaders = {
        {0, QByteArray::fromHex("02000000")}, // the family, of a little-endian host
        {1, QByteArray::fromHex("ffffffffffff607688000000") + "\x08" + '\0'}, // addresses, EtherType
        {12, {}},
        {14, {}},
        {101, {}},
        {108, QByteArray::fromHex("00000002")},                         // the family, big-endian
        {113, QByteArray::fromHex("00000001000660768800000000000800")}, // Linux cooked: EtherType last
        {228, {}},
        {276, QByteArray::fromHex("0800000000000002000100066076880000000000")}, // and first
    };

    static QByteArray words(std::initializer_list<quint32> values) {
        QByteArray bytes;
        for (const quint32 value : values) {
            for (int shift = 0; shift < 32; shift += 8)
                bytes += char(value >> shift);
        }
        return bytes;
    }

    static QByteArray pcapFile(int link, const QByteArray &frame) {
        const quint32 size = quint32(frame.size());
        return words({0xA1B2C3D4, 0x00040002, 0, 0, 65535, quint32(link)}) +
               words({1700000000, 123456, size, size}) + frame;
    }

    static QByteArray pcapngFile(int link, const QByteArray &frame) {
        const quint32 size = quint32(frame.size()), padded = (size + 3) / 4 * 4;
        return words({0x0A0D0D0A, 28, 0x1A2B3C4D, 1, 0xFFFFFFFF, 0xFFFFFFFF, 28}) +
               words({1, 20, quint32(link), 65535, 20}) +
               words({6, 32 + padded, 0, 0x00060A24, 0x181E5240, size, size}) + frame +
               QByteArray(int(padded - size), '\0') + words({32 + padded});
    }

    static std::string write(const QTemporaryDir &folder, const QByteArray &content) {
        put(folder.filePath("c.pcap"), content);
        return folder.filePath("c.pcap").toStdString();
    }

private Q_SLOTS:
    void datagramsAreRead_data() {
        QTest::addColumn<QByteArray>("content");
        for (auto link = linkHeaders.begin(); link != linkHeaders.end(); ++link) {
            QTest::addRow("pcap %d", link.key()) << pcapFile(link.key(), link.value() + ipFrame);
            QTest::addRow("pcapng %d", link.key()) << pcapngFile(link.key(), link.value() + ipFrame);
        }
    }

    void datagramsAreRead() {
        QFETCH(QByteArray, content);
        QTemporaryDir folder;
        PcapReader reader;
        QVERIFY2(reader.open(write(folder, content)), reader.error().c_str());
        Datagram datagram;
        QCOMPARE(reader.next(datagram), PcapReader::Next::Datagram);
        QCOMPARE(datagram.source, 0xC0A801C9u);
        QCOMPARE(datagram.sourcePort, quint16(2368));
        QCOMPARE(datagram.destinationPort, quint16(2369));
        QCOMPARE(QByteArray(reinterpret_cast<const char *>(datagram.payload), int(datagram.size)),
                 QByteArray("payload"));
        QCOMPARE(reader.next(datagram), PcapReader::Next::End);
    }

    void tsharkSeesTheSame_data() {
        QTest::addColumn<int>("link");
        for (const int link : linkHeaders.keys()) {
            if (link != int(LinkType::RawOpenBsd)) // it does not know this one
                QTest::addRow("%d", link) << link;
        }
    }

    void tsharkSeesTheSame() {
        if (QStandardPaths::findExecutable("tshark").isEmpty())
            QSKIP("tshark is not installed");
        QFETCH(int, link);
        const QByteArray content = pcapFile(link, linkHeaders[link] + ipFrame);
        QTemporaryDir folder;
        QProcess tshark;
        tshark.start("tshark", {"-r", QString::fromStdString(write(folder, content)), "-T", "fields", "-e",
                                "ip.src", "-e", "udp.dstport", "-e", "udp.length"});
        QVERIFY(tshark.waitForFinished(60000));
        QCOMPARE(tshark.readAllStandardOutput().trimmed(), QByteArray("192.168.1.201\t2369\t15"));
    }

    void theMessageListsExactlyWhatIsRead() {
        QTemporaryDir folder;
        QList<int> read;
        QString message;
        for (int link = 0; link < 400; ++link) {
            PcapReader reader;
            if (reader.open(write(folder, pcapFile(link, linkHeaders.value(link) + ipFrame))))
                read.append(link);
            else if (link == 105)
                message = QString::fromStdString(reader.error());
        }
        VERIFY_CONTAINS(message, "link type 105 is not read; read are ");
        QList<int> listed;
        auto numbers = QRegularExpression("\\((\\d+)\\)").globalMatch(message.section("read are ", 1));
        while (numbers.hasNext())
            listed.append(numbers.next().captured(1).toInt());
        QCOMPARE(listed, read);
        QCOMPARE(read, linkHeaders.keys());
    }

    void otherProtocolsAreCounted() {
        QTemporaryDir folder;
        PcapReader reader;
        const QByteArray ipv6 =
            QByteArray::fromHex("60000000000f1140") + QByteArray(32, '\0') + ipFrame.mid(20);
        QVERIFY2(reader.open(write(folder, pcapFile(101, ipv6))), reader.error().c_str());
        Datagram datagram;
        QCOMPARE(reader.next(datagram), PcapReader::Next::End);
        QCOMPARE(reader.counts().notUdp, std::uint64_t(1));
    }
};
