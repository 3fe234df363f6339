// Bytes of scanners to revolutions: the worked examples of the makers' documents, damage, and any cut.
#include "protocol/scan/ScannerModel.h"
#include "tests/support/Seed.h"

#include <QtTest>

#include <random>

using namespace hermes::scan;

namespace {

std::string bytesOf(const QByteArray &hex) {
    return QByteArray::fromHex(hex).toStdString();
}

/// A scanner, what came out of it, and a clock.
struct Reader {
    explicit Reader(const char *model)
        : scanner(findScannerModel(model)->make(*findScannerModel(model), assembler)) {}

    void feed(const std::string &bytes, double t_s) {
        const auto t_ns = std::int64_t(t_s * 1e9);
        scanner->feed(bytes, {1700000000000000000 + t_ns, t_ns});
    }
    std::vector<Beam> beams() {
        assembler.jump();
        std::vector<Beam> all;
        for (const Revolution &revolution : revolutions)
            all.insert(all.end(), revolution.beams.begin(), revolution.beams.end());
        return all;
    }

    std::vector<Revolution> revolutions;
    RevolutionAssembler assembler{
        [this](const Revolution &revolution) { revolutions.push_back(revolution); }};
    std::unique_ptr<ScannerProtocol> scanner;
};

const QByteArray ld06Packet =
    "54 2C 68 08 AB 7E E0 00 E4 DC 00 E2 D9 00 E5 D5 00 E3 D3 00 E4 D0 00 E9 CD 00 E4 CA 00 E2 C7 "
    "00 E9 C5 00 E5 C2 00 E5 C0 00 E5 BE 82 3A 1A 50";

std::uint8_t crcOfLdrobot(const std::string &bytes) {
    int crc = 0;
    for (const char byte : bytes) {
        crc ^= std::uint8_t(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = crc & 0x80 ? (crc << 1 ^ 0x4D) & 0xFF : crc << 1;
    }
    return std::uint8_t(crc);
}

/// The packet of an LD06 number n at 10 revolutions a second, whose beam i has 1000 + i mm.
std::string ldrobotPacket(int n) {
    constexpr double step_deg = 3600.0 / 4500;
    const auto word = [](int value) { return std::string{char(value), char(value >> 8)}; };
    const auto angle = [&](int beam) {
        return word(int(std::fmod((n * 12 + beam) * step_deg, 360) * 100 + 0.5) % 36000);
    };
    std::string text = "\x54\x2C" + word(3600) + angle(0);
    for (int i = 0; i < 12; ++i)
        text += word(1000 + i) + char(200);
    text += angle(11) + word(int(n * 12 / 4.5) % 30000);
    return text + char(crcOfLdrobot(text));
}

} // namespace

class TestScanners : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void ld06Example() {
        Reader reader("ld06");
        reader.feed(bytesOf(ld06Packet), 1);
        const std::vector<Beam> beams = reader.beams();
        QCOMPARE(beams.size(), std::size_t(12));
        // Counter-clockwise: the last comes first.
        QCOMPARE(beams.back().angle_deg, -324.27);
        QVERIFY(std::abs(beams.front().angle_deg + 334.70) < 1e-9);
        QCOMPARE(beams.back().range_m, 0.224F);
        QCOMPARE(int(beams.back().intensity), 228);
        QCOMPARE(beams.front().range_m, 0.192F);
        QCOMPARE(int(beams.front().intensity), 229);
        // As long as the head takes for that.
        QVERIFY(std::abs(double(beams.front().stamp_ns - beams.back().stamp_ns) - 10.43e9 / 2152) < 20);
    }

    /// However the bytes are cut: the same revolutions, whole ones of 450 beams, and none lost.
    void ld06Revolutions() {
        std::mt19937 random(newSeed());
        Reader reader("ld06");
        std::string stream;
        for (int n = 5; n < 375; ++n) // ten revolutions, but for their beginning
            stream += ldrobotPacket(n);
        for (std::size_t at = 0; at < stream.size();) {
            const std::size_t size = 1 + random() % 100;
            at += size;
            reader.feed(stream.substr(at - size, size), double(std::min(at, stream.size())) / 47 * 12 / 4500);
        }
        QCOMPARE(reader.scanner->counts().packets, std::uint64_t(370));
        QCOMPARE(reader.scanner->counts().skippedBytes, std::uint64_t(0));
        QCOMPARE(reader.assembler.counts().lostPackets, std::uint64_t(0));
        QCOMPARE(reader.revolutions.size(), std::size_t(9));
        QVERIFY(reader.revolutions.front().partial);
        for (std::size_t i = 1; i < reader.revolutions.size(); ++i) {
            QVERIFY(!reader.revolutions[i].partial);
            QCOMPARE(reader.revolutions[i].beams.size(), std::size_t(450));
        }
    }

    /// A bit that flips costs its packet and no other, and it is counted; a packet that is missing, too.
    void ld06Damage() {
        std::mt19937 random(newSeed());
        std::uint64_t broken = 0;
        Reader reader("ld06");
        for (int n = 0; n < 4000; ++n) {
            std::string packet = ldrobotPacket(n);
            const bool isBroken = n % 10 == 5, isMissing = n % 100 == 51;
            broken += isBroken || isMissing;
            if (isBroken)
                packet[random() % packet.size()] ^= char(1 << random() % 8);
            if (!isMissing)
                reader.feed(packet, n * 12.0 / 4500);
        }
        QCOMPARE(reader.scanner->counts().packets, 4000 - broken);
        QCOMPARE(reader.assembler.counts().lostPackets, broken);
        for (const Beam &beam : reader.beams())
            QVERIFY(beam.range_m >= 1 && beam.range_m <= 1.012F);
    }

    void rplidarStandardExample() {
        Reader reader("rplidar-a1");
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

    void rplidarExpressExample() {
        Reader reader("rplidar-a1");
        reader.feed(bytesOf("A5 5A 54 00 00 40 82"), 0);
        const auto capsule = [](int start_q6) {
            std::string body{char(start_q6), char(start_q6 >> 8)};
            for (int i = 0; i < 16; ++i)
                body += bytesOf("A0 0F A5 0F 08");
            char sum = 0;
            for (const char byte : body)
                sum = char(sum ^ byte);
            return std::string{char(0xA0 | (sum & 15)), char(0x50 | (sum >> 4 & 15))} + body;
        };
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

    /// What no scanner sends is taken for nothing, and kills nobody.
    void noiseIsNoScan() {
        std::mt19937 random(newSeed());
        for (const ScannerModel &model : scannerModels()) {
            Reader reader(model.name);
            for (int n = 0; n < 300; ++n) {
                std::string bytes(1 + random() % 300, 0);
                for (char &byte : bytes)
                    byte =
                        random() % 4 == 0 ? "\xA5\x5A\x54\x2C\x81\x82\x40\x00"[random() % 8] : char(random());
                reader.feed(bytes, n * 0.01);
                if (!model.isOneWay)
                    reader.scanner->next(n * 10000000);
            }
        }
    }
};

QTEST_GUILESS_MAIN(TestScanners)
#include "TestScanners.moc"
