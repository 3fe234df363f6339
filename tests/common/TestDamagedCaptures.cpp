// Captures that are damaged, at random or beyond a limit.
#include "common/capture/PcapReader.h"
#include "tests/common/CaptureFiles.h"

using namespace hermes;
using namespace hermes::captures;

class TestDamagedCaptures : public QObject {
    Q_OBJECT

    static QByteArray classic(quint32 limit, quint32 frame, quint16 part = 4) {
        Writer file(false);
        file.word(0xA1B2C3D4).half(2).half(part).word(0).word(0).word(limit).word(1);
        file.word(1700000000).word(0).word(frame).word(frame);
        return file.content + QByteArray(int(frame), 'x');
    }

    /// The headers of a section and of one interface for each link type; options are those of each.
    static QByteArray pcapng(const QList<quint16> &links, quint32 limit = 0, const QByteArray &options = {}) {
        Writer file(false);
        file.block(0x0A0D0D0A, Writer(false).word(0x1A2B3C4D).half(1).half(0).number(~0ULL, 8).content);
        for (const quint16 link : links)
            file.block(1, Writer(false).half(link).half(0).word(limit).content + options);
        return file.content;
    }

    static QByteArray block(quint32 type, const QByteArray &body) {
        Writer file(false);
        file.block(type, body);
        return file.content;
    }

    static QByteArray packet(quint32 interface, const QByteArray &frame, quint64 ticks = 0) {
        Writer body(false);
        body.word(interface).word(quint32(ticks >> 32)).word(quint32(ticks));
        body.word(quint32(frame.size())).word(quint32(frame.size()));
        return block(6, body.content + frame);
    }

    static QByteArray resolution(quint8 value) { return Writer(false).half(9).half(1).word(value).content; }

    /// UDP in IPv4 in Ethernet.
    static inline const QByteArray datagramFrame =
        QByteArray::fromHex("ffffffffffff607688000000"
                            "0800"
                            "450000230000400040117859c0a801c9ffffffff"
                            "09400941000f0000"
                            "7061796c6f6164");

private Q_SLOTS:
    /// Cut or with other bytes in it: records before the damage are those of the whole file.
    void damagedFilesDoNoHarm() {
        Generator generator(newSeed());
        for (int round = 0; round < 5000; ++round) {
            const QByteArray content = round % 2 ? generator.pcapng() : generator.classic();
            const Reading whole = ours(content),
                          cut = ours(content.left(int(generator.below(quint32(content.size())))));
            QVERIFY(cut.records.size() <= whole.records.size());
            QVERIFY(std::equal(cut.records.begin(), cut.records.end(), whole.records.begin()));
            QByteArray damaged = content;
            for (int i = 0; i < 3; ++i)
                damaged[int(generator.below(quint32(damaged.size())))] = char(generator.below(256));
            ours(damaged);
        }
    }

    void limits_data() {
        const Rows<QByteArray, int> row("content", "length"); // length: of the frame that is read; -1: none
        const auto frame = [](int size) { return QByteArray(size, 'x'); };
        row("classic, cut at the limit", classic(45, 52), 45);
        row("classic, no limit", classic(0, 52), 52);
        row("classic, longest frame", classic(400000, 262144), 262144);
        row("classic, longer", classic(400000, 262145), -1);
        row("classic, version 2.5", classic(400000, 52, 5), -1);
        row("longest frame", pcapng({1}) + packet(0, frame(262144)), 262144);
        row("longer", pcapng({1}) + packet(0, frame(262148)), -1);
        row("longest of the interface", pcapng({1}, 300000) + packet(0, frame(300000)), 300000);
        row("longer than the interface's", pcapng({1}, 300000) + packet(0, frame(300004)), -1);
        row("simple, cut at the interface's",
            pcapng({1}, 20) + block(3, Writer(false).word(52).content + frame(52)), 20);
        row("longest block", pcapng({1}) + block(77, frame((16 << 20) - 12)) + packet(0, frame(9)), 9);
        row("longer block", pcapng({1}) + block(77, frame((16 << 20) - 8)) + packet(0, frame(9)), -1);
        row("ticks of 10^-19 s", pcapng({1}, 0, resolution(19)) + packet(0, frame(9)), 9);
        row("ticks of 10^-20 s", pcapng({1}, 0, resolution(20)) + packet(0, frame(9)), -1);
        row("ticks of 2^-63 s", pcapng({1}, 0, resolution(0x80 | 63)) + packet(0, frame(9)), 9);
        row("ticks of 2^-64 s", pcapng({1}, 0, resolution(0x80 | 64)) + packet(0, frame(9)), -1);
    }

    void limits() {
        FETCH(QByteArray, content, int, length);
        const Reading reading = ours(content);
        QCOMPARE(reading.isOpened && !reading.failed, length >= 0);
        QCOMPARE(int(reading.records.size()), length >= 0 ? 1 : 0);
        if (length >= 0)
            QCOMPARE(reading.records.front().frame.size(), length);
    }

    void framesOfUnknownLinksAreSkipped() {
        std::istringstream stream(
            (pcapng({147, 1}) + packet(0, datagramFrame) + packet(1, datagramFrame)).toStdString());
        PcapReader reader;
        QVERIFY2(reader.open(stream, "two"), reader.error().c_str());
        Datagram datagram;
        QCOMPARE(reader.next(datagram), PcapReader::Next::Datagram);
        QCOMPARE(reader.next(datagram), PcapReader::Next::End);
        QCOMPARE(reader.counts().unknownLinks, std::uint64_t(1));
        QCOMPARE(reader.counts().records, std::uint64_t(2));
    }

    void withoutAKnownLinkItIsRefused() {
        std::istringstream stream((pcapng({147, 148}) + packet(0, datagramFrame)).toStdString());
        PcapReader reader;
        QVERIFY(!reader.open(stream, "none"));
        QVERIFY2(reader.error().find("link type 147 is not read") != std::string::npos,
                 reader.error().c_str());
    }

    /// Not that of the statistics before it.
    void errorsNameTheByteOfTheRecord() {
        const QByteArray before =
            pcapng({1}, 0, resolution(0)) + packet(0, datagramFrame) + block(5, "statistics..");
        const QByteArray late = packet(0, datagramFrame, quint64(1) << 40);
        for (const QByteArray &damaged : {before + late, before + late.left(late.size() - 1)}) {
            std::istringstream stream(damaged.toStdString());
            PcapReader reader;
            QVERIFY2(reader.open(stream, "late"), reader.error().c_str());
            Datagram datagram;
            QCOMPARE(reader.next(datagram), PcapReader::Next::Datagram);
            QCOMPARE(reader.next(datagram), PcapReader::Next::Failed);
            const std::string place = "late: record 2 at byte " + std::to_string(before.size()) + ' ';
            QVERIFY2(reader.error().rfind(place, 0) == 0, reader.error().c_str());
        }
    }
};
