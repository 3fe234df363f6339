// What an emulated controller says on its line.
#include "RoboClawClient.h"

using namespace hermes;
using namespace hermes::simulator;

class TestRoboClawEmulator : public QObject, DrivetrainFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { make(); }

    void answersAsPublished_data() {
        Rows<QByteArray, QByteArray>("sent", "answer");
        const auto row = [](const char *name, const char *sent, const char *answer) {
            QTest::newRow(name) << QByteArray::fromHex(sent) << QByteArray::fromHex(answer);
        };
        row("both speeds", "802500000000000000003404", "FF");
        row("second controller", "8125FFFFF63C000009C4D2B7", "FF");
        row("time-out", "800E0548F0", "FF");
        row("reset", "8014492D", "FF");
        row("PID", "801C0000400000010000000080000000ABE026FA", "FF");
        row("key", "805EE22EAB7AE4A6", "FF");
        row("battery", "8018", "00FC1969"); // 25.2 V
        row("counts", "804E", "0000000000000000C89A");
        row("buffers", "802F", "8080FDDF");
        row("wrong CRC", "802500000000000000003405", "");
        row("no such command", "8049", "");
        row("another address",
            "82250000000000000000"
            "EA8E",
            "");
        row("two in one", "80148018", "");
        row("version", "8015",
            "526F626F436C6177203278343541 2076342E322E380A00"
            "0000");
    }

    void answersAsPublished() {
        FETCH(QByteArray, sent, QByteArray, answer);
        Drivetrain::Options options;
        options.battery.full = 25.2;
        make(options);
        pass(drivetrain, 0.001);
        if (QByteArray(QTest::currentDataTag()) == "version") // its CRC is that of the oracle
            answer = answer.left(answer.size() - 2) +
                     number(RoboClawClient::crcOf(sent + answer.left(answer.size() - 2)), 2);
        QCOMPARE(client.send(sent).toHex(), answer.toHex());
    }

    void bothAddressesShareALine() {
        QVERIFY(client.write(0x80, 22, number(111, 4)));
        QVERIFY(client.write(0x81, 22, number(222, 4)));
        QCOMPARE(client.count(0x80, 0), std::int64_t(111));
        QCOMPARE(client.count(0x81, 0), std::int64_t(222));
        QCOMPARE(client.read(0x82, 24), QByteArray("silent"));
        QCOMPARE(RoboClawClient(drivetrain, 1).read(0x81, 24), QByteArray("silent"));
        // Several packets in one piece are answered in order.
        QCOMPARE(client.send(QByteArray::fromHex("802F812F")).size(), 8);
    }

    void linesOfTheirOwn() {
        Drivetrain::Options options;
        options.ownLines = true;
        options.controller[0].anyAddress = options.controller[1].anyAddress = true; // as on USB
        make(options);
        RoboClawClient first(drivetrain, 0), second(drivetrain, 1);
        QVERIFY(first.write(0x80, 22, number(111, 4)));
        QCOMPARE(first.count(0x87, 0), std::int64_t(111));
        QCOMPARE(second.count(0x80, 0), std::int64_t(0));
    }

    void gapsAndDamageAreSilent() {
        const QByteArray stop = QByteArray::fromHex("802500000000000000003404");
        QCOMPARE(client.send(stop.left(5)), QByteArray());
        QCOMPARE(client.send(stop.mid(5), 0.009).toHex(), QByteArray("ff"));
        QCOMPARE(client.send(stop.left(5)), QByteArray());
        QCOMPARE(client.send(stop.mid(5), 0.011), QByteArray()); // a gap of more than 10 ms
        QCOMPARE(client.send(stop).toHex(), QByteArray("ff"));
        for (int bit = 0; bit < stop.size() * 8; ++bit) {
            QByteArray damaged = QByteArray::fromHex("8025000003E8FFFFFC188290");
            damaged[bit / 8] = char(damaged[bit / 8] ^ (1 << bit % 8));
            client.send(damaged);
            pass(drivetrain, 0.002);
            QVERIFY2(!drivetrain.isMoving(), saying("bit %1", bit));
        }
        QVERIFY(drivetrain.controller(0).counts().crcErrors > 70);
    }

    void everyReadAnswers() {
        const QMap<int, int> sizes{{15, 1},  {16, 5},  {17, 5},  {18, 5},   {19, 5},  {24, 2},  {25, 2},
                                   {30, 5},  {31, 5},  {47, 2},  {48, 4},   {49, 4},  {55, 16}, {56, 16},
                                   {59, 4},  {60, 4},  {63, 28}, {64, 28},  {72, 4},  {75, 3},  {77, 2},
                                   {78, 8},  {79, 8},  {81, 8},  {82, 2},   {83, 2},  {90, 4},  {91, 2},
                                   {99, 2},  {101, 2}, {104, 4}, {107, 12}, {108, 8}, {110, 8}, {113, 8},
                                   {116, 2}, {118, 4}, {135, 8}, {136, 8},  {149, 1}};
        for (auto entry = sizes.begin(); entry != sizes.end(); ++entry) {
            const QByteArray data = client.read(0x80, entry.key());
            QVERIFY2(data.size() == entry.value() && data != "silent",
                     saying("command %1: %2", entry.key(), QString(data)));
        }
        QCOMPARE(client.read(0x80, 21), QByteArray("RoboClaw 2x45A v4.2.8\n\0", 23));
    }

    // The writes of the published table and the bytes of their data.
    void everyWriteIsAcknowledged() {
        QMap<int, int> sizes{{14, 1},  {20, 0},  {22, 4},  {23, 4},  {28, 16}, {29, 16}, {32, 2},  {33, 2},
                             {34, 4},  {35, 4},  {36, 4},  {37, 8},  {38, 8},  {39, 8},  {40, 12}, {41, 9},
                             {42, 9},  {43, 17}, {44, 13}, {45, 13}, {46, 21}, {50, 16}, {51, 25}, {52, 6},
                             {53, 6},  {54, 12}, {57, 4},  {58, 4},  {61, 28}, {62, 28}, {65, 17}, {66, 17},
                             {67, 33}, {68, 4},  {69, 4},  {70, 2},  {71, 2},  {74, 3},  {80, 0},  {92, 1},
                             {93, 1},  {95, 0},  {98, 2},  {109, 8}, {112, 8}, {133, 8}, {134, 8}, {148, 1},
                             {76, 2},  {100, 2}, {102, 2}, {103, 2}, {105, 6}, {106, 6}, {115, 2}, {117, 4}};
        for (int command = 0; command <= 13; ++command)
            sizes[command] = 1;
        sizes[26] = sizes[27] = 1;
        std::uint64_t requests = 0;
        for (auto entry = sizes.begin(); entry != sizes.end(); ++entry) {
            const QByteArray name = "command " + QByteArray::number(entry.key());
            QVERIFY2(client.write(0x80, entry.key(), QByteArray(entry.value(), '\0')), name.constData());
            QCOMPARE(drivetrain.controller(0).counts().requests, ++requests);
            if (entry.value() == 0)
                continue;
            QVERIFY2(!client.write(0x80, entry.key(), QByteArray(entry.value() - 1, '\0')), name.constData());
            QCOMPARE(drivetrain.controller(0).counts().requests, requests);
        }
        QVERIFY(client.write(0x80, 94, number(0xE22EAB7A, 4)));
    }

    void settingsAreKept() {
        QVERIFY(client.write(0x80, 14, number(3, 1)));
        QCOMPARE(client.read(0x80, 15), number(3, 1));
        QByteArray dpi, pid; // D, P, I, QPPS are told as P, I, D, QPPS
        for (const int value : {0x4000, 0x18000, 0x8000, 44000})
            dpi += number(value, 4);
        for (const int value : {0x18000, 0x8000, 0x4000, 44000})
            pid += number(value, 4);
        QVERIFY(client.write(0x80, 28, dpi));
        QCOMPARE(client.read(0x80, 55), pid);
        QVERIFY(client.read(0x80, 56) != pid);
        QVERIFY(client.write(0x80, 57, number(0x00960104, 4)));
        QCOMPARE(client.read(0x80, 59), number(0x00960104, 4));
        client.write(0x80, 253, number(0x05ABCD, 3));
        QCOMPARE(client.read(0x80, 252, number(5, 1)), number(0xABCD, 2));
        QCOMPARE(client.read(0x80, 252, number(6, 1)), number(0, 2));
        for (const auto &[write, read] : std::vector<std::pair<int, int>>{{76, 77}, {100, 101}, {117, 118}}) {
            const QByteArray data = number(0x01020304, read == 118 ? 4 : 2);
            QVERIFY(client.write(0x80, write, data));
            QCOMPARE(client.read(0x80, read), data);
        }
        QVERIFY(client.write(0x80, 70, number(1111, 2)));
        QVERIFY(client.write(0x80, 71, number(2222, 2)));
        QCOMPARE(client.read(0x80, 72), number(1111, 2) + number(2222, 2));
        QVERIFY(client.write(0x80, 103, number(65535, 2)));
        QCOMPARE(client.read(0x80, 104), number(0xFFFF, 4));
        QVERIFY(client.write(0x80, 105, number(8000, 2) + number(3000, 4)));
        QCOMPARE(client.read(0x80, 107), number(8000, 2) + number(3000, 4) + number(0, 6));
        const auto volts = integer(client.read(0x80, 24), 0, 2);
        QVERIFY(client.write(0x80, 115, number(-10, 1) + number(3, 1)));
        QCOMPARE(client.read(0x80, 116).toHex(), QByteArray("f603"));
        QCOMPARE(integer(client.read(0x80, 24), 0, 2), volts - 10);
        QCOMPARE(integer(client.read(0x80, 25), 0, 2), std::int64_t(53));
        QVERIFY(client.write(0x80, 93, number(0x20, 1)));
        QCOMPARE(client.read(0x80, 91), number(0x0020, 2));
        QVERIFY(!client.write(0x80, 94, number(1, 4))); // not the key
        QVERIFY(client.write(0x80, 95));
        QCOMPARE(client.read(0x80, 55), pid);
        QVERIFY(client.write(0x80, 80));
        QCOMPARE(client.read(0x80, 55), client.read(0x80, 56));
        QCOMPARE(client.read(0x80, 15), number(0, 1));
    }

    void faultsOfTheLine() {
        RoboClawEmulator::Faults &faults = drivetrain.controller(0).faults();
        faults.drop = 0.3;
        int silent = 0;
        for (int i = 0; i < 300; ++i)
            silent += client.read(0x80, 24) == "silent";
        QVERIFY(silent > 60 && silent < 120);
        faults = {};
        faults.corrupt = 0.3;
        int wrong = 0;
        for (int i = 0; i < 300; ++i)
            wrong += client.read(0x80, 24) == "wrong CRC";
        QVERIFY(wrong > 60 && wrong < 120);
        faults = {};
        faults.delay = 0.025;
        QVERIFY(client.read(0x80, 24).size() == 2);
        QCOMPARE(client.delay, 0.025);
        faults = {};
        setQpps(client);
        QVERIFY(client.speeds(0x80, 10000, 10000, 300000));
        pass(drivetrain, 0.5);
        faults.silent = true;
        QCOMPARE(client.read(0x80, 24), QByteArray("silent"));
        QVERIFY(client.read(0x81, 24).size() == 2);
        pass(drivetrain, 5);
        QVERIFY(drivetrain.controller(0).channel(0).speed() < 1000); // a dead controller drives nothing
    }

    void statusBitsOfBothWidths() {
        Drivetrain::Options options;
        options.controller[1].status = roboclaw::Dialect::Other;
        make(options);
        for (const int i : {0, 1})
            drivetrain.controller(i).faults().status = 0x00080001;
        QCOMPARE(client.read(0x80, 90).toHex(), QByteArray("00080001"));
        QCOMPARE(client.read(0x81, 90).toHex(), QByteArray("0804"));
    }

    void oldCommandsSetTheLimits() {
        const auto set = [&](int command, int value) {
            QVERIFY(client.write(0x80, command, number(value, 1)));
        };
        const auto limits = [&](int command) {
            const QByteArray told = client.read(0x80, command);
            return QPair<int, int>(int(integer(told, 0, 2)), int(integer(told, 2, 2)));
        };
        const auto logic = limits(60);
        set(2, 25); // (11 V - 6 V) * 5
        QCOMPARE(limits(59), qMakePair(110, 340));
        set(3, 128); // 25 V * 5.12
        QCOMPARE(limits(59), qMakePair(110, 250));
        QCOMPARE(limits(60), logic);
        set(26, 10); // 8 V
        set(27, 92); // 18 V
        QCOMPARE(limits(60), qMakePair(80, 180));
        QCOMPARE(limits(59), qMakePair(110, 250));
        set(2, 140); // 34 V
        pass(drivetrain, 0.01);
        QVERIFY(integer(client.read(0x80, 90), 0, 4) & 0x4000);
    }

    void encoderStatusTellsWraps() {
        setQpps(client);
        const auto status = [&](int command) { return int(quint8(client.read(0x80, command)[4])); };
        const auto drive = [&](int m1, int m2) {
            QVERIFY(client.speeds(0x80, m1, m2, 1000000));
            pass(drivetrain, 0.1);
        };
        QCOMPARE(status(16), 0);
        QVERIFY(client.write(0x80, 22, number(-5, 4)));
        QCOMPARE(status(16), 0); // what is set is no wrap
        drive(10000, -10000);
        QCOMPARE(status(16), 4);     // over the end of 32 bits
        QCOMPARE(status(16), 0);     // it clears on reading
        QCOMPARE(status(17), 2 | 1); // below 0, and backward
        QCOMPARE(status(17), 2);
        drive(-20000, 0);
        QCOMPARE(status(16), 2 | 1);
        QCOMPARE(client.read(0x80, 78).size(), 8); // tells no status and clears none
        drive(20000, 0);
        drive(20000, 0);
        QCOMPARE(status(16), 4);
    }

    // The manual tells 0xFF; a public client of the maker waits for one byte more.
    void writtenCellIsAcknowledgedTwice() {
        QByteArray packet = QByteArray::fromHex("80FD05ABCD");
        packet += number(RoboClawClient::crcOf(packet), 2);
        QCOMPARE(client.send(packet).toHex(), QByteArray("ffaa"));
        QCOMPARE(client.delay, 0.005); // of the second: once the first was read
        QCOMPARE(client.read(0x80, 252, number(5, 1)), number(0xABCD, 2));
    }

    void firmwareKnowsItsCommands_data() {
        const Rows<QString, int, QList<int>> row("firmware", "statusSize", "unknown");
        row("16 bits", "4.1.28", 2, {72, 107, 110, 113, 116, 118});
        row("usual", "4.2.8", 4, {});
        row("new", "4.3.6", 4, {101, 104, 107});
    }

    void firmwareKnowsItsCommands() {
        FETCH(QString, firmware, int, statusSize, QList<int>, unknown);
        Drivetrain::Options options;
        options.controller[0].setFirmware(firmware.toStdString());
        make(options);
        QCOMPARE(client.read(0x80, 21), ("RoboClaw 2x45A v" + firmware + "\n").toLatin1() + '\0');
        QCOMPARE(client.read(0x80, 90).size(), statusSize);
        for (const int command : {15, 24, 49, 72, 77, 78, 101, 104, 107, 110, 113, 116, 118})
            QCOMPARE(client.read(0x80, command) == "silent", unknown.contains(command));
        const bool knowsOld = firmware != "4.3.6";
        QCOMPARE(client.write(0x80, 0, number(127, 1)), knowsOld);
        pass(drivetrain, 0.2);
        QCOMPARE(drivetrain.isMoving(), knowsOld);
    }

    void newFirmwareHasItsOwnFields() {
        Drivetrain::Options options;
        options.controller[0].setFirmware("4.3.6");
        make(options);
        QCOMPARE(client.read(0x80, 59).toHex(), QByteArray("003c015400"));
        QVERIFY(!client.write(0x80, 57, QByteArray::fromHex("00640104")));
        pass(drivetrain, 0.02);
        QVERIFY(client.write(0x80, 57, QByteArray::fromHex("0064010401")));
        QCOMPARE(client.read(0x80, 59).toHex(), QByteArray("0064010401"));
        QVERIFY(client.write(0x80, 68, number(1000, 4) + number(2000, 4)));
        QCOMPARE(client.read(0x80, 81), number(1000, 4) + number(0, 4));
        QVERIFY(client.write(0x80, 74, QByteArray::fromHex("0102030405")));
        QCOMPARE(client.read(0x80, 75).toHex(), QByteArray("010203"));
        QVERIFY(client.write(0x80, 148, QByteArray::fromHex("0101")));
        QCOMPARE(client.read(0x80, 149).toHex(), QByteArray("01"));
    }

    void commandsCanBeUnknown() {
        Drivetrain::Options options;
        options.controller[0].unknown = {roboclaw::Command::SetSerialTimeout};
        make(options);
        QVERIFY(!client.write(0x80, 14, number(2, 1)));
        QVERIFY(client.write(0x81, 14, number(2, 1)));
        QCOMPARE(client.read(0x80, 15), number(0, 1));
        QCOMPARE(drivetrain.controller(0).counts().unknown, std::uint64_t(1));
    }

    void versionWithoutLineFeed() {
        Drivetrain::Options options;
        options.controller[0].versionLineFeed = false;
        make(options);
        QCOMPARE(client.read(0x80, 21), QByteArray("RoboClaw 2x45A v4.2.8\0", 22));
    }
};
