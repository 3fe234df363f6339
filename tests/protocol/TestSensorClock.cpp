// The sensor tells the time within the hour; the hour comes from elsewhere.
#include "protocol/velodyne/TurnAssembler.h"

using namespace hermes::velodyne;

static constexpr std::int64_t second_ns = 1000000000;
static constexpr std::int64_t hour_ns = 3600 * second_ns;

class TestSensorClock : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void stampsTakeTheHourOfTheReceiveTime_data() {
        const Rows<qint64, qint64, qint64> row("receive_s", "ofHour_s", "stamp_s");
        const qint64 hour = 400000 * 3600LL;
        row("within the hour", hour + 100, 99LL, hour + 99);
        row("before the hour, received after", hour + 1, 3599LL, hour - 1);
        row("after the hour, received before", hour - 1, 1LL, hour + 1);
    }

    void stampsTakeTheHourOfTheReceiveTime() {
        FETCH(qint64, receive_s, qint64, ofHour_s, qint64, stamp_s);
        StampClock clock;
        QCOMPARE(qint64(clock.absolute(std::uint32_t(ofHour_s * 1000000), receive_s * second_ns)),
                 stamp_s * second_ns);
    }

    void stampsOfAFreeRunningSensorDoNotJump() {
        // Half an hour away from the host, where the nearest hour changes with every jitter; over two turns
        // of the hour.
        StampClock clock;
        const std::int64_t host = 400000 * hour_ns;
        std::int64_t last = 0;
        for (int i = 0; i < 9000; ++i) {
            const std::int64_t receive = host + i * second_ns + (i % 3) * 1000000;
            const std::int64_t stamp = clock.absolute(std::uint32_t((1800 + i) % 3600) * 1000000u, receive);
            QVERIFY(i == 0 || stamp - last == second_ns);
            last = stamp;
        }
    }

    /// The receiver's clock is 5 hours slow, or steps: the hour of the GPS counts, until it is released.
    void aGpsTellsTheHour() {
        StampClock clock;
        const std::int64_t utc = 400000 * hour_ns + 3599 * second_ns, host = utc - 5 * hour_ns;
        QCOMPARE(clock.absolute(3599000000u, host), utc - 5 * hour_ns);
        clock.follow(utc);
        QCOMPARE(clock.absolute(3599000100u, host), utc + 100000);
        QCOMPARE(clock.absolute(100u, host + second_ns), utc + second_ns + 100000); // the hour begins anew
        QCOMPARE(clock.absolute(200u, host + 9 * hour_ns), utc + second_ns + 200000);
        clock.release(); // goes on in the same hour
        QCOMPARE(clock.absolute(300u, host + 9 * hour_ns + 100000), utc + second_ns + 300000);
    }
};
