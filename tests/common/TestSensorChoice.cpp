// Of several sensors one is taken.
#include "common/capture/LidarStream.h"

using namespace hermes;

class TestSensorChoice : public QObject {
    Q_OBJECT

    static constexpr std::uint32_t first = 0xC0A801C9, second = 0xC0A801CA;
    static constexpr std::int64_t second_ns = 1000000000;

    static Datagram packet(std::uint32_t address, std::int64_t stamp_ns = 0, std::uint16_t port = 2368,
                           std::uint16_t from = 443) {
        Datagram datagram;
        datagram.source = address;
        datagram.destinationPort = port;
        datagram.sourcePort = from;
        datagram.stamp_ns = stamp_ns;
        return datagram;
    }

    static SensorChoice patient() {
        SensorChoice::Options options;
        options.timeout_ns = second_ns;
        return SensorChoice(options);
    }

private Q_SLOTS:
    void theFirstIsTaken() {
        SensorChoice choice;
        QVERIFY(!choice.taken() && choice.mayTake(packet(first)) && choice.isFromTaken(packet(second)));
        QVERIFY(choice.takes(packet(first)));
        QVERIFY(!choice.takes(packet(second)));
        QVERIFY(!choice.takes(packet(first, 0, 2369)));
        QVERIFY(choice.takes(packet(first, 1000)));
        QVERIFY(!choice.takes(packet(second, 3600 * second_ns))); // however late
        QVERIFY(choice.mayTake(packet(first)) && !choice.mayTake(packet(second)));
        QVERIFY(choice.isFromTaken(packet(first, 0, 8308)) && !choice.isFromTaken(packet(second, 0, 8308)));
        QCOMPARE(choice.sensors().size(), std::size_t(3));
        QCOMPARE(toText(*choice.taken()), std::string("192.168.1.201:443 to port 2368"));
        QCOMPARE(choice.taken()->packets, std::uint64_t(2));
    }

    void onlyWhatIsAskedForIsTaken() {
        SensorChoice::Options options;
        options.port = 2369;
        SensorChoice byPort(options);
        QVERIFY(!byPort.takes(packet(first)) && !byPort.mayTake(packet(first)) && !byPort.taken());
        QVERIFY(byPort.takes(packet(second, 0, 2369)));
        options.address = second;
        SensorChoice byBoth(options);
        QVERIFY(!byBoth.takes(packet(first, 0, 2369)));
        QVERIFY(!byBoth.takes(packet(second)));
        QVERIFY(byBoth.takes(packet(second, 0, 2369)));
        QCOMPARE(byBoth.sensors().size(), std::size_t(3));
        // As long as none is taken the position packets of others do not tell its hour.
        options = {};
        options.address = second;
        SensorChoice byAddress(options);
        QVERIFY(byAddress.isFromTaken(packet(second, 0, 8308)) &&
                !byAddress.isFromTaken(packet(first, 0, 8308)));
    }

    void anotherTakesThePlaceOfASilentOne() {
        SensorChoice choice = patient();
        QVERIFY(choice.takes(packet(first)));
        QVERIFY(!choice.takes(packet(second, second_ns)));
        QVERIFY(choice.takes(packet(second, second_ns + 1)));
        QVERIFY(!choice.takes(packet(first, second_ns + 2)));
    }

    void twoOfOneAddressAreTwo() {
        for (SensorChoice choice : {SensorChoice(), patient()}) {
            QVERIFY(choice.takes(packet(first)));
            QVERIFY(!choice.takes(packet(first, 500, 2368, 5000)) && choice.takes(packet(first, 1000)));
            QCOMPARE(choice.sensors().size(), std::size_t(2));
            QVERIFY(choice.takes(packet(first, 2 * second_ns, 2368, 5000))); // it began anew
            QVERIFY(!choice.takes(packet(second, 2 * second_ns)));
        }
    }

    void aJumpIsNoSilence() {
        SensorChoice choice = patient();
        QVERIFY(choice.takes(packet(first)));
        choice.jump();
        QVERIFY(!choice.takes(packet(second, 100 * second_ns)));
        QVERIFY(choice.takes(packet(first, 100 * second_ns + 1)));
        choice.jump();
        QVERIFY(!choice.takes(packet(second, 50 * second_ns)));
        QVERIFY(choice.takes(packet(second, 51 * second_ns + 1))); // it is not there any more
    }

    void manySensorsDoNotFillTheMemory() {
        for (const std::uint32_t wanted : {1u, 100u}) {
            SensorChoice::Options options;
            options.address = wanted;
            SensorChoice choice(options);
            for (std::uint32_t address = 1; address < 1000; ++address) {
                QCOMPARE(choice.takes(packet(address)), address == wanted);
                QVERIFY(choice.takes(packet(wanted)));
            }
            QCOMPARE(choice.sensors().size(), std::size_t(16));
            QCOMPARE(choice.taken()->address, wanted);
        }
    }
};
