// Bytes of RPLIDAR scanners to revolutions: the worked examples, damage, and the dialogue.
#include "tests/protocol/ScannerReader.h"

#include <QtTest>

#include <cmath>
#include <map>

using namespace hermes::scan;

namespace {

/// The capsule of form 82 whose head begins there: 1000 and 1001 mm, in turn.
std::string capsule(int start_q6) {
    std::string body{char(start_q6), char(start_q6 >> 8)};
    for (int i = 0; i < 16; ++i)
        body += bytesOf("A0 0F A5 0F 08");
    char sum = 0;
    for (const char byte : body)
        sum = char(sum ^ byte);
    return std::string{char(0xA0 | (sum & 15)), char(0x50 | (sum >> 4 & 15))} + body;
}

const QByteArray expressAnswer = "A5 5A 54 00 00 40 82", standardAnswer = "A5 5A 05 00 00 40 81";

/// An RPLIDAR that sends such capsules, 36 in a revolution of 144 ms, or in form 81 a packet for each beam.
struct RplidarSender {
    bool isExpress = true;
    double sample_s() const { return isExpress ? 125e-6 : 500e-6; }
    double packet_s() const { return isExpress ? 0.004 : 500e-6; }
    int packets() const { return isExpress ? 36 : 288; } ///< in a revolution
    double head_deg(int n) const { return n % packets() * 360.0 / packets(); }
    std::string packet(int n) const {
        const int head_q6 = int(head_deg(n) * 64);
        return isExpress ? capsule(head_q6)
                         : std::string{char(head_q6 == 0 ? 0xBD : 0xBE), char(head_q6 << 1 | 1),
                                       char(head_q6 >> 7), '\x48', '\x13'};
    }
    /// When the first beam of that was measured, and when the packet has come in.
    double begin_s(int n) const { return n * packet_s() - (isExpress ? 31 : 0) * sample_s(); }
    double arrival_s(int n) const {
        return n * packet_s() + (isExpress ? 84 : 5) * 10 / 256000.0 + 1.5 * sample_s();
    }
};

} // namespace

class TestScannersRplidar : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void standardExample() {
        ScannerReader reader("rplidar-a1");
        reader.feed(bytesOf("A5 5A 05 00 00 40 81"), 0);
        for (int i = 0; i < 8; ++i) // 10.00 degrees and on, by 1 degree
            reader.feed(
                std::string{char(0xBE), char((640 + 64 * i) << 1 | 1), char((640 + 64 * i) >> 7), 0x48, 0x13},
                0.001 * i);
        const std::vector<Beam> beams = reader.beams();
        QCOMPARE(beams.size(), std::size_t(8));
        QCOMPARE(beams.back().angle_deg, -10.0);
        QCOMPARE(beams.back().range_m, 1.234F);
        QCOMPARE(int(beams.back().intensity), 47 << 2);
    }

    void expressExample() {
        ScannerReader reader("rplidar-a1");
        reader.feed(bytesOf("A5 5A 54 00 00 40 82"), 0);
        reader.feed(capsule(0x8000), 0);
        reader.feed(capsule(32 * 64), 0.004);
        reader.feed(capsule(64 * 64), 0.008);
        reader.assembler.jump();
        // 1000 mm at -1 degree, 1001 mm at -2 degrees beside the head, which goes on by a degree.
        QCOMPARE(reader.revolutions.size(), std::size_t(1));
        std::map<int, int> ranges_mm;
        for (const Beam &beam : reader.revolutions[0].beams)
            ++ranges_mm[int(std::lround(beam.range_m * 1e3F))];
        QCOMPARE(ranges_mm, (std::map<int, int>{{1000, 32}, {1001, 32}}));
        std::vector<double> clockwise_deg;
        for (const Beam &beam : reader.revolutions[0].beams)
            if (std::lround(beam.range_m * 1e3F) == 1000)
                clockwise_deg.push_back(-beam.angle_deg);
        std::sort(clockwise_deg.begin(), clockwise_deg.end());
        QCOMPARE(clockwise_deg.front(), -1.0);
        QCOMPARE(clockwise_deg.back(), 61.0);
    }

    void dialogue_data() {
        QTest::addColumn<QByteArray>("model");
        QTest::addColumn<QByteArray>("info");
        QTest::addColumn<QByteArray>("answers");
        QTest::addColumn<QByteArray>("sent");
        const QByteArray health = "A552>A55A0300000006000000", express = "A55A5400004082";
        const auto typical = [](const char *form, const char *sample) {
            return QByteArray("A584047C00000059>A55A06000000207C0000000200 ") +
                   "A5840671000000020054>A55A080000002071000000" + sample +
                   " A5840675000000020050>A55A050000002075000000" + form;
        };
        QTest::newRow("A1") << QByteArray("rplidar-a1") << QByteArray("181D0107")
                            << health + " " + typical("84", "007D0000") + " A58205020000000020>A55A8400004084"
                            << QByteArray("dtr A525 A550 A552 A5FF04000000005E dtr A584047C00000059 "
                                          "A5840671000000020054 A5840675000000020050 A58205020000000020");
        QTest::newRow("A3") << QByteArray("rplidar-a3") << QByteArray("311D0107")
                            << health + " A5FF04000000005E>A55A04000000FF01000000 " +
                                   typical("84", "803E0000") + " A58205020000000020>A55A8400004084"
                            << QByteArray("dtr A525 A550 A552 A5FF04000000005E dtr A5F0029402C1 "
                                          "A584047C00000059 A5840671000000020054 A5840675000000020050 "
                                          "A58205020000000020");
        QTest::newRow("S2") << QByteArray("rplidar-s2") << QByteArray("711D0107")
                            << health + " " + typical("86", "401F0000") + " A58205020000000020>A55AAA00004086"
                            << QByteArray("A525 A550 A552 A5A802580255 A584047C00000059 "
                                          "A5840671000000020054 A5840675000000020050 A58205020000000020");
        QTest::newRow("old firmware") << QByteArray("rplidar-a1") << QByteArray("18140107")
                                      << health + " A559>A55A0400000015FC01FE00 A58205000000000022>" + express
                                      << QByteArray("dtr A525 A550 A552 A5FF04000000005E dtr A559 "
                                                    "A58205000000000022");
        QTest::newRow("no express") << QByteArray("rplidar-a1") << QByteArray("180F0107")
                                    << health + " A559>A55A0400000015FC01FE00 A520>A55A0500004081"
                                    << QByteArray("dtr A525 A550 A552 A5FF04000000005E dtr A559 "
                                                  "A58205000000000022 A520");
        QTest::newRow("typical is standard")
            << QByteArray("rplidar-c1") << QByteArray("411D0107")
            << health + " " + typical("81", "00C80000") + " A520>A55A0500004081"
            << QByteArray("A525 A550 A552 A5FF04000000005E A584047C00000059 A5840671000000020054 "
                          "A5840675000000020050 A520");
        QTest::newRow("fault") << QByteArray("rplidar-a1") << QByteArray("18140107")
                               << QByteArray("A552>A55A0300000006020400 A559>A55A0400000015FC01FE00 "
                                             "A58205000000000022>") +
                                      express
                               << QByteArray("dtr A525 A550 A552 A540 A5FF04000000005E dtr A559 "
                                             "A58205000000000022");
    }

    /// What is asked, in this order; answers are put as request>answer.
    void dialogue() {
        QFETCH(QByteArray, model);
        QFETCH(QByteArray, info);
        QFETCH(QByteArray, answers);
        QFETCH(QByteArray, sent);
        ScannerReader reader(model.constData());
        std::map<QByteArray, QByteArray> known{{"A550", "A55A1400000004" + info + QByteArray(32, '1')}};
        for (const QByteArray &pair : answers.split(' '))
            known[pair.split('>')[0]] = pair.split('>')[1];
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        QByteArrayList seen;
        while (t_s < 4.5) {
            const HostAction action = reader.nextAction(t_s, 4.5);
            if (action.dtr)
                seen += *action.dtr ? "raised" : "dtr";
            const QByteArray request = QByteArray::fromStdString(action.send).toHex().toUpper();
            if (!request.isEmpty())
                seen += request;
            if (request == "A540")
                QVERIFY(QString::fromStdString(reader.scanner->problem()).contains("0004"));
            if (known.count(request) > 0)
                reader.feed(bytesOf(known[request]), t_s);
            if (seen.join(' ') == sent)
                break;
        }
        QCOMPARE(seen.join(' '), sent);
        QCOMPARE(reader.scanner->identity().serial, std::string(32, '1'));
        QVERIFY(!reader.scanner->prerequisite().empty());
        QCOMPARE(reader.nextAction(t_s, t_s + 2.9).send, std::string()); // the motor comes to its speed
        QCOMPARE(reader.nextAction(t_s, t_s + 0.3).send, bytesOf("A525"));
    }

    /// A fault that lasts is told as long as it does.
    void fault() {
        ScannerReader reader("rplidar-a1");
        reader.scanner->opened(1);
        bool isTold = false;
        for (double t_s = 0; t_s < 20; t_s += 0.02) {
            const std::string asked = reader.scanner->next(ScannerReader::ns(t_s)).send;
            if (asked == bytesOf("A5 50"))
                reader.feed(bytesOf("A5 5A 14 00 00 00 04 18 14 01 07" + QByteArray(32, '1')), t_s);
            if (asked == bytesOf("A5 52"))
                reader.feed(bytesOf("A5 5A 03 00 00 00 06 02 04 00"), t_s);
            isTold = isTold || !reader.scanner->problem().empty();
            QVERIFY(!isTold || QString::fromStdString(reader.scanner->problem()).contains("code 0004"));
        }
        QVERIFY(isTold);
    }

    /// What was measured before a silence and after it is no revolution.
    void newStart() {
        ScannerReader reader("rplidar-a3");
        const RplidarSender sender;
        for (const auto &[start_s, first] : std::vector<std::pair<double, int>>{{0, 0}, {5, 25}, {9, 70}}) {
            reader.feed(bytesOf(expressAnswer), start_s);
            for (int n = first; n < first + 60; ++n)
                reader.feed(sender.packet(n), start_s + sender.arrival_s(n));
        }
        reader.assembler.jump();
        std::size_t whole = 0;
        for (const Revolution &revolution : reader.revolutions) {
            QVERIFY(revolution.end_ns - revolution.begin_ns < 150000000);
            QVERIFY(revolution.partial || revolution.beams.size() == 36 * 32);
            whole += !revolution.partial;
        }
        QCOMPARE(whole, std::size_t(2)); // of the second and of the third
    }

    void stampsAfterGaps_data() {
        QTest::addColumn<bool>("isExpress");
        QTest::addColumn<int>("bunch");
        QTest::addColumn<int>("missing");
        QTest::addColumn<bool>("isDamaged");
        QTest::newRow("one of a bunch is damaged") << true << 5 << 1 << true;
        QTest::newRow("one is damaged") << true << 1 << 1 << true;
        QTest::newRow("three of a bunch vanish") << true << 5 << 3 << false;
        QTest::newRow("more than a revolution vanishes") << true << 1 << 50 << false;
        QTest::newRow("three revolutions are damaged") << true << 1 << 110 << true;
        QTest::newRow("single beams") << false << 32 << 20 << true;
        QTest::newRow("revolutions of single beams") << false << 32 << 2000 << true;
    }

    /// The beams count the time: what is missing must not shorten it, however it comes in.
    void stampsAfterGaps() {
        QFETCH(bool, isExpress);
        QFETCH(int, bunch);
        QFETCH(int, missing);
        QFETCH(bool, isDamaged);
        ScannerReader reader("rplidar-a3");
        const RplidarSender sender{isExpress};
        reader.feed(bytesOf("A5 5A 04 00 00 00 15 F4 01 7D 00"), 0); // microseconds for each beam
        reader.feed(bytesOf(isExpress ? expressAnswer : standardAnswer), 0);
        const int gap = 40 * sender.packets() + 6, end = 80 * sender.packets();
        std::string bytes;
        for (int n = 0; n < end; ++n) {
            std::string packet = sender.packet(n);
            const bool isGap = n >= gap && n < gap + missing;
            if (isGap && isDamaged)
                packet[0] = packet[1] = 0;
            if (!isGap || isDamaged)
                bytes += packet;
            if (n % bunch == bunch - 1)
                reader.feed(std::exchange(bytes, {}), sender.arrival_s(n));
        }
        QVERIFY(reader.assembler.counts().partial > 0);
        QCOMPARE(reader.assembler.counts().lostPackets, std::uint64_t(missing));
        QVERIFY(!isDamaged || reader.scanner->counts().damaged == std::uint64_t(missing));
        for (const Revolution &revolution : reader.revolutions) {
            for (const Beam &beam : revolution.beams)
                QVERIFY(beam.stamp_ns >= revolution.begin_ns && beam.stamp_ns <= revolution.end_ns);
            if (revolution.partial)
                continue;
            const double begin_s = double(revolution.begin_ns - ScannerReader::epoch_ns) * 1e-9;
            const double error_s = std::remainder(begin_s - sender.begin_s(0), 0.144);
            QVERIFY2(std::abs(error_s) < 0.0005, qPrintable(QString::number(error_s)));
        }
    }

    void wholeRevolutionsVanish_data() {
        const Rows<int> row("count");
        for (const int count : {1, 3, 12})
            row(QByteArray::number(count), count);
    }

    /// No packet, nor the angle of one, tells that they are missing: it is seen by all that comes later.
    void wholeRevolutionsVanish() {
        QFETCH(int, count);
        ScannerReader reader("rplidar-a3");
        const RplidarSender sender;
        reader.feed(bytesOf("A5 5A 04 00 00 00 15 F4 01 7D 00"), 0);
        reader.feed(bytesOf(expressAnswer), 0);
        const int before = 20 * sender.packets() + 6, after = before + count * sender.packets();
        for (int n = 0; n < after + 40 * sender.packets(); ++n)
            if (n < before || n >= after)
                reader.feed(sender.packet(n), sender.arrival_s(n));
        const RevolutionAssembler::Counts counts = reader.assembler.counts();
        QCOMPARE(counts.missed, std::uint64_t(count));
        QCOMPARE(counts.revolutions + counts.partial, std::uint64_t(60));
        const double begin_s = double(reader.revolutions.back().begin_ns - ScannerReader::epoch_ns) * 1e-9;
        QVERIFY(std::abs(begin_s - sender.begin_s(after + 38 * sender.packets())) < 0.2);
    }

    /// Whoever replays a recording only feeds it.
    /// One capsule of 256 has a checksum with which it begins as an answer does.
    void capsuleThatBeginsAsAnAnswer() {
        ScannerReader reader("rplidar-a1");
        reader.feed(bytesOf("A5 5A 54 00 00 40 82"), 0);
        std::string body = capsule(32 * 64).substr(2);
        body.replace(2, 3, {0x00, 0x40, char(0x85)}); // as the end of a length, and form 85
        char sum = char(0xA5);
        for (const char byte : body)
            sum = char(sum ^ byte);
        body.back() = char(body.back() ^ sum); // an offset
        reader.feed(capsule(0x8000), 0);
        reader.feed("\xA5\x5A" + body, 0.004);
        reader.feed(capsule(64 * 64), 0.008);
        QCOMPARE(reader.scanner->prerequisite().substr(0, 2), std::string("82"));
        QCOMPARE(reader.scanner->counts().packets, std::uint64_t(3));
    }

    void replay() {
        ScannerReader reader("rplidar-a1");
        reader.scanner->prepare("82 125.0");
        QVERIFY(!reader.scanner->isScanning());
        reader.feed(capsule(640), 0);
        QVERIFY(reader.scanner->isScanning());
    }
};

QTEST_GUILESS_MAIN(TestScannersRplidar)
#include "TestScannersRplidar.moc"
