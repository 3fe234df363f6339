#include "daemons/velodynelogger/PlayTime.h"

#include <cstring>
#include <new>

using namespace hermes;
using namespace hermes::velodynelogger;

constexpr std::int64_t second_ns = 1000000000;
constexpr std::int64_t start_ns = 1700000000 * second_ns;

/// Through a pointer that the compiler cannot follow.
static PlayTime *(*volatile begin)(void *, std::int64_t) = [](void *memory, std::int64_t length_ns) {
    return new (memory) PlayTime(start_ns, length_ns, 3 * second_ns);
};
class TestPlayTime : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void longStepsAreAClockThatWasSet_data() {
        const Rows<int, int, int> row("length_s", "step_s", "played_s");
        row("within a minute", 10, 60, 60);
        row("longer than a minute", 10, 61, 0);
        row("within a long recording", 600, 599, 599);
        row("longer than the recording", 600, 601, 0);
        row("back", 600, -1, 0);
    }

    void longStepsAreAClockThatWasSet() {
        FETCH(int, length_s, int, step_s, int, played_s);
        for (const int before : {0x00, 0x7f, 0xff}) { // whatever lay there must not matter
            alignas(PlayTime) unsigned char memory[sizeof(PlayTime)];
            std::memset(memory, before, sizeof memory);
            PlayTime &time = *begin(memory, length_s * second_ns);
            QCOMPARE(time.now_ns(), 3 * second_ns);
            QCOMPARE(time.advance(start_ns + step_s * second_ns), (3 + played_s) * second_ns);
        }
    }

    void theSensorTellsWhatPassed_data() {
        const Rows<double, double, double> row("host_s", "sensor_s", "played_s");
        row("they agree", 0.1, 0.1, 0.1);
        row("the clock was set forward", 15.1, 0.1, 0.1);
        row("nothing came for long", 15.0, 15.0, 15.0);
        row("the sensor began anew", 15.0, -5.0, 15.0);
        row("the clock was set back", -15.0, 0.1, 0.0);
        row("a little off", 0.9, 0.1, 0.9);
    }

    void theSensorTellsWhatPassed() {
        FETCH(double, host_s, double, sensor_s, double, played_s);
        for (const double hour_s : {100.0, 3599.95}) { // over the top of the hour, too
            velodyne::DataPacketWriter writer;
            const auto packet = [&writer](double from_start_s, double sensor, std::uint32_t source) {
                writer.setTail(std::uint32_t(std::int64_t(sensor * 1e6 + 3.6e9) % 3600000000));
                Datagram datagram;
                datagram.source = source;
                datagram.stamp_ns = start_ns + std::int64_t(from_start_s * 1e9);
                datagram.payload = writer.bytes().data();
                datagram.size = writer.bytes().size();
                return datagram;
            };
            PlayTime time(start_ns, 600 * second_ns, 0);
            time.advance(packet(1, hour_s, 1));
            Datagram other;
            other.stamp_ns = start_ns + second_ns + second_ns / 100; // 10 ms later
            time.advance(other);
            QVERIFY(std::abs(double(time.advance(packet(1 + host_s, hour_s + sensor_s, 1))) * 1e-9 -
                             std::max(1.01, 1 + played_s)) < 1e-6);
            // Of another sensor nothing is known.
            const std::int64_t now_ns = time.now_ns();
            QVERIFY(std::abs(time.advance(packet(1 + host_s + 15, hour_s, 2)) - now_ns - 15 * second_ns) <
                    1000);
        }
    }
};
