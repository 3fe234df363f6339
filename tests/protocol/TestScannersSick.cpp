// Telegrams of SICK scanners to sweeps: what captures have, any cut, damage, and the dialogue.
#include "tests/protocol/ScannerReader.h"
#include "tests/support/Seed.h"

#include <QtTest>

#include <cmath>

using namespace hermes::scan;

namespace {

std::string telegram(const std::string &text) {
    return '\x02' + text + '\x03';
}

std::string hex(std::uint32_t value) {
    return QByteArray::number(value, 16).toUpper().toStdString();
}

struct Scan {
    std::string kind = "sSN", state = "0 0", encoders = "0";
    std::uint32_t number = 0x5932, stamp_us = 0x5B87697D, sent_us = 0x5B88808C;
    std::string head = "5DC 36", first = "FFF92230 2710"; ///< TiM551: 15 Hz, -45 degrees, 1 degree
    std::vector<std::uint32_t> values;
    int channels = 1; ///< of 16 bits
    std::string others = "0", end = "0 1 B not defined 0 0 0";

    std::string text() const {
        std::string text = kind + " LMDscandata 1 1 F510AB " + state + ' ' + hex(number & 0xFFFF) + ' ' +
                           hex((number + 1) & 0xFFFF) + ' ' + hex(stamp_us) + ' ' + hex(sent_us) +
                           " 0 0 1 0 0 " + head + ' ' + encoders + ' ' + std::to_string(channels) +
                           " DIST1 3F800000 00000000 " + first + ' ' + hex(std::uint32_t(values.size()));
        for (const std::uint32_t value : values)
            text += ' ' + hex(value);
        return telegram(text + ' ' + others + ' ' + end);
    }
};

/// Scan n of a TiM551: beam i has 1000 + i mm.
Scan tim551(int n, std::uint32_t first_us = 0x5B87697D) {
    Scan scan;
    scan.number += std::uint32_t(n);
    scan.stamp_us = first_us + std::uint32_t(n * 1e6 / 15);
    scan.sent_us = scan.stamp_us + 71439;
    for (std::uint32_t i = 0; i < 271; ++i)
        scan.values.push_back(1000 + i);
    return scan;
}

} // namespace

class TestScannersSick : public QObject {
    Q_OBJECT
private Q_SLOTS:
    /// A captured telegram of a TiM551, as far as it is quoted.
    void example() {
        ScannerReader reader("sick-tim5xx");
        Scan scan = tim551(0);
        scan.kind = "sRA";
        scan.values[0] = 0x292;
        scan.values[1] = 0x290;
        scan.values[2] = 3; // a code
        reader.feed(scan.text(), 1);
        QCOMPARE(reader.revolutions.size(), std::size_t(1));
        QVERIFY(!reader.revolutions[0].partial);
        const std::vector<Beam> &beams = reader.revolutions[0].beams;
        QCOMPARE(beams.size(), std::size_t(271));
        QCOMPARE(beams[0].angle_deg, 225.0);
        QCOMPARE(beams[0].range_m, 0.658F);
        QCOMPARE(beams[1].range_m, 0.656F);
        QCOMPARE(beams[2].range_m, 0.0F);
        QCOMPARE(beams[135].angle_deg, 0.0);
        QCOMPARE(beams[270].angle_deg, 135.0);
        // The zero index was at the rear, 71.439 ms before it came.
        const std::int64_t zero_ns = ScannerReader::epoch_ns + 1000000000 - 71439000;
        QVERIFY(std::abs(beams[0].stamp_ns - zero_ns - std::int64_t(1e9 / 15 / 8)) < 2);
        QVERIFY(std::abs(beams[270].stamp_ns - zero_ns - std::int64_t(1e9 / 15 * 7 / 8)) < 2);
        QCOMPARE(reader.scanner->identity().serial, std::to_string(0xF510AB));
    }

    void otherModels_data() {
        QTest::addColumn<QByteArray>("head");
        QTest::addColumn<QByteArray>("first");
        QTest::addColumn<int>("count");
        QTest::addColumn<double>("step_deg");
        QTest::newRow("TiM571") << QByteArray("5DC A2") << QByteArray("FFF92230 D05") << 811 << 0.3333;
        QTest::newRow("LMS111") << QByteArray("1388 168") << QByteArray("FFF92230 1388") << 541 << 0.5;
    }

    void otherModels() {
        QFETCH(QByteArray, head);
        QFETCH(QByteArray, first);
        QFETCH(int, count);
        QFETCH(double, step_deg);
        ScannerReader reader("sick-lms1xx");
        Scan scan;
        scan.head = head.toStdString();
        scan.first = first.toStdString();
        scan.values.assign(std::size_t(count), 2000);
        scan.encoders = "1 12 34";
        reader.feed(scan.text(), 1);
        QCOMPARE(reader.revolutions.size(), std::size_t(1));
        QCOMPARE(reader.revolutions[0].beams.size(), std::size_t(count));
        QVERIFY(std::abs(reader.revolutions[0].beams[1].angle_deg - 225 - step_deg) < 1e-9);
        QCOMPARE(reader.revolutions[0].beams[0].range_m, 2.0F);
        QCOMPARE(int(reader.revolutions[0].beams[0].intensity), 0);
    }

    void intensities_data() {
        QTest::addColumn<int>("channels");
        QTest::addColumn<QByteArray>("others");
        QTest::newRow("8 bits") << 1 << QByteArray("1 RSSI1 3F800000 00000000 FFF92230 2710 2 C8 1");
        QTest::newRow("16 bits") << 2 << QByteArray("RSSI1 3F800000 00000000 FFF92230 2710 2 C8FF 100 0");
        QTest::newRow("none, but a second echo")
            << 2 << QByteArray("DIST2 3F800000 00000000 FFF92230 2710 2 C8FF 100 0");
    }

    void intensities() {
        QFETCH(int, channels);
        QFETCH(QByteArray, others);
        ScannerReader reader("sick-lms1xx");
        Scan scan;
        scan.channels = channels;
        scan.others = others.toStdString();
        scan.values = {2000, 2001};
        reader.feed(scan.text(), 1);
        QCOMPARE(reader.revolutions.size(), std::size_t(1));
        const std::vector<Beam> &beams = reader.revolutions[0].beams;
        QCOMPARE(beams.size(), std::size_t(2));
        QCOMPARE(beams[1].range_m, 2.001F);
        const bool hasAny = others.contains("RSSI1");
        QCOMPARE(int(beams[0].intensity), hasAny ? 200 : 0);
        QCOMPARE(int(beams[1].intensity), hasAny ? 1 : 0);
    }

    /// However the bytes are cut; the scanner's clock begins again at 2^32 us.
    void sweeps() {
        std::mt19937 random(newSeed());
        ScannerReader reader("sick-tim5xx");
        std::string stream;
        for (int n = 0; n < 150; ++n)
            stream += tim551(n, 0u - 5000000u).text();
        reader.feedInPieces(stream, double(stream.size()) / 10, random);
        QCOMPARE(reader.scanner->counts().packets, std::uint64_t(150));
        QCOMPARE(reader.scanner->counts().damaged, std::uint64_t(0));
        QCOMPARE(reader.scanner->counts().skippedBytes, std::uint64_t(0));
        QCOMPARE(reader.assembler.counts().lostPackets, std::uint64_t(0));
        QCOMPARE(reader.revolutions.size(), std::size_t(150));
        for (std::size_t i = 60; i < 150; ++i) {
            const std::int64_t passed_ns =
                reader.revolutions[i].beams[0].stamp_ns - reader.revolutions[i - 1].beams[0].stamp_ns;
            QVERIFY2(std::abs(double(passed_ns) - 1e9 / 15) < 1e7, qPrintable(QString::number(passed_ns)));
        }
    }

    /// A telegram that is missing or cut is counted, and costs no other. There is no checksum.
    void damage() {
        std::mt19937 random(newSeed());
        ScannerReader reader("sick-tim5xx");
        std::uint64_t cut = 0, missing = 0;
        for (int n = 0; n < 1000; ++n) {
            std::string text = tim551(n + 65000).text(); // whose counter begins again
            if (n % 10 == 5) {
                ++cut;
                text.erase(2 + random() % (text.size() - 30));
            }
            if (n % 10 == 8 || n % 50 == 7)
                ++missing;
            else
                reader.feed(text, n / 15.0);
        }
        QCOMPARE(reader.scanner->counts().packets, 1000 - cut - missing);
        QCOMPARE(reader.scanner->counts().damaged, cut);
        QCOMPARE(reader.assembler.counts().lostPackets, cut + missing);
        QCOMPARE(reader.assembler.counts().partial, std::uint64_t(0));
        const double number = double(reader.revolutions.back().number); // with those that are missing
        QVERIFY2(std::abs(number - 999) <= 1, qPrintable(QString::number(number)));
    }

    /// Bits that flip may change a range, as nothing tells; nothing else happens.
    void flippedBits() {
        std::mt19937 random(newSeed());
        ScannerReader reader("sick-tim5xx");
        for (int n = 0; n < 5000; ++n) {
            std::string text = tim551(n).text();
            text[random() % (n % 2 ? text.size() : 150)] ^= char(1 << random() % 8);
            reader.feed(text, n / 15.0);
        }
        for (const Revolution &revolution : reader.revolutions)
            for (const Beam &beam : revolution.beams)
                QVERIFY(beam.angle_deg >= 0 && beam.angle_deg < 360 && beam.range_m >= 0);
    }

    void states_data() {
        QTest::addColumn<QByteArray>("state");
        QTest::addColumn<QByteArray>("problem");
        QTest::newRow("good") << QByteArray("0 0") << QByteArray();
        QTest::newRow("error") << QByteArray("0 1") << QByteArray("fault");
        QTest::newRow("pollution") << QByteArray("0 2") << QByteArray("dirty");
        QTest::newRow("warning of pollution") << QByteArray("0 5") << QByteArray("dirty");
    }

    void states() {
        QFETCH(QByteArray, state);
        QFETCH(QByteArray, problem);
        ScannerReader reader("sick-tim5xx");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        while (reader.nextAction(t_s, 3).send != telegram("sEN LMDscandata 1"))
            QVERIFY(t_s < 3);
        reader.feed(telegram("sEA LMDscandata 1"), t_s);
        reader.nextAction(t_s, t_s + 0.1);
        Scan scan = tim551(0);
        scan.state = state.toStdString();
        reader.feed(scan.text(), t_s);
        reader.nextAction(t_s, t_s + 0.1);
        QVERIFY(reader.scanner->isScanning());
        QCOMPARE(reader.scanner->problem().empty(), problem.isEmpty());
        QVERIFY(QByteArray::fromStdString(reader.scanner->problem()).contains(problem));
    }

    /// It is only asked for its scans. One that does not measure then is started.
    void dialogue() {
        ScannerReader reader("sick-tim5xx");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        QCOMPARE(reader.nextAction(t_s, 2).send, telegram("sEN LMDscandata 0"));
        reader.feed(telegram("sEA LMDscandata 0"), t_s);
        QCOMPARE(reader.nextAction(t_s, 3).send, telegram("sEN LMDscandata 1"));
        reader.feed(telegram("sEA LMDscandata 1"), t_s);
        for (const char *request : {"sEN LMDscandata 0", "sMN SetAccessMode 3 F4724744", "sMN LMCstartmeas",
                                    "sMN Run", "sEN LMDscandata 1"})
            QCOMPARE(reader.nextAction(t_s, t_s + 5).send, telegram(request));
        QVERIFY(!reader.scanner->problem().empty());
        reader.feed(telegram("sEA LMDscandata 1"), t_s);
        for (int n = 0; n < 30; ++n) {
            reader.feed(tim551(n).text(), t_s);
            QCOMPARE(reader.nextAction(t_s, t_s + 0.06).send, std::string());
        }
        QVERIFY(reader.scanner->isScanning());
        QCOMPARE(reader.scanner->problem(), std::string());
    }

    void refusal() {
        ScannerReader reader("sick-tim5xx");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        while (reader.nextAction(t_s, 3).send != telegram("sEN LMDscandata 1"))
            QVERIFY(t_s < 3);
        reader.feed(telegram("sFA 3"), t_s);
        QVERIFY(QString::fromStdString(reader.scanner->problem()).contains("error 3"));
        reader.nextAction(t_s, t_s + 2); // nor when it has begun anew
        QVERIFY(QString::fromStdString(reader.scanner->problem()).contains("error 3"));
    }

    /// One that is set to the binary telegrams is told so.
    void binary() {
        ScannerReader reader("sick-tim5xx");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        reader.nextAction(t_s, 1.1);
        reader.feed(bytesOf("02 02 02 02 00 00 00 11") + "sEN LMDscandata \x01\x33", t_s);
        for (int n = 0; n < 100 && reader.scanner->problem().empty(); ++n)
            reader.nextAction(t_s, t_s + 0.1);
        QVERIFY2(QString::fromStdString(reader.scanner->problem()).contains("CoLa B"),
                 reader.scanner->problem().c_str());
    }
};

QTEST_GUILESS_MAIN(TestScannersSick)
#include "TestScannersSick.moc"
