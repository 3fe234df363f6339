// Bytes of YDLIDAR scanners to revolutions: the worked examples, damage, any cut, and the dialogue.
#include "tests/protocol/ScannerReader.h"
#include "tests/support/Seed.h"

#include <QtTest>

#include <algorithm>
#include <cmath>

using namespace hermes::scan;

namespace {

const QByteArray markPacket = "AA 55 01 01 53 AE 53 AE AB 54 00 00";
const QByteArray twoBeams = "AA 55 00 02 01 05 81 05 CA 47 A0 0F 40 1F";
const QByteArray streamAnswer = "A5 5A 05 00 00 40 81";
const QByteArray info = "A5 5A 14 00 00 00 04 06 02 01 01 02 00 01 09 00 01 00 00 00 00 00 00 00 00 00 01";
const QByteArray health = "A5 5A 03 00 00 00 06 00 00 00";

/// A scanner at 10 revolutions a second that begins at its mark: a packet of one beam, then of 40, the last
/// with what is left. Beam n of a revolution has 1000 + n % 50 mm.
class Sender {
public:
    explicit Sender(const ScannerModel &model)
        : count_(model.samples_hz / 10)
        , isTof_(std::string_view(model.name) == "ydlidar-tg30")
        , hasIntensity_(std::string_view(model.name) == "ydlidar-tmini") {}

    std::string next() {
        const int size = at_ == 0 ? 1 : std::min(40, count_ - at_);
        std::string packet = text(at_, size);
        at_ = (at_ + size) % count_;
        return packet;
    }
    int count() const { return count_; }

private:
    std::string text(int first, int size) const {
        const auto word = [](int value) { return std::string{char(value), char(value >> 8)}; };
        const auto angle = [&](int beam) { return int(beam * 360.0 / count_ * 64) << 1 | 1; };
        const std::string head = "\xAA\x55" + std::string{char(first == 0 ? 1 | 100 << 1 : 0), char(size)} +
                                 word(angle(first)) + word(angle(first + size - 1));
        int sum = 0;
        for (std::size_t i = 0; i < head.size(); i += 2)
            sum ^= std::uint8_t(head[i]) | std::uint8_t(head[i + 1]) << 8;
        std::string beams;
        for (int beam = first; beam < first + size; ++beam) {
            const int sample = (1000 + beam % 50) * (isTof_ ? 1 : 4);
            if (hasIntensity_)
                beams += char(200);
            beams += word(sample);
            sum ^= sample ^ (hasIntensity_ ? 200 : 0);
        }
        return head + word(sum) + beams;
    }

    int count_, at_ = 0;
    bool isTof_, hasIntensity_;
};

double clockwise(const Beam &beam) {
    return std::fmod(360 - beam.angle_deg, 360);
}

} // namespace

class TestScannersYdlidar : public QObject {
    Q_OBJECT
private:
    static void models() {
        QTest::addColumn<QByteArray>("name");
        for (const char *name : {"ydlidar-x2", "ydlidar-x4", "ydlidar-g4", "ydlidar-tmini", "ydlidar-tg30"})
            QTest::newRow(name) << QByteArray(name);
    }

private Q_SLOTS:
    void examples() {
        ScannerReader reader("ydlidar-x2");
        reader.feed(bytesOf(markPacket), 0);
        reader.feed(bytesOf(twoBeams), 0.001);
        const std::vector<Beam> beams = reader.beams(); // 0 was passed between the packets
        QCOMPARE(beams.size(), std::size_t(3));
        QVERIFY(std::abs(clockwise(beams[0]) - 348.640625) < 1e-9);
        QCOMPARE(beams[0].range_m, 0.0F);
        QVERIFY(std::abs(clockwise(beams[2]) - (10 - 6.762)) < 0.001);
        QCOMPARE(beams[2].range_m, 1.0F);
        QVERIFY(std::abs(clockwise(beams[1]) - (11 - 7.378)) < 0.001);
        QCOMPARE(beams[1].range_m, 2.0F);
        QCOMPARE(reader.scanner->counts().packets, std::uint64_t(2));
    }

    void exampleWithIntensity() {
        ScannerReader reader("ydlidar-tmini");
        reader.feed(bytesOf("AA 55 00 02 01 05 81 05 0A 47 80 A0 0F 40 40 1F"), 0);
        const std::vector<Beam> beams = reader.beams();
        QCOMPARE(beams.size(), std::size_t(2));
        QCOMPARE(clockwise(beams[1]), 10.0);
        QCOMPARE(beams[1].range_m, 1.0F);
        QCOMPARE(int(beams[1].intensity), 0x80);
        QCOMPARE(clockwise(beams[0]), 11.0);
        QCOMPARE(beams[0].range_m, 2.0F);
        QCOMPARE(int(beams[0].intensity), 0x40);
    }

    /// What a Tmini marks as a reflection or as the sun is no obstacle.
    void interference() {
        ScannerReader reader("ydlidar-tmini");
        reader.feed(bytesOf("AA 55 00 02 01 05 81 05 0B 47 80 A2 0F 40 43 1F"), 0);
        const std::vector<Beam> beams = reader.beams();
        QCOMPARE(beams.size(), std::size_t(2));
        QCOMPARE(beams[0].range_m, 0.0F);
        QCOMPARE(beams[1].range_m, 0.0F);
    }

    void revolutions_data() { models(); }

    /// However the bytes are cut: the same revolutions, none lost, and beams that are equally far in time.
    void revolutions() {
        QFETCH(QByteArray, name);
        std::mt19937 random(newSeed());
        ScannerReader reader(name.constData());
        Sender sender(*findScannerModel(name.constData()));
        std::string stream;
        std::uint64_t packets = 0;
        for (int turns = 0; turns < 31; packets += 1)
            if (const std::string packet = sender.next(); (turns += packet[3] == 1) < 31)
                stream += packet;
        reader.feedInPieces(stream, double(stream.size()) / 3, random);
        QCOMPARE(reader.scanner->counts().packets, packets - 1);
        QCOMPARE(reader.scanner->counts().skippedBytes, std::uint64_t(0));
        QCOMPARE(reader.assembler.counts().lostPackets, std::uint64_t(0));
        QCOMPARE(reader.revolutions.size(), std::size_t(29));
        QVERIFY(reader.revolutions.front().partial);
        const double sample_ns = 1e8 / sender.count();
        for (std::size_t i = 1; i < reader.revolutions.size(); ++i) {
            const Revolution &revolution = reader.revolutions[i];
            QVERIFY(!revolution.partial);
            QCOMPARE(revolution.beams.size(), std::size_t(sender.count()));
            const auto [first, last] = std::minmax_element(
                revolution.beams.begin(), revolution.beams.end(),
                [](const Beam &one, const Beam &other) { return one.stamp_ns < other.stamp_ns; });
            const double passed_ns = double(last->stamp_ns - first->stamp_ns);
            QVERIFY2(std::abs(passed_ns - sample_ns * (sender.count() - 1)) < 0.03e9,
                     qPrintable(QString::number(passed_ns)));
            for (const Beam &beam : revolution.beams)
                QVERIFY(beam.range_m >= 1 && beam.range_m < 1.05F);
        }
    }

    void damage_data() { models(); }

    /// A bit that flips costs its packet and no other, and it is counted; a packet that is missing, too.
    void damage() {
        QFETCH(QByteArray, name);
        std::mt19937 random(newSeed());
        ScannerReader reader(name.constData());
        const ScannerModel &model = *findScannerModel(name.constData());
        Sender sender(model);
        std::uint64_t broken = 0, missing = 0, packets = 0;
        double t_s = 0;
        for (int n = 0; n < 4000; ++n) {
            std::string packet = sender.next();
            t_s += double(std::uint8_t(packet[3])) / model.samples_hz;
            const bool isFull = packet[3] == 40;
            if (n % 10 == 5) {
                ++broken;
                packet[random() % packet.size()] ^= char(1 << random() % 8);
            } else if (n % 100 == 51 && isFull) {
                ++missing;
                continue;
            } else {
                ++packets;
            }
            reader.feed(packet, t_s);
        }
        QCOMPARE(reader.scanner->counts().packets, packets);
        QCOMPARE(reader.scanner->counts().damaged, broken);
        QCOMPARE(reader.assembler.counts().lostPackets, broken + missing);
        const std::vector<Beam> beams = reader.beams();
        for (const Beam &beam : beams) {
            QVERIFY(beam.range_m >= 1 && beam.range_m < 1.05F);
            QVERIFY(std::abs(double(beam.stamp_ns - ScannerReader::epoch_ns) * 1e-9 - t_s / 2) <
                    t_s / 2 + 0.2);
        }
    }

    /// The beams count the time: what is missing of a revolution, or whole ones, must not shorten it.
    void stampsAfterGaps() {
        ScannerReader reader("ydlidar-g4");
        Sender sender(*findScannerModel("ydlidar-g4"));
        double t_s = 0;
        for (int n = 0; n < 2000; ++n) {
            const std::string packet = sender.next();
            t_s += double(packet[3]) / 9000;
            const bool isGap = n % 100 == 10 || (n > 1000 && n < 1080);
            if (!isGap)
                reader.feed(packet, t_s + double(packet.size()) * 10 / 230400);
        }
        // 99, of which some were not full.
        const std::uint64_t lost = reader.assembler.counts().lostPackets;
        QVERIFY2(lost > 90 && lost <= 99, qPrintable(QString::number(lost)));
        reader.assembler.jump();
        const Revolution &last = reader.revolutions.back();
        std::int64_t latest_ns = 0;
        for (const Beam &beam : last.beams)
            latest_ns = std::max(latest_ns, beam.stamp_ns);
        const double error_s = double(latest_ns - ScannerReader::epoch_ns) * 1e-9 - t_s;
        QVERIFY2(std::abs(error_s) < 0.001, qPrintable(QString::number(error_s)));
    }

    void rates_data() {
        QTest::addColumn<double>("samples_hz");
        QTest::newRow("of the table") << 9000.0;
        QTest::newRow("of another setting") << 8000.0;
        QTest::newRow("of a third") << 4000.0;
    }

    /// A G4 may be set to other numbers of beams in a second.
    void rates() {
        QFETCH(double, samples_hz);
        std::mt19937 random(newSeed());
        ScannerReader reader("ydlidar-g4");
        Sender sender(*findScannerModel("ydlidar-g4"));
        double t_s = 0;
        while (t_s < 15) {
            const std::string packet = sender.next();
            t_s += double(packet[3]) / samples_hz;
            reader.feed(packet, t_s + double(packet.size()) * 10 / 230400 + double(random() % 2000) * 1e-6);
        }
        reader.assembler.jump();
        std::int64_t latest_ns = 0;
        for (const Beam &beam : reader.revolutions.back().beams)
            latest_ns = std::max(latest_ns, beam.stamp_ns);
        const double error_s = double(latest_ns - ScannerReader::epoch_ns) * 1e-9 - t_s;
        QVERIFY2(std::abs(error_s) < 0.003, qPrintable(QString::number(error_s)));
    }

    /// A line that is so slow, or gives all at once, tells nothing of the time between two beams.
    void impossibleRates() {
        for (const double samples_hz : {900.0, 90000.0}) {
            ScannerReader reader("ydlidar-g4");
            Sender sender(*findScannerModel("ydlidar-g4"));
            for (double t_s = 0; t_s < 25;) {
                const std::string packet = sender.next();
                t_s += double(packet[3]) / samples_hz;
                reader.feed(packet, t_s);
            }
            const std::vector<Beam> beams = reader.beams();
            std::vector<std::int64_t> steps_ns;
            for (std::size_t i = beams.size() - 200; i < beams.size(); ++i)
                steps_ns.push_back(std::abs(beams[i].stamp_ns - beams[i - 1].stamp_ns));
            std::sort(steps_ns.begin(), steps_ns.end());
            QVERIFY2(std::abs(double(steps_ns[100]) - 1e9 / 9000) < 2000,
                     qPrintable(QString::number(steps_ns[100])));
        }
    }

    /// Answers and times may come amid the packets.
    void otherPackets() {
        ScannerReader reader("ydlidar-g4");
        Sender sender(*findScannerModel("ydlidar-g4"));
        for (int n = 0; n < 100; ++n)
            reader.feed(sender.next() + bytesOf(n % 3 == 0   ? QByteArray("AA 66 36 12 34 10 00 00")
                                                : n % 3 == 1 ? QByteArray("A5 5A 04 00 00 00 04 01 02 03 04")
                                                             : info),
                        n * 0.01);
        QCOMPARE(reader.scanner->counts().packets, std::uint64_t(100));
        QCOMPARE(reader.scanner->counts().skippedBytes, std::uint64_t(0));
        QCOMPARE(reader.assembler.counts().lostPackets, std::uint64_t(0));
        QCOMPARE(reader.scanner->identity().model, std::string("YDLIDAR (model 6)"));
        QCOMPARE(reader.scanner->identity().firmware, std::string("1.2"));
    }

    void dialogue() {
        ScannerReader reader("ydlidar-x4");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        HostAction action = reader.nextAction(t_s, 2);
        QCOMPARE(action.dtr, std::optional<bool>(true));
        QCOMPARE(action.send, std::string(1, '\0'));
        const double raised_s = t_s;
        action = reader.nextAction(t_s, 3);
        QVERIFY(t_s - raised_s >= 0.499); // the motor's
        QCOMPARE(action.send, bytesOf("A5 65"));
        reader.feed(bytesOf(twoBeams), t_s + 0.05); // of the session before
        const double stopped_s = t_s;
        action = reader.nextAction(t_s, 4);
        QVERIFY(t_s - stopped_s >= 0.149);
        QCOMPARE(action.send, bytesOf("A5 90"));
        reader.feed(bytesOf(info), t_s);
        QCOMPARE(reader.nextAction(t_s, 5).send, bytesOf("A5 92"));
        reader.feed(bytesOf(health), t_s);
        QCOMPARE(reader.nextAction(t_s, 6).send, bytesOf("A5 60"));
        reader.feed(bytesOf(streamAnswer), t_s);
        QCOMPARE(reader.nextAction(t_s, t_s + 1).send, std::string());
        Sender sender(*findScannerModel("ydlidar-x4"));
        for (const double until_s = t_s + 2; t_s < until_s;) {
            reader.feed(sender.next(), t_s);
            QCOMPARE(reader.nextAction(t_s, t_s + 0.01).send, std::string());
        }
        QVERIFY(reader.scanner->isScanning());
        QCOMPARE(reader.scanner->problem(), std::string());
        // It falls silent.
        QCOMPARE(reader.nextAction(t_s, t_s + 2).send, std::string(1, '\0'));
        QVERIFY(!reader.scanner->isScanning());
        QVERIFY(!reader.scanner->problem().empty());
        const double silent_s = t_s;
        bool reopens = false;
        while (!reopens && t_s < silent_s + 20)
            reopens = reader.nextAction(t_s, silent_s + 20).reopen;
        QVERIFY(reopens);
    }

    /// A fault that the device tells of is told on, and it is reset.
    void fault() {
        ScannerReader reader("ydlidar-x4");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        while (reader.nextAction(t_s, 3).send != bytesOf("A5 65"))
            QVERIFY(t_s < 3);
        const double stopped_s = t_s;
        QCOMPARE(reader.nextAction(t_s, 3).send, bytesOf("A5 90"));
        QVERIFY(t_s - stopped_s >= 0.099); // what was sent before may be under way
        reader.feed(bytesOf(info), t_s);
        QCOMPARE(reader.nextAction(t_s, 4).send, bytesOf("A5 92"));
        reader.feed(bytesOf("A5 5A 03 00 00 00 06 02 34 12"), t_s);
        QCOMPARE(reader.nextAction(t_s, 5).send, bytesOf("A5 80"));
        QVERIFY(QString::fromStdString(reader.scanner->problem()).contains("1234"));
    }

    /// One-way scanners are not asked, and some of the others take no commands.
    void unasked() {
        ScannerReader oneWay("ydlidar-x2"), deaf("ydlidar-x4");
        Sender sender(*findScannerModel("ydlidar-x2"));
        for (ScannerReader *reader : {&oneWay, &deaf}) {
            reader->scanner->opened(1000000000);
            bool wasRaised = false;
            for (int n = 0; n < 500; ++n) {
                const HostAction action = reader->scanner->next(1000000000 + n * 13000000LL);
                wasRaised = wasRaised || action.dtr == true;
                QVERIFY(reader == &deaf || action.send.empty());
                QVERIFY(!action.reopen);
                reader->feed(sender.next(), 1 + n * 0.013);
            }
            QVERIFY(wasRaised);
            QVERIFY(reader->scanner->isScanning());
            QCOMPARE(reader->scanner->problem(), std::string());
            QVERIFY(reader->revolutions.size() > 20);
        }
    }

    /// Another model's packets: no range is taken, and it is told why.
    void wrongWidth() {
        ScannerReader reader("ydlidar-g4");
        Sender sender(*findScannerModel("ydlidar-tmini"));
        reader.scanner->opened(1000000000);
        bool isTold = false;
        for (int n = 0; n < 1000; ++n) {
            const double t_s = 1 + n * 0.01;
            if (std::string packet = sender.next(); packet[3] != 1)
                reader.feed(packet, t_s);
            reader.scanner->next(ScannerReader::ns(t_s));
            isTold = isTold || QString::fromStdString(reader.scanner->problem()).contains("width");
        }
        QVERIFY(isTold);
        QCOMPARE(reader.scanner->counts().packets, std::uint64_t(0));
        QVERIFY(reader.scanner->counts().damaged > 500);
    }

    void blockedHead() {
        ScannerReader reader("ydlidar-g4");
        reader.scanner->opened(1000000000);
        double t_s = 1;
        while (reader.nextAction(t_s, 3).send != bytesOf("A5 90"))
            QVERIFY(t_s < 3);
        reader.feed(bytesOf(info), t_s);
        reader.nextAction(t_s, 4);
        reader.feed(bytesOf(health), t_s);
        reader.nextAction(t_s, 5);
        reader.feed(bytesOf(streamAnswer), t_s);
        reader.nextAction(t_s, t_s + 0.1);
        Sender sender(*findScannerModel("ydlidar-g4"));
        reader.feed(sender.next(), t_s);
        reader.feed(sender.next() + bytesOf("A5 5A 00 00 00 00 00"), t_s);
        reader.nextAction(t_s, t_s + 0.1);
        QVERIFY(QString::fromStdString(reader.scanner->problem()).contains("blocked"));
        reader.feed(sender.next(), t_s);
        reader.nextAction(t_s, t_s + 0.1);
        QCOMPARE(reader.scanner->problem(), std::string());
    }
};

QTEST_GUILESS_MAIN(TestScannersYdlidar)
#include "TestScannersYdlidar.moc"
