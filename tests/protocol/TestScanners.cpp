// Bytes of scanners to revolutions: the worked examples of the makers' documents, damage, and any cut.
#include "tests/protocol/ScannerReader.h"
#include "tests/support/Seed.h"

#include <QtTest>

#include <cmath>

using namespace hermes::scan;

namespace {

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
        ScannerReader reader("ld06");
        QVERIFY(!reader.scanner->isScanning());
        reader.feed(bytesOf(ld06Packet), 1);
        QVERIFY(reader.scanner->isScanning()); // also in a replay, where nobody asks what to do
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
        ScannerReader reader("ld06");
        std::string stream;
        for (int n = 5; n < 375; ++n) // ten revolutions, but for their beginning
            stream += ldrobotPacket(n);
        reader.feedInPieces(stream, 47.0 / 12 * 4500, random);
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
        ScannerReader reader("ld06");
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

    /// An angle that no head has, with a right checksum.
    void ld06StrangeAngle() {
        ScannerReader reader("ld06");
        std::string packet = ldrobotPacket(0);
        packet[4] = packet[5] = '\xF6';
        packet.back() = char(crcOfLdrobot(packet.substr(0, 46)));
        reader.feed(packet, 1);
        for (const Beam &beam : reader.beams())
            QVERIFY(beam.stamp_ns <= ScannerReader::epoch_ns + ScannerReader::ns(1));
    }

    /// One that takes no commands: where it is silent the line is opened anew.
    void ld06Silence() {
        ScannerReader reader("ld06");
        double t_s = 1;
        for (const double silent_s : {3.0, 1.0}) { // as long as it may take to turn; once it turned
            const double since_s = t_s;
            reader.scanner->opened(ScannerReader::ns(t_s));
            reader.nextAction(t_s, t_s + 0.01);
            if (silent_s == 1)
                reader.feed(bytesOf(ld06Packet), t_s += 0.01);
            QVERIFY(reader.nextAction(t_s, t_s + 5).reopen);
            QVERIFY2(std::abs(t_s - since_s - silent_s) < 0.05, qPrintable(QString::number(t_s - since_s)));
            QVERIFY(!reader.scanner->isScanning());
            QVERIFY(!reader.scanner->problem().empty());
        }
        reader.feed(bytesOf(ld06Packet), t_s += 0.01);
        reader.nextAction(t_s, t_s + 0.02);
        QVERIFY(reader.scanner->isScanning());
        QCOMPARE(reader.scanner->problem(), std::string());
    }

    /// Where the host did not ask for long, it has not read for long: that is no silence of the scanner.
    void hostThatWasHeldUp() {
        ScannerReader reader("ld06");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        reader.nextAction(t_s, t_s + 0.01);
        reader.feed(bytesOf(ld06Packet), t_s);
        t_s += 1.5;
        QVERIFY(!reader.nextAction(t_s, t_s + 0.5).reopen);
        QVERIFY(reader.scanner->isScanning());
        QVERIFY(reader.nextAction(t_s, t_s + 0.6).reopen);
    }

    void namedModels_data() {
        QTest::addColumn<QByteArray>("alike");
        QTest::addColumn<QByteArray>("device");
        QTest::addColumn<QByteArray>("named");
        const auto row = [](const char *alike, const char *device, const char *named) {
            QTest::newRow(*device ? device : alike)
                << QByteArray(alike) << QByteArray(device) << QByteArray(named);
        };
        row("hokuyo-urg04lx", "UST-10LX", "hokuyo-ust10lx");
        row("hokuyo-urg04lx", "SOKUIKI Sensor URG-04LX(Hokuyo Automatic Co.,Ltd.)", "hokuyo-urg04lx");
        row("hokuyo-urg04lx", "Hokuyo", "");
        row("rplidar-a1", "RPLIDAR A1 (model 18)", "rplidar-a1");
        row("rplidar-a1", "RPLIDAR A2 (model 28)", "");
        row("rplidar-a2m12", "RPLIDAR S1 (model 61)", "rplidar-s1");
        row("rplidar-s2", "RPLIDAR S3 (model 81)", "rplidar-s3");
        row("rplidar-c1", "", "rplidar-c1");
        row("ld06", "LDROBOT", "");
        row("ydlidar-tmini", "YDLIDAR (model 150)", "ydlidar-tmini");
    }

    /// Rows of the table that speak alike are told apart by what the device tells of itself.
    void namedModels() {
        QFETCH(QByteArray, alike);
        QFETCH(QByteArray, device);
        QFETCH(QByteArray, named);
        const ScannerModel *const model =
            namedModel(*findScannerModel(alike.toStdString()), device.toStdString());
        QCOMPARE(QByteArray(model ? model->name : ""), named);
    }

    /// A head that does not turn, or says so, fills no memory.
    void headThatDoesNotTurn() {
        std::vector<std::size_t> beams;
        RevolutionAssembler assembler([&](const Revolution &revolution) {
            QVERIFY(revolution.partial);
            beams.push_back(revolution.beams.size());
        });
        for (int i = 0; i < 250000; ++i)
            assembler.addClockwise(10, 10, 1, 0, i * std::int64_t(200000));
        QCOMPARE(beams, (std::vector<std::size_t>{100000, 100000}));
    }

    /// What no scanner sends is taken for nothing, and kills nobody.
    void noiseIsNoScan() {
        std::mt19937 random(newSeed());
        for (const ScannerModel &model : scannerModels()) {
            ScannerReader reader(model.name);
            for (int n = 0; n < 300; ++n) {
                std::string bytes(1 + random() % 300, 0);
                for (char &byte : bytes)
                    byte =
                        random() % 4 == 0 ? "\xA5\x5A\x54\x2C\x81\x82\x40\x00"[random() % 8] : char(random());
                reader.feed(bytes, n * 0.01);
                if (!model.isOneWay)
                    reader.scanner->next(n * std::int64_t(10000000));
            }
        }
    }
};

QTEST_GUILESS_MAIN(TestScanners)
#include "TestScanners.moc"
