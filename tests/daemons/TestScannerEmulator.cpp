// What emulated laser scanners send, read again by the formats that their makers published.
#include "ScannerBench.h"
#include "daemons/simulator/RplidarCapsules.h"

using namespace hermes::simulator;
using Kind = ScannerEmulator::Fault::Kind;

namespace {

/// They count counter-clockwise, and measure a part of a turn.
bool isOfSector(const QString &model) {
    return model.startsWith("hokuyo") || model.startsWith("sick");
}

} // namespace

class TestScannerEmulator : public QObject {
    Q_OBJECT
private Q_SLOTS:
    // The readers of this test read the published examples.
    void readersReadPublishedExamples() {
        const Reading one = readRplidar81(fromHex("BE01054813"));
        QCOMPARE(one.points.size(), std::size_t(1));
        QCOMPARE(one.points[0].angle, 10.0);
        QCOMPARE(one.points[0].range, 1.234);
        QCOMPARE(one.points[0].intensity, 47);
        QVERIFY(!one.points[0].first);
        const Reading ld =
            readLd(fromHex("542C6808AB7EE000E4DC00E2D900E5D500E3D300E4D000E9CD00E4CA00E2C700E9C500E5C200E5C0"
                           "00E5BE823A1A50"));
        QCOMPARE(ld.points.size(), std::size_t(12));
        QCOMPARE(ld.points[0].angle, 324.27);
        QCOMPARE(ld.points[0].range, 0.224);
        QCOMPARE(ld.points[11].intensity, 229);
        QCOMPARE(ld.stamps, std::vector<double>{6.714});
        QCOMPARE(readYdlidar(fromHex("AA55010153AE53AEAB540000"), false, false, true).points.size(),
                 std::size_t(1));
        for (const bool intensity : {false, true}) {
            const char *hex = intensity ? "AA550002010581050A4780A00F40401F" : "AA55000201058105CA47A00F401F";
            const Reading two = readYdlidar(fromHex(hex), intensity, false, true);
            QCOMPARE(two.points.size(), std::size_t(2));
            QVERIFY(std::abs(two.points[0].angle - 10 + 6.76) < 0.01 && two.points[0].range == 1);
            QVERIFY(std::abs(two.points[1].angle - 11 + 7.38) < 0.01 && two.points[1].range == 2);
            QCOMPARE(two.points[1].intensity, intensity ? 0x40 : 0);
        }
        QCOMPARE(scipNumber("CB"), 1234);
        QCOMPARE(scipNumber("1Dh"), 5432);
        QCOMPARE(scipNumber("m2@0"), 16000000);
        const Reading scip = readScip("MD0540054201000\n99b\n0N90W\n0?X0?Y001P\n\n", 540, 540, 1440, false);
        QCOMPARE(scip.points.size(), std::size_t(3));
        QCOMPARE(scip.stamps, std::vector<double>{123.456});
        QCOMPARE(scip.points[1].range, 1.001);
        const Reading cola = readCola(
            "\x02sRA LMDscandata 1 1 F510AB 0 0 5932 5933 5B87697D 5B88808C 0 0 1 0 0 5DC 36 0 1 DIST1 "
            "3F800000 00000000 FFF92230 2710 2 292 290 0 0 1 B not defined 0 0 0\x03");
        QCOMPARE(cola.points.size(), std::size_t(2));
        QCOMPARE(cola.points[1].angle, 360 - 44.0 - 90);
        QCOMPARE(cola.points[1].range, 0.656);
    }

    void rplidarAnswersAsPublished_data() {
        Rows<QString, QByteArray, QByteArray>("model", "sent", "begin");
        const auto row = [](const char *name, const char *model, const char *sent, const char *begin) {
            QTest::newRow(name) << QString(model) << fromHex(sent) << fromHex(begin);
        };
        row("information", "rplidar-a1", "A550", "A55A140000000418");
        row("health", "rplidar-a1", "A552", "A55A0300000006000000");
        row("rates", "rplidar-a1", "A559", "A55A0400000015FC01FE00");
        row("scan", "rplidar-a1", "A520", "A55A0500004081");
        row("legacy express", "rplidar-a1", "A582050000000000 22", "A55A5400004082");
        row("wrong checksum", "rplidar-a1", "A582050000000000 23", "");
        row("modes", "rplidar-s2", "A5840470000000 55", "A55A060000002070000000 0300");
        row("typical mode", "rplidar-s2", "A584047C000000 59", "A55A06000000207C000000 0100");
        row("time of a sample", "rplidar-s2", "A5840671000000 0200 54", "A55A080000002071000000 401F0000");
        row("range", "rplidar-s2", "A5840674000000 0200 51", "A55A080000002074000000 001E0000");
        row("packet", "rplidar-s2", "A5840675000000 0200 50", "A55A050000002075000000 86");
        row("name", "rplidar-a3", "A584067F000000 0200 5A",
            "A55A100000002 07F000000 53656E736974697669747900");
        row("no such mode", "rplidar-a3", "A584067F000000 0900 51", "");
        row("speed", "rplidar-a3", "A5840401000000 24", "A55A080000002001000000 5802 9402");
        row("motor by PWM", "rplidar-a3", "A5FF0400000000 5E", "A55A04000000FF01000000");
        row("motor otherwise", "rplidar-a1", "A5FF0400000000 5E", "A55A04000000FF00000000");
        row("junk before", "rplidar-a1", "00A5 00 FFA552", "A55A0300000006000000");
        row("reset tells a text", "rplidar-a1", "A540", "5250204C49444152"); // RP LIDAR
        row("start", "ydlidar-x4", "A560", "A55A0500004081");
        row("information", "ydlidar-x4", "A590", "A55A140000000406");
        row("health", "ydlidar-x4", "A592", "A55A0300000006000000");
        row("speed", "ydlidar-x4", "A50D", "A55A0400000004BC020000");
        row("one way", "ydlidar-x2", "A590", "");
    }

    void rplidarAnswersAsPublished() {
        FETCH(QString, model, QByteArray, sent, QByteArray, begin);
        const QByteArray answer = Bench(model).ask(sent);
        QVERIFY(model != "ydlidar-x2" || !answer.contains("\xA5\x5A"));
        QCOMPARE(answer.left(begin.size()).toHex(), begin.toHex());
        QVERIFY(!begin.isEmpty() || answer.isEmpty() || model == "ydlidar-x2"); // that sends by itself
    }

    void rplidarPacksAsPublished() {
        const auto all = [](std::size_t count, RplidarPoint first, RplidarPoint second) {
            std::vector<RplidarPoint> points(count, first);
            points[1] = second;
            return points;
        };
        const std::string express = encodeRplidar(0x82, 0x8000, 0, all(32, {1000, 1}, {1001, 2}));
        QCOMPARE(QByteArray::fromStdString(express).mid(2, 7).toHex(), fromHex("0080A00FA50F08").toHex());
        const std::string dense = encodeRplidar(0x86, 0, 0, all(64, {1000, 0}, {1000, 0}));
        QCOMPARE(QByteArray::fromStdString(dense).mid(10, 5).toHex(), fromHex("D0F7D0F722").toHex());
        QVERIFY(std::abs(rplidarSlant_deg(0x84, 1000) - 6.66) < 0.005);
        QCOMPARE(rplidarSlant_deg(0x84, 49), 7.5);
    }

    void rangesOfAllSizesArePacked_data() { rowsOf<QByteArray>("type", {"82", "84", "85", "86"}); }

    void rangesOfAllSizesArePacked() {
        QFETCH(QByteArray, type);
        const unsigned packet = unsigned(type.toInt(nullptr, 16));
        for (int mm = 0; mm < 16000; mm += 7) {
            const std::vector<RplidarPoint> points(97, {mm, 0});
            const QByteArray bytes =
                QByteArray::fromStdString(encodeRplidar(std::uint8_t(packet), 0, 0, points));
            for (const ReadPoint &point : pointsOfRplidar(packet, bytes, bytes)) {
                const int step = packet == 0x84 && mm >= 512 ? mm >= 4096 ? 8 : 4 : packet == 0x86 ? 4 : 1;
                QVERIFY2(std::abs(point.range * 1000 - mm) < step, qPrintable(QString::number(mm)));
            }
        }
    }

    void turnsLieOnTheWalls_data() {
        const Rows<QString, unsigned, double> row("model", "packet", "rate");
        row("A1 standard", "rplidar-a1", 0x81, 1e6 / 508);
        row("A1 express", "rplidar-a1", 0x82, 1e6 / 254);
        row("A1 sensitivity", "rplidar-a1", 0x84, 8000);
        row("A3 standard", "rplidar-a3", 0x81, 1e6 / 252);
        row("A3 express", "rplidar-a3", 0x82, 8000);
        row("A3 sensitivity", "rplidar-a3", 0x84, 16000);
        row("C1 standard", "rplidar-c1", 0x81, 5000);
        row("C1 dense", "rplidar-c1", 0x85, 5000);
        row("S2 standard", "rplidar-s2", 0x81, 10000);
        row("S2 dense", "rplidar-s2", 0x85, 32000);
        row("S2 ultra dense", "rplidar-s2", 0x86, 32000);
        row("LD06", "ld06", 0, 4500);
        row("LD19", "ld19", 0, 4500);
        row("STL-27L", "stl27l", 0, 21600);
        row("X2", "ydlidar-x2", 0, 3000);
        row("X4", "ydlidar-x4", 0, 5000);
        row("Tmini", "ydlidar-tmini", 0, 4000);
        row("TG30", "ydlidar-tg30", 0, 20000);
        row("URG-04LX", "hokuyo-urg04lx", 0, 10240);
        row("UST-10LX", "hokuyo-ust10lx", 0, 57600);
        row("TiM551", "sick-tim551", 0, 5400);
        row("TiM571", "sick-tim571", 0, 16200);
        row("LMS111", "sick-lms111", 0, 36000);
    }

    void turnsLieOnTheWalls() {
        FETCH(QString, model, unsigned, packet, double, rate);
        Bench bench(model);
        bench.scan(packet);
        const std::uint64_t turnsBefore = bench.scanner->revolutions();
        const QByteArray bytes = bench.pass(3);
        const Reading reading = bench.read(bytes, packet);
        // As many points as it says, in as many turns; some scans are a part of a turn.
        const double turns = bench.scanner->model().turns_hz;
        const double seen = model.contains("urg") ? 682.0 / 1024 : isOfSector(model) ? 0.752 : 1;
        QVERIFY2(std::abs(double(reading.points.size()) / (3 * rate * seen) - 1) < 0.05,
                 qPrintable(QString::number(reading.points.size())));
        QVERIFY(std::abs(double(bench.scanner->revolutions() - turnsBefore) - 3 * turns) <= 1);
        QVERIFY2(reading.strayBytes < 180, qPrintable(QString::number(reading.strayBytes))); // answers
        std::vector<int> perTurn(1, 0);
        std::size_t wrong = 0, close = 0;
        double before = 0;
        for (const ReadPoint &point : reading.points) {
            if (point.angle < before - 180)
                perTurn.push_back(0);
            before = point.angle;
            ++perTurn.back();
            const double expected = roomRange((isOfSector(model) ? point.angle : -point.angle) * M_PI / 180);
            close += expected > 5 ? 0 : 1;
            // Angles are rounded; a slanting ray goes where the range of the ray before says.
            wrong += point.range > 0 && std::abs(point.range - expected) > 0.02 + 0.006 * expected;
            wrong += point.range == 0 && expected < 5;
        }
        QVERIFY2(double(wrong) < 0.01 * double(reading.points.size()), qPrintable(QString::number(wrong)));
        QVERIFY(close > 100);
        if (!isOfSector(model)) {
            QVERIFY2(std::abs(double(perTurn.size()) - 3 * turns) < 3,
                     qPrintable(QString::number(perTurn.size())));
            for (std::size_t i = 1; i + 1 < perTurn.size(); ++i)
                QVERIFY2(std::abs(perTurn[i] - rate / turns) < 10, qPrintable(QString::number(perTurn[i])));
        }
        // Where packets mark a turn's first point, they mark one in each turn, and at its begin.
        std::size_t firsts = 0;
        for (const ReadPoint &point : reading.points) {
            firsts += point.first;
            const bool raw = packet == 0x81 || model.contains("tmini") || model.contains("tg30");
            QVERIFY(!point.first || !raw || circle(point.angle + 2) < 4);
        }
        if (packet == 0x81 || !model.startsWith("rplidar"))
            QVERIFY(model.startsWith("ld") || model == "stl27l" || std::abs(double(firsts) - 3 * turns) < 2);
        // The line carries no more than its speed.
        const int baud = bench.scanner->model().baud;
        QVERIFY(baud == 0 || bench.mostAtOnce <= baud / 10 * step_ns / 1000000000 + 1);
    }

    // Reception, less the time on the line and that of the samples behind, is when the head was there.
    void stampsFollowFromReception_data() {
        const Rows<QString, unsigned, int> row("model", "packet", "samples");
        row("A1 standard", "rplidar-a1", 0x81, 1);
        row("S2 dense", "rplidar-s2", 0x85, 40);
        row("S2 ultra dense", "rplidar-s2", 0x86, 64);
    }

    void stampsFollowFromReception() {
        FETCH(QString, model, unsigned, packet, int, samples);
        Bench bench(model);
        bench.scan(packet);
        QByteArray bytes;
        std::vector<double> at_s; // of each byte
        for (int i = 0; i < 1000; ++i) {
            bytes += bench.pass(0.0005);
            at_s.resize(std::size_t(bytes.size()), double(bench.now_ns - start_ns) * 1e-9);
        }
        const Reading reading = bench.read(bytes, packet);
        const double sample_s = packet == 0x81 ? 508e-6 : 31.25e-6;
        const int length = packet == 0x81 ? 5 : packet == 0x85 ? 84 : 170;
        double worst = 0, first = 0;
        for (std::size_t i = 20; i + 2 < reading.packetEnds.size(); ++i) {
            const double received = at_s[std::size_t(reading.packetEnds[i] - 1)];
            const double taken = received - 10.0 * length / bench.scanner->model().baud -
                                 (samples - 1 + 1.5) * sample_s; // the packet's first sample
            const double phase = circle(reading.points[i * std::size_t(samples)].angle - taken * 3600);
            first = i == 20 ? phase : first;
            worst = std::max(worst, std::abs(std::remainder(phase - first, 360)));
        }
        QVERIFY2(worst < 3600 * 0.0011, qPrintable(QString::number(worst))); // two steps of this bench
    }

    void motorsAreObeyed() {
        Bench a3("rplidar-a3");
        a3.ask(fromHex("A520"));
        QCOMPARE(a3.pass(0.5), QByteArray());   // it stands
        a3.ask(fromHex("A5F0024A011C"), 0.001); // half of 660
        Reading reading = readRplidar81(a3.pass(2));
        const auto firsts = [&reading] {
            return std::count_if(reading.points.begin(), reading.points.end(),
                                 [](const ReadPoint &p) { return p.first; });
        };
        QVERIFY(std::abs(double(firsts()) - 10) <= 1);
        a3.ask(fromHex("A5F002000057"));
        QCOMPARE(a3.pass(0.5), QByteArray());
        a3.ask(fromHex("A521")); // even if it stands
        QVERIFY(a3.pass(0.5).size() > 1000);
        Bench s2("rplidar-s2");
        s2.ask(fromHex("A5A8022C01A2"), 0.01); // 300 rpm, wrong checksum
        s2.ask(fromHex("A5A8022C0122"), 0.01);
        s2.ask(fromHex("A520"));
        reading = readRplidar81(s2.pass(2));
        QVERIFY(std::abs(double(firsts()) - 10) <= 1);
    }

    void faults_data() {
        QTest::addColumn<QString>("model");
        for (const ScannerModel &model : scannerModels())
            QTest::newRow(model.name) << QString(model.name);
    }

    void faults() {
        QFETCH(QString, model);
        Bench sound(model), faulty(model);
        sound.scan();
        faulty.scan();
        faulty.scanner->setFault({Kind::Corrupt, 0.02});
        QByteArray expected = sound.pass(1), told = faulty.pass(1);
        QCOMPARE(told.size(), expected.size());
        int damaged = 0, bits = 0;
        for (int i = 0; i < told.size(); ++i) {
            damaged += told[i] != expected[i];
            bits += int(qPopulationCount(quint8(told[i] ^ expected[i])));
        }
        QVERIFY(damaged > told.size() / 100 && damaged < told.size() / 33);
        QCOMPARE(bits, damaged);
        faulty.scanner->setFault({Kind::Loss, 0.02});
        expected = sound.pass(1), told = faulty.pass(1);
        QVERIFY(told.size() < expected.size() * 99 / 100 && told.size() > expected.size() * 97 / 100);
        for (const Kind dead : {Kind::Silence, Kind::Stalled}) {
            faulty.scanner->setFault({dead, 0});
            faulty.pass(0.1); // what was on its way
            QCOMPARE(faulty.pass(0.5), QByteArray());
        }
        faulty.scanner->setFault({});
        faulty.pass(0.3);
        told = faulty.pass(1);
        QVERIFY(std::abs(told.size() - expected.size()) < expected.size() / 20);
        // An old session goes on, and it begins within a packet.
        Bench held(model);
        held.scanner->setFault({Kind::Held, 0});
        told = held.pass(0.5);
        QVERIFY(told.size() > 500);
        QVERIFY(!told.startsWith("\x54\x2C") && !told.startsWith("\xAA\x55") && !told.startsWith("MD") &&
                !told.startsWith("\x02"));
        QVERIFY(held.read(told).packets > 2);
    }

    void brokenOneIsReset() {
        for (const QString model : {"rplidar-a1", "ydlidar-x4"}) {
            const QByteArray health = fromHex(model == "rplidar-a1" ? "A552" : "A592");
            Bench bench(model);
            bench.scan();
            QVERIFY(bench.pass(0.2).size() > 100);
            bench.scanner->setFault({Kind::Health, 0});
            bench.pass(0.1);
            QCOMPARE(bench.pass(0.2), QByteArray());
            QCOMPARE(int(u8(bench.ask(health), 7)), 2);
            bench.scan();
            QCOMPARE(bench.pass(0.2), QByteArray());
            bench.ask(fromHex(model == "rplidar-a1" ? "A540" : "A580"));
            QCOMPARE(int(u8(bench.ask(health), 7)), 0);
            bench.scan();
            QVERIFY(bench.pass(0.2).size() > 100);
        }
    }

    void clocksDriftAndWrap() {
        ScannerOptions fast;
        fast.drift_ppm = 1000;
        Bench ld("ld06", fast);
        double before = -1, told = 0;
        int wraps = 0;
        for (const double stamp : readLd(ld.pass(40)).stamps) {
            QVERIFY(stamp < 30);
            if (before >= 0) {
                wraps += stamp < before;
                told += stamp - before + (stamp < before ? 30 : 0);
            }
            before = stamp;
        }
        QVERIFY(wraps == 1 || wraps == 2);
        QVERIFY2(std::abs(told - 40 * 1.001) < 0.01, qPrintable(QString::number(told)));
        Bench urg("hokuyo-urg04lx", fast);
        urg.scan();
        std::vector<double> stamps = urg.read(urg.pass(10)).stamps;
        QVERIFY(std::abs((stamps.back() - stamps.front()) / double(stamps.size() - 1) - 0.1001) < 0.0001);
        urg.now_ns += 16777216000000; // a pause: the clock comes round
        urg.pass(0.3);
        const double after = urg.read(urg.pass(1)).stamps.back();
        QVERIFY2(after > stamps.back() + 16 && after < stamps.back() + 20,
                 qPrintable(QString::number(after)));
    }

    void unknownModelIsNone() { QVERIFY(!makeScanner("none") && !makeScanner("")); }
};
