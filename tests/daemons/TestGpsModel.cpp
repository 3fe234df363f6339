// The simulated GPS receiver, and the position packets of the lidar that is wired to it.
#include "daemons/simulator/PacketPump.h"
#include "vectorlib/geometry/Angle.h"

using namespace hermes;
using namespace hermes::simulator;

class TestGpsModel : public QObject {
    Q_OBJECT

    static constexpr std::int64_t start_ns = 1700000000300000000; // 2023-11-14 22:13:20.3 UTC
    static constexpr double degree = vectorlib::pi / 180;

    /// What a sentence holds, read by its published form alone; empty when its checksum is wrong.
    static QList<QByteArray> fieldsOf(const QByteArray &sentence) {
        const int star = sentence.lastIndexOf('*');
        if (!sentence.startsWith('$') || star != sentence.size() - 3)
            return {};
        char sum = 0;
        for (const char byte : sentence.mid(1, star - 1))
            sum = char(sum ^ byte);
        if (sentence.mid(star + 1) != QByteArray(1, sum).toHex().toUpper())
            return {};
        return sentence.mid(1, star - 1).split(',');
    }

    /// Degrees of ddmm.mmmm and its letter.
    static double angleOf(const QByteArray &text, const QByteArray &letter) {
        const int point = text.indexOf('.');
        const double degrees = text.left(point - 2).toDouble() + text.mid(point - 2).toDouble() / 60;
        return letter == "S" || letter == "W" ? -degrees : degrees;
    }

    struct Metres {
        double x, y, z;
    };
    /// Of the WGS 84 ellipsoid, from the centre of the Earth.
    static Metres earthFixed(double latitude_deg, double longitude_deg, double height) {
        const double phi = latitude_deg * degree, lambda = longitude_deg * degree, e2 = 0.00669437999014;
        const double n = 6378137 / std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
        return {(n + height) * std::cos(phi) * std::cos(lambda),
                (n + height) * std::cos(phi) * std::sin(lambda), (n * (1 - e2) + height) * std::sin(phi)};
    }

    struct Told {
        double after_s; ///< the start
        QList<QByteArray> fields;
    };

    /// Lets the robot drive for so long and gives all sentences.
    static QList<Told> listen(Simulation &simulation, double seconds) {
        QList<Told> told;
        const std::int64_t end_ns = simulation.now_ns() + std::int64_t(seconds * 1e9);
        while (simulation.now_ns() < end_ns) {
            const std::string_view text = simulation.sentences();
            for (const QByteArray &line : QByteArray(text.data(), int(text.size())).split('\n')) {
                if (!line.isEmpty())
                    told.append({double(simulation.now_ns() - start_ns) * 1e-9, fieldsOf(line.trimmed())});
            }
            simulation.skip(1);
        }
        return told;
    }

    static World field() {
        World world;
        world.edges = {{-90, -90, 90, -90}};
        world.poses = {{3, 4, 0}, {3, 60, 0}};
        return world;
    }

private Q_SLOTS:
    void fixesKeepTheirGrid_data() {
        QTest::addColumn<int>("rate");
        for (const int rate : {1, 3, 5, 10})
            QTest::addRow("%d Hz", rate) << rate;
    }

    void fixesKeepTheirGrid() {
        QFETCH(int, rate);
        Simulation::Options options;
        options.gps.rate_hz = rate;
        Simulation simulation(field(), options, start_ns);
        const QList<Told> told = listen(simulation, 10);
        QVERIFY2(std::abs(told.size() - 20 * rate) <= 2, saying(told.size()));
        double expected = std::floor(0.3 * rate + 1) / rate + 20; // seconds of the minute
        for (int i = 0; i < told.size(); i += 2) {
            const QList<QByteArray> rmc = told[i].fields, gga = told[i + 1].fields;
            QCOMPARE(rmc.value(0), QByteArray("GPRMC"));
            QCOMPARE(gga.value(0), QByteArray("GPGGA"));
            QCOMPARE(rmc[1], gga[1]);
            QVERIFY(rmc[1].startsWith("2213"));
            const double second = rmc[1].mid(4).toDouble();
            QVERIFY2(std::abs(second - expected) < 0.006, rmc[1].constData());
            const double late = told[i].after_s + 20.3 - expected; // a Velodyne wants 50 to 500 ms
            QVERIFY2(late > 0.05 && late < 0.1, saying(late));
            QCOMPARE(rmc[9], QByteArray("141123"));
            expected += 1.0 / rate;
        }
    }

    void positionsAreThoseOfTheRobot_data() {
        const Rows<double, double> row("latitude", "longitude");
        row("here", 50.0, 10.0);
        row("south and west", -33.9, -151.2);
        row("equator and date line", 0.0, 180.0);
        row("far north", 80.0, -0.00001);
    }

    void positionsAreThoseOfTheRobot() {
        FETCH(double, latitude, double, longitude);
        Simulation::Options options;
        options.gps.origin = {latitude, longitude};
        options.gps.altitude = 512;
        options.gps.sigma = 0;
        Simulation simulation(field(), options, start_ns);
        simulation.place({40, -25, 1});
        const QList<QByteArray> gga = listen(simulation, 1).last().fields;
        QCOMPARE(gga[0], QByteArray("GPGGA"));
        QVERIFY(gga[6] == "1" && gga[9].toDouble() == 512 && !gga[7].isEmpty() && !gga[8].isEmpty());
        // The way between the two as seen from the origin: east and north.
        const Metres origin = earthFixed(latitude, longitude, 512);
        const Metres there = earthFixed(angleOf(gga[2], gga[3]), angleOf(gga[4], gga[5]), 512);
        const Metres d{there.x - origin.x, there.y - origin.y, there.z - origin.z};
        const double phi = latitude * degree, lambda = longitude * degree;
        const double east = -std::sin(lambda) * d.x + std::cos(lambda) * d.y;
        const double north =
            -std::sin(phi) * (std::cos(lambda) * d.x + std::sin(lambda) * d.y) + std::cos(phi) * d.z;
        QVERIFY2(std::abs(east - 40) < 0.004, qPrintable(QString::number(east, 'f', 4)));
        QVERIFY2(std::abs(north + 25) < 0.004, qPrintable(QString::number(north, 'f', 4)));
    }

    void speedAndCourse() {
        Simulation simulation(field(), {}, start_ns);
        QVERIFY(simulation.drive());
        listen(simulation, 3);
        for (const Told &told : listen(simulation, 2)) { // to the north, looking east
            if (told.fields[0] != "GPRMC")
                continue;
            QVERIFY(std::abs(told.fields[7].toDouble() * 0.514444 - 0.8) < 0.05);
            const double course = told.fields[8].toDouble();
            QVERIFY2(course < 1 || course > 359, told.fields[8].constData());
        }
        simulation.place({0, 0, vectorlib::pi / 2 + 0.5});
        const QList<QByteArray> standing = listen(simulation, 1)[2].fields;
        QCOMPARE(standing[7].toDouble(), 0.0);
        QVERIFY(std::abs(standing[8].toDouble() - (360 - 0.5 / degree)) < 0.1); // the heading
    }

    void noiseIsAsAsked() {
        Simulation::Options options;
        options.gps.rate_hz = 10;
        options.gps.sigma = 2;
        Simulation simulation(field(), options, start_ns);
        double sum = 0, squares = 0;
        int count = 0;
        for (const Told &told : listen(simulation, 60)) {
            if (told.fields[0] != "GPGGA")
                continue;
            const double north = (angleOf(told.fields[2], told.fields[3]) - 50) * 111229 - 4;
            sum += north;
            squares += north * north;
            ++count;
        }
        QVERIFY(count > 590);
        QVERIFY(std::abs(sum / count) < 0.4);
        QVERIFY(std::abs(std::sqrt(squares / count) - 2) < 0.3);
    }

    void faults() {
        Simulation simulation(field(), {}, start_ns);
        listen(simulation, 2);
        QCOMPARE(simulation.gps().pps(), velodyne::Pps::Locked);
        using Kind = GpsModel::Fault::Kind;
        simulation.gps().setFault({Kind::Silence, 0});
        listen(simulation, 0.3); // what was on its way
        QCOMPARE(listen(simulation, 2).size(), 0);
        QCOMPARE(simulation.gps().pps(), velodyne::Pps::Absent);
        simulation.gps().setFault({Kind::NoFix, 0});
        const QList<Told> blind = listen(simulation, 2);
        QVERIFY(blind.size() >= 18);
        const QList<QByteArray> rmc = blind[4].fields, gga = blind[5].fields;
        QVERIFY(rmc[2] == "V" && rmc[12] == "N" && !rmc[1].isEmpty() && !rmc[9].isEmpty());
        for (const int field : {3, 4, 5, 6, 7, 8})
            QVERIFY(rmc[field].isEmpty());
        QVERIFY(gga[6] == "0" && gga[2].isEmpty() && gga[9].isEmpty());
        QCOMPARE(simulation.gps().pps(), velodyne::Pps::Absent);
        simulation.gps().setFault({Kind::Corrupt, 0.5});
        listen(simulation, 0.3);
        int wrong = 0;
        const QList<Told> corrupt = listen(simulation, 20);
        for (const Told &told : corrupt)
            wrong += told.fields.isEmpty();
        QVERIFY(corrupt.size() >= 190 && wrong > 60 && wrong < 140);
        simulation.gps().setFault({});
        listen(simulation, 0.3);
        for (const Told &told : listen(simulation, 2))
            QVERIFY(!told.fields.isEmpty());
        QCOMPARE(simulation.gps().pps(), velodyne::Pps::Locked);
    }

    void lidarHearsOfEachSecond() {
        Simulation simulation(field(), {}, start_ns);
        QCOMPARE(simulation.gps().pps(), velodyne::Pps::Synchronizing);
        for (int second = 0; second < 5; ++second) {
            // 22:13:21 comes 0.7 s after the start, its sentence 0.06 s later.
            listen(simulation, second == 0 ? 0.755 : 0.99);
            const QByteArray before = QByteArray::fromStdString(simulation.gps().lidarSentence());
            listen(simulation, 0.01);
            const QByteArray after = QByteArray::fromStdString(simulation.gps().lidarSentence());
            QVERIFY(second == 0 ? before.isEmpty() : fieldsOf(before)[1].startsWith("2213"));
            QCOMPARE(fieldsOf(after)[1].left(6), QByteArray::number(221321 + second));
            QVERIFY2(after.size() <= 72, after.constData());
        }
    }

    // By the published offsets, not by the decoder.
    void positionPacketsHoldWhatIsPublished() {
        Simulation simulation(field(), {}, start_ns);
        listen(simulation, 3);
        const auto packet = simulation.positionPacket();
        QCOMPARE(packet.size(), std::size_t(512));
        const QByteArray bytes(reinterpret_cast<const char *>(packet.data()), int(packet.size()));
        quint32 stamp = 0;
        for (int i = 3; i >= 0; --i)
            stamp = stamp << 8 | std::uint8_t(bytes[0xC6 + i]);
        QCOMPARE(qint64(stamp), simulation.now_ns() / 1000 % 3600000000);
        QCOMPARE(int(bytes[0xCA]), 2); // locked
        const QByteArray text(bytes.constData() + 0xCE);
        QVERIFY(text.startsWith("$GPRMC,221323") && text.endsWith("\r\n") && text.size() <= 74);
        QVERIFY(!fieldsOf(text.trimmed()).isEmpty());
        QCOMPARE(bytes.mid(0xCE + text.size()), QByteArray(512 - 0xCE - text.size(), '\0'));
        QCOMPARE(bytes.left(0xC6), QByteArray(0xC6, '\0')); // no motion chips
        simulation.gps().setFault({GpsModel::Fault::Kind::Silence, 0});
        QCOMPARE(int(simulation.positionPacket()[0xCA]), 0);
    }

    void positionPacketsKeepTheirValues() {
        velodyne::PositionPacket packet, read;
        packet.chips[0] = {-34 * 0.09766, 85 * 0.1453 + 25, 795 * 0.001221, -2048 * 0.001221};
        packet.chips[2] = {1e9, -1e9, std::numeric_limits<double>::quiet_NaN(), 0};
        packet.stamp_us = 3599999999;
        packet.pps = velodyne::Pps::Error;
        packet.nmea = "$GPRMC,214106,A,3707.8178,N,12139.2690,W,010.3,188.2,230715,013.8,E,D*05";
        auto bytes = encodePosition(packet);
        QCOMPARE(int(bytes[0x0E]) | bytes[0x0F] << 8, 0x0FDE); // the manual's example
        QCOMPARE(decodePosition(bytes.data(), bytes.size(), read), velodyne::PositionFault::None);
        QCOMPARE(read.stamp_us, packet.stamp_us);
        QCOMPARE(read.pps, packet.pps);
        QCOMPARE(read.nmea, packet.nmea);
        QVERIFY(std::abs(read.chips[0].gyro_dps - packet.chips[0].gyro_dps) < 1e-9);
        QVERIFY(std::abs(read.chips[0].temperature_c - packet.chips[0].temperature_c) < 1e-9);
        QVERIFY(std::abs(read.chips[0].accelX_g - packet.chips[0].accelX_g) < 1e-9);
        QVERIFY(std::abs(read.chips[0].accelY_g - packet.chips[0].accelY_g) < 1e-9);
        QVERIFY(read.chips[2].gyro_dps == 2047 * 0.09766 && read.chips[2].accelX_g == 0);
        packet.nmea.assign(velodyne::maximumNmea - 2, 'x');
        bytes = encodePosition(packet);
        QCOMPARE(decodePosition(bytes.data(), bytes.size(), read), velodyne::PositionFault::None);
        QCOMPARE(read.nmea, packet.nmea);
        packet.nmea += 'x'; // no room
        bytes = encodePosition(packet);
        QCOMPARE(decodePosition(bytes.data(), bytes.size(), read), velodyne::PositionFault::None);
        QVERIFY(read.nmea.empty());
    }

    void packetsAreSentOneInFourteen() {
        if (qEnvironmentVariableIsSet("HERMES_SLOWNESS"))
            QSKIP("1808 packets a second need real time, which an emulator (HERMES_SLOWNESS) does not have");
        QUdpSocket data, positions;
        QVERIFY(data.bind(QHostAddress(QHostAddress::LocalHost), 0));
        QVERIFY(positions.bind(QHostAddress(QHostAddress::LocalHost), 0));
        std::atomic<int> messages{0};
        PacketPump pump([](const Simulation::Truth &) {}, [&](const std::string &) { ++messages; });
        QVERIFY(pump.start(field(), {}, "127.0.0.1", data.localPort(), positions.localPort()));
        quint64 received = 0;
        std::uint32_t last = 0;
        const auto receive = [&] { // all the time: the socket holds little more than a second of them
            velodyne::PositionPacket packet;
            QByteArray bytes(2000, '\0');
            while (positions.hasPendingDatagrams()) {
                const qint64 size = positions.readDatagram(bytes.data(), bytes.size());
                QCOMPARE(decodePosition(reinterpret_cast<const std::uint8_t *>(bytes.constData()),
                                        std::size_t(size), packet),
                         velodyne::PositionFault::None);
                const std::uint32_t step =
                    (packet.stamp_us + velodyne::stampPeriod_us - last) % velodyne::stampPeriod_us;
                QVERIFY(received == 0 || std::abs(double(step) - 7741.44) <= 1);
                last = packet.stamp_us;
                ++received;
            }
        };
        connect(&positions, &QUdpSocket::readyRead, receive);
        QTRY_VERIFY(messages >= 4 && pump.counts().positions > 100);
        pump.stop();
        const PacketPump::Counts counts = pump.counts();
        QVERIFY(counts.sent / 14 == counts.positions && counts.sendErrors == 0);
        receive();
        QCOMPARE(quint64(counts.positions), received);
    }
};
