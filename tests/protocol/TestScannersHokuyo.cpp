// Lines of Hokuyo scanners to sweeps: the worked examples, damage, any cut, and the dialogue.
#include "tests/protocol/ScannerReader.h"
#include "tests/support/Seed.h"

#include <QtTest>

#include <cmath>

using namespace hermes::scan;

namespace {

const std::string parameters = "PP\n00P\nMODL:URG-04LX;5\nDMIN:20;4\nDMAX:5600;_\nARES:1024;\\\nAMIN:44;7\n"
                               "AMAX:725;o\nAFRT:384;6\nSCAN:600;e\n\n";
const std::string example = "MD0540054201000\n99b\n0N90W\n0?X0?Y001P\n\n";

std::string summed(const std::string &text) {
    unsigned sum = 0;
    for (const char character : text)
        sum += std::uint8_t(character);
    return text + char((sum & 0x3F) + 0x30);
}

std::string fact(const std::string &text) {
    const std::string sum = summed(text);
    return text + ';' + sum.back() + '\n';
}

std::string characters(int value, int count) {
    std::string text;
    for (int shift = 6 * (count - 1); shift >= 0; shift -= 6)
        text += char((value >> shift & 0x3F) + 0x30);
    return text;
}

/// A UST-10LX: 40 scans a second of 270 degrees.
const std::string ustParameters = "PP\n00P\n" + fact("MODL:UST-10LX") + fact("DMIN:20") + fact("DMAX:30000") +
                                  fact("ARES:1440") + fact("AMIN:0") + fact("AMAX:1080") + fact("AFRT:540") +
                                  fact("SCAN:2400") + "\n";
constexpr int ustBeams = 1081;

/// Scan n of it: beam i has 1000 + i % 50 mm, stamped from so many milliseconds on.
std::string ustScan(int n, int first_ms = 1000) {
    std::string data, text = "MD0000108001000\n99b\n";
    text += summed(characters((first_ms + 25 * n) & 0xFFFFFF, 4)) + '\n';
    for (int i = 0; i < ustBeams; ++i)
        data += characters(1000 + i % 50, 3);
    for (std::size_t at = 0; at < data.size(); at += 64)
        text += summed(data.substr(at, 64)) + '\n';
    return text + '\n';
}

} // namespace

class TestScannersHokuyo : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void example3() {
        ScannerReader reader("hokuyo-urg04lx");
        reader.feed(example, 0); // what its steps are is not told yet
        QVERIFY(reader.revolutions.empty());
        reader.feed(parameters, 1);
        reader.feed("MD0540054201000\n00P\n\n", 2);
        reader.feed(example, 3);
        QCOMPARE(reader.revolutions.size(), std::size_t(1));
        QVERIFY(!reader.revolutions[0].partial);
        const std::vector<Beam> &beams = reader.revolutions[0].beams;
        QCOMPARE(beams.size(), std::size_t(3));
        QCOMPARE(beams[0].angle_deg, (540 - 384) * 360.0 / 1024);
        QCOMPARE(beams[0].range_m, 1.0F);
        QCOMPARE(beams[1].range_m, 1.001F);
        QCOMPARE(beams[2].range_m, 0.0F); // a code
        QCOMPARE(beams[1].stamp_ns - beams[0].stamp_ns, std::int64_t(1e8 / 1024));
        QCOMPARE(beams[2].stamp_ns, ScannerReader::epoch_ns + 3000000000);
    }

    /// Counter-clockwise from the right of the rear, in the time that the head takes.
    void sweep() {
        ScannerReader reader("hokuyo-ust10lx");
        reader.feed(ustParameters + ustScan(0), 0);
        QCOMPARE(reader.revolutions.size(), std::size_t(1));
        const std::vector<Beam> &beams = reader.revolutions[0].beams;
        QCOMPARE(beams.size(), std::size_t(ustBeams));
        QCOMPARE(beams.front().angle_deg, 225.0);
        QCOMPARE(beams[540].angle_deg, 0.0);
        QCOMPARE(beams.back().angle_deg, 135.0);
        QCOMPARE(beams.back().stamp_ns - beams.front().stamp_ns, std::int64_t(25e6 * 0.75));
        QCOMPARE(beams.back().stamp_ns, ScannerReader::epoch_ns);
    }

    /// However the bytes are cut; the scanner's clock begins again at 2^24 ms.
    void sweeps() {
        std::mt19937 random(newSeed());
        ScannerReader reader("hokuyo-ust10lx");
        std::string stream;
        for (int n = 0; n < 200; ++n)
            stream += ustScan(n, (1 << 24) - 2500);
        reader.feed(ustParameters, 0);
        reader.feedInPieces(stream, double(stream.size()) / 5, random);
        QCOMPARE(reader.scanner->counts().packets, std::uint64_t(200));
        QCOMPARE(reader.scanner->counts().damaged, std::uint64_t(0));
        QCOMPARE(reader.scanner->counts().skippedBytes, std::uint64_t(0));
        QCOMPARE(reader.assembler.counts().partial, std::uint64_t(0));
        QCOMPARE(reader.revolutions.size(), std::size_t(200));
        for (std::size_t i = 80; i < 200; ++i) {
            const std::int64_t passed_ns =
                reader.revolutions[i].beams[0].stamp_ns - reader.revolutions[i - 1].beams[0].stamp_ns;
            QVERIFY2(std::abs(passed_ns - 25000000) < 3000000, qPrintable(QString::number(passed_ns)));
        }
    }

    /// A bit that flips costs its scan and no other, and it is counted, unless it means nothing.
    void damage() {
        std::mt19937 random(newSeed());
        ScannerReader reader("hokuyo-ust10lx");
        reader.feed(ustParameters, 0);
        std::uint64_t broken = 0;
        for (int n = 0; n < 3000; ++n) {
            std::string scan = ustScan(n);
            if (n % 3 == 1 || n % 30 == 5) {
                ++broken;
                // Half of them where no data are.
                const std::size_t at =
                    random() % 2 ? random() % scan.size() : (random() % 60 + scan.size() - 30) % scan.size();
                scan[at] ^= char(1 << random() % 8);
            }
            reader.feed(scan, n * 0.025);
        }
        const std::uint64_t damaged = reader.scanner->counts().damaged;
        QVERIFY2(damaged <= broken && damaged > broken * 9 / 10, qPrintable(QString::number(damaged)));
        QCOMPARE(reader.scanner->counts().packets + damaged, std::uint64_t(3000));
        QCOMPARE(reader.assembler.counts().lostPackets, damaged);
        QCOMPARE(reader.assembler.counts().partial, std::uint64_t(0));
        const double number = double(reader.revolutions.back().number); // with those that are missing
        QVERIFY2(std::abs(number - 2999) <= 1, qPrintable(QString::number(number)));
        for (const Revolution &revolution : reader.revolutions) {
            QCOMPARE(revolution.beams.size(), std::size_t(ustBeams));
            for (int i = 0; i < ustBeams; ++i)
                QCOMPARE(revolution.beams[std::size_t(i)].range_m, float(1000 + i % 50) * 1e-3F);
        }
    }

    /// What never ends is skipped, in no more time than it takes to read it.
    void withoutEnd() {
        ScannerReader reader("hokuyo-ust10lx");
        const std::string noise(100000, 'A');
        for (int i = 0; i < 100; ++i)
            reader.feed(noise, i * 0.01);
        reader.feed("\n\n" + ustParameters + ustScan(0), 1);
        QCOMPARE(reader.scanner->counts().skippedBytes, std::uint64_t(10000002));
        QCOMPARE(reader.scanner->counts().packets, std::uint64_t(1));
    }

    /// Where the end of a scan is damaged, the next is still one.
    void damagedEnd() {
        for (const std::size_t fromEnd : {1, 2, 3}) {
            ScannerReader reader("hokuyo-ust10lx");
            std::string second = ustScan(1);
            second[second.size() - fromEnd] ^= 0x40;
            reader.feed(ustParameters + ustScan(0) + second + ustScan(2) + ustScan(3), 0);
            QCOMPARE(reader.revolutions.size(), std::size_t(3));
            QCOMPARE(reader.scanner->counts().damaged, std::uint64_t(1));
            QCOMPARE(reader.assembler.counts().lostPackets, std::uint64_t(1));
        }
    }

    /// A bit that flips in the parameters leaves the scanner unknown, never another one.
    void damagedParameters() {
        for (std::size_t bit = 0; bit < ustParameters.size() * 8; ++bit) {
            std::string text = ustParameters;
            text[bit / 8] ^= char(1 << bit % 8);
            ScannerReader reader("hokuyo-ust10lx");
            reader.feed(text + "\n\n", 0);
            const std::string known = reader.scanner->prerequisite();
            QVERIFY2(known.empty() || known == "1440 0 1080 540 2400", known.c_str());
        }
    }

    /// Who begins in the middle of a recording knows the scanner by what is stored with it.
    void prerequisite() {
        ScannerReader first("hokuyo-ust10lx"), second("hokuyo-ust10lx");
        QCOMPARE(first.scanner->prerequisite(), std::string());
        first.feed(ustParameters, 0);
        QVERIFY(!first.scanner->prerequisite().empty());
        for (const char *nonsense : {"", "0 0 0 0 0", "1440 0 1080 540", "1440 -1 1080 540 2400", "x"})
            second.scanner->prepare(nonsense);
        second.feed(ustScan(0), 0);
        QVERIFY(second.revolutions.empty());
        second.scanner->prepare(first.scanner->prerequisite());
        second.feed(ustScan(1).substr(1000) + ustScan(2), 0);
        QCOMPARE(second.revolutions.size(), std::size_t(1));
        QCOMPARE(second.scanner->counts().damaged, std::uint64_t(0)); // it only begins in the middle
        second.scanner->jump();
        second.feed(ustScan(90), 0);
        QCOMPARE(second.assembler.counts().lostPackets, std::uint64_t(0));
    }

    void dialogue() {
        ScannerReader reader("hokuyo-ust10lx");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        QCOMPARE(reader.nextAction(t_s, 2).send, std::string("QT\n"));
        reader.feed(ustScan(0), t_s); // of the session before
        reader.feed("QT\n00P\n\n", t_s + 0.05);
        const double silent_s = t_s + 0.05;
        QCOMPARE(reader.nextAction(t_s, 3).send, std::string("VV\n"));
        QVERIFY(t_s - silent_s >= 0.099);
        reader.feed("VV\n00P\n" + fact("VEND:Hokuyo Automatic Co., Ltd.") + fact("PROD:UST-10LX") +
                        fact("FIRM:4.0.0") + "PROT:SCIP 2.0;N\n" + fact("SERI:H1234567") + "\n",
                    t_s);
        QCOMPARE(reader.nextAction(t_s, 4).send, std::string("PP\n"));
        QCOMPARE(reader.scanner->identity().model, std::string("UST-10LX"));
        QCOMPARE(reader.scanner->identity().firmware, std::string("4.0.0"));
        QCOMPARE(reader.scanner->identity().serial, std::string("H1234567"));
        reader.feed(ustParameters, t_s);
        QCOMPARE(reader.nextAction(t_s, 5).send, std::string("BM\n"));
        reader.feed("BM\n02R\n\n", t_s); // it is on already
        QCOMPARE(reader.nextAction(t_s, 6).send, std::string("MD0000108001000\n"));
        reader.feed("MD0000108001000\n00P\n\n", t_s);
        for (int n = 0; n < 100; ++n, t_s += 0.025) {
            QCOMPARE(reader.scanner->next(ScannerReader::ns(t_s)).send, std::string());
            reader.feed(ustScan(n), t_s);
        }
        QVERIFY(reader.scanner->isScanning());
        QCOMPARE(reader.scanner->problem(), std::string());
        QCOMPARE(reader.revolutions.size(), std::size_t(100));
        // It stops for a fault, which is told as long as nothing is measured.
        reader.feed("MD0000108001000\n" + summed("50") + "\n\n", t_s);
        QCOMPARE(reader.nextAction(t_s, t_s + 2).send, std::string("QT\n"));
        QVERIFY(!reader.scanner->isScanning());
        QVERIFY2(QString::fromStdString(reader.scanner->problem()).contains("status 50"),
                 reader.scanner->problem().c_str());
    }

    void firstProtocol_data() {
        QTest::addColumn<QByteArray>("answer");
        QTest::addColumn<QByteArray>("request");
        QTest::newRow("SCIP 1") << QByteArray("QT\nE\n\n") << QByteArray("SCIP2.0\n");
        QTest::newRow("mode of the clock") << QByteArray("QT\n0Ee\n\n") << QByteArray("TM2\n");
        QTest::newRow("neither") << QByteArray("QT\n00P\n\n") << QByteArray("VV\n");
    }

    /// A scanner may be left in another protocol or mode.
    void firstProtocol() {
        QFETCH(QByteArray, answer);
        QFETCH(QByteArray, request);
        ScannerReader reader("hokuyo-urg04lx");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        QCOMPARE(reader.nextAction(t_s, 2).send, std::string("QT\n"));
        reader.feed(answer.toStdString(), t_s);
        QCOMPARE(reader.nextAction(t_s, 3).send, request.toStdString());
        QCOMPARE(reader.scanner->problem(), std::string());
        if (request != "VV\n") {
            QCOMPARE(reader.nextAction(t_s, 4).send, std::string("VV\n"));
        }
    }

    void silence() {
        ScannerReader reader("hokuyo-urg04lx");
        double t_s = 1;
        reader.scanner->opened(ScannerReader::ns(t_s));
        reader.nextAction(t_s, 2);
        QCOMPARE(reader.nextAction(t_s, t_s + 0.09).send, std::string()); // it has its time
        QCOMPARE(reader.nextAction(t_s, t_s + 0.1).send, std::string("VV\n"));
        reader.scanner->opened(ScannerReader::ns(t_s));
        int requests = 0;
        bool reopens = false;
        while (!reopens && t_s < 20) {
            reopens = reader.nextAction(t_s, 20).reopen;
            ++requests;
        }
        QVERIFY(reopens);
        QCOMPARE(requests, 7); // QT and VV three times, and once more
        QVERIFY(QString::fromStdString(reader.scanner->problem()).contains("does not answer"));
    }
};

QTEST_GUILESS_MAIN(TestScannersHokuyo)
#include "TestScannersHokuyo.moc"
