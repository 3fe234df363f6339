#include "protocol/drive/Bus.h"
#include "protocol/roboclaw/Packet.h"

using namespace hermes::roboclaw;
using hermes::drive::Bus;

class TestRoboClawBus : public QObject {
    Q_OBJECT

    /// A bus and what it did, on a clock of the test's own.
    struct Line {
        explicit Line(const Bus::Options &options = {})
            : bus(options) {}

        Bus bus;
        ReplyParser parser;
        double now = 0;
        std::vector<std::string> ended; ///< "COMMAND result attempts"
        std::vector<int> sent;          ///< commands

        bool submit(Command command, const Values &values = {}, Bus::Urgency urgency = Bus::Urgency::Normal,
                    std::uint8_t address = 0x80) {
            const auto handler = [this, command](const Bus::Outcome &outcome) {
                static const char *const results[] = {"done",       "timed out", "bad CRC",
                                                      "unexpected", "cancelled", "line closed"};
                ended.push_back(std::to_string(int(command)) + ' ' + results[int(outcome.result)] + ' ' +
                                std::to_string(outcome.attempts));
            };
            return bus.submit(request(command, values, address), handler, urgency);
        }
        hermes::drive::Request request(Command command, const Values &values = {},
                                       std::uint8_t address = 0x80) {
            return {&parser, Request::make(address, command, values)->bytes, address};
        }
        bool poll() {
            const Bytes *bytes = bus.poll(now);
            if (bytes)
                sent.push_back((*bytes)[1]);
            return bytes;
        }
        /// Lets time pass without an answer until something is sent again, or nothing is left to do.
        bool pollLater() {
            while (std::isfinite(bus.deadline())) {
                now = std::max(now, bus.deadline()) + 1e-9;
                if (poll())
                    return true;
            }
            return false;
        }
        void feed(const QByteArray &hex) {
            const QByteArray bytes = QByteArray::fromHex(hex);
            bus.feed(reinterpret_cast<const std::uint8_t *>(bytes.data()), std::size_t(bytes.size()), now);
        }
        std::string last() const { return ended.empty() ? "nothing" : ended.back(); }
    };
    /// One that has been asked for the battery's voltage.
    struct AskedLine : Line {
        AskedLine() {
            submit(Command::ReadMainBattery);
            [this] { QVERIFY(poll()); }();
        }
    };

private Q_SLOTS:
    void sendsOneAfterTheOther() {
        Line line;
        QVERIFY(!line.poll() && line.bus.isIdle() && std::isinf(line.bus.deadline()));
        line.submit(Command::Speed, {1, 2});
        line.submit(Command::ReadMainBattery);
        QVERIFY(line.poll());
        QVERIFY(!line.poll());
        line.now = 0.002;
        line.feed("FF");
        QCOMPARE(line.last(), std::string("37 done 1"));
        QVERIFY(line.poll());
        line.feed("00F0D8");
        QCOMPARE(line.ended.size(), std::size_t(1));
        line.feed("E5");
        QCOMPARE(line.last(), std::string("24 done 1"));
        QVERIFY(line.bus.isIdle());
        QCOMPARE(line.bus.counts(0x80).done, std::uint64_t(2));
        QCOMPARE(line.bus.counts(0x80).failed, std::uint64_t(0));
    }

    void repeatsWhatIsNotAnswered() {
        Line line;
        line.submit(Command::Speed, {1, 2});
        QVERIFY(line.poll());
        while (line.pollLater())
            ;
        QCOMPARE(line.last(), std::string("37 timed out 3"));
        QCOMPARE(line.sent, (std::vector<int>{37, 37, 37}));
        QVERIFY(line.now < 3 * (0.03 + 0.0111)); // a controller's own time-out of 0.2 s is not reached
        QCOMPARE(line.bus.counts(0x80).timeouts, std::uint64_t(3));
        QCOMPARE(line.bus.counts(0x80).retries, std::uint64_t(2));
        QCOMPARE(line.bus.counts(0x80).failed, std::uint64_t(1));
        line.submit(Command::Speed, {1, 2});
        QVERIFY(line.pollLater());
        QVERIFY(line.pollLater());
        line.feed("FF");
        QCOMPARE(line.last(), std::string("37 done 2"));
    }

    void repeatsWhatIsDamaged() {
        AskedLine line;
        line.feed("00F1D8E5");
        QVERIFY(line.ended.empty());
        QVERIFY(line.pollLater());
        line.feed("00F0D8E5");
        QCOMPARE(line.last(), std::string("24 done 2"));
        QCOMPARE(line.bus.counts(0x80).crcErrors, std::uint64_t(1));
        line.submit(Command::ResetEncoders);
        QVERIFY(line.poll());
        line.feed("FE");
        QVERIFY(line.pollLater());
        line.feed("FF");
        QCOMPARE(line.last(), std::string("20 done 2"));
        QCOMPARE(line.bus.counts(0x80).unexpected, std::uint64_t(1));
    }

    void waitsForSilenceAfterAFailure() {
        AskedLine line;
        line.feed("00F1D8E5"); // damaged at 0
        line.now = 0.0105;
        QVERIFY(!line.poll());
        line.feed("00"); // it still speaks
        QCOMPARE(line.bus.strayBytes(), std::uint64_t(1));
        line.now = 0.0125;
        QVERIFY(!line.poll());
        line.now = 0.0216;
        QVERIFY(line.poll());
    }

    void chatterDoesNotBlockForEver() {
        AskedLine line;
        line.feed("00F1D8E5");
        for (int i = 0; line.sent.size() == 1 && i < 100; ++i) {
            line.now += 0.001;
            line.feed("55");
            line.poll();
        }
        QVERIFY2(line.now > 0.05 && line.now < 0.06, saying(line.now));
    }

    void chatterDoesNotHoldUpWhatIsUrgent() {
        AskedLine line;
        line.feed("00F1D8E5"); // it fails
        line.submit(Command::SpeedAccel, {1000, 0, 0}, Bus::Urgency::First);
        line.submit(Command::SpeedAccel, {1000, 0, 0}, Bus::Urgency::First, 0x81);
        for (int i = 0; line.sent.size() < 3 && i < 100; ++i) {
            line.now += 0.001;
            line.feed("55");
            line.poll();
        }
        // The first repeats its request, which waits behind.
        QCOMPARE(line.sent, (std::vector<int>{24, 40, 40}));
        QVERIFY2(line.now < 0.025, saying(line.now));
    }

    void urgentRequestsGoFirst() {
        AskedLine line;
        line.submit(Command::ReadTemperature);
        line.submit(Command::Speed, {0, 0}, Bus::Urgency::First);
        line.feed("00F1D8E5"); // the one on its way fails: even its repetition waits
        line.submit(Command::Duty, {0, 0}, Bus::Urgency::First);
        QVERIFY(line.pollLater());
        line.feed("FF");
        QVERIFY(line.poll());
        line.feed("FF");
        QVERIFY(line.poll());
        line.feed("00F0D8E5");
        QVERIFY(line.poll());
        QCOMPARE(line.sent, (std::vector<int>{24, 37, 34, 24, 82}));
    }

    void cancelEndsWhatWaits() {
        AskedLine line;
        line.submit(Command::ReadTemperature);
        line.bus.cancel();
        QCOMPARE(line.last(), std::string("82 cancelled 0"));
        QCOMPARE(line.ended.size(), std::size_t(1));
        QVERIFY(!line.bus.isIdle());
        QVERIFY(!line.pollLater()); // not repeated
        QCOMPARE(line.last(), std::string("24 timed out 1"));
        line.submit(Command::ReadMainBattery);
        QVERIFY(line.pollLater());
        QVERIFY(line.pollLater()); // and the next one is
    }

    void closedLineEndsAll() {
        AskedLine line;
        line.submit(Command::ReadTemperature);
        line.bus.setOpen(false);
        QCOMPARE(line.ended, (std::vector<std::string>{"24 line closed 1", "82 line closed 0"}));
        line.submit(Command::Speed, {0, 0});
        QVERIFY(!line.poll());
        QCOMPARE(line.last(), std::string("37 line closed 0"));
        line.feed("00F0D8E5");
        QCOMPARE(line.ended.size(), std::size_t(3));
        line.bus.setOpen(true);
        line.submit(Command::Speed, {0, 0});
        QVERIFY(line.pollLater());
    }

    void tooManyAreRefused() {
        Bus::Options options;
        options.queue = 2;
        Line line(options);
        QVERIFY(line.submit(Command::ReadTemperature));
        QVERIFY(line.submit(Command::ReadTemperature));
        QVERIFY(!line.submit(Command::ReadTemperature));
        QVERIFY(line.ended.empty());
    }

    void shortStatusNeedsSilence() {
        Line line;
        std::int64_t status = -1;
        auto dialect = Dialect::Usual;
        line.bus.submit(line.request(Command::ReadStatus), [&](const Bus::Outcome &) {
            status = line.parser.reply()[0];
            dialect = line.parser.dialect();
        });
        QVERIFY(line.poll());
        line.feed("08048D1A");
        line.now = line.bus.deadline();
        QCOMPARE(line.now, 0.011);
        line.poll();
        QCOMPARE(status, std::int64_t(0x0804));
        QCOMPARE(dialect, Dialect::Other);
    }

    void countsEachAddress() {
        Line line;
        line.submit(Command::Speed, {0, 0});
        line.submit(Command::Speed, {0, 0}, Bus::Urgency::Normal, 0x81);
        QVERIFY(line.poll());
        line.feed("FF");
        while (line.poll() || line.pollLater())
            ;
        QCOMPARE(line.bus.counts(0x80).timeouts, std::uint64_t(0));
        QCOMPARE(line.bus.counts(0x81).timeouts, std::uint64_t(3));
        QCOMPARE(line.bus.counts(0x81).failed, std::uint64_t(1));
    }

    void handlersMaySubmit() {
        Line line;
        int left = 5;
        Bus::Handler again = [&](const Bus::Outcome &) {
            if (--left > 0)
                line.bus.submit(line.request(Command::ResetEncoders), again);
        };
        line.bus.submit(line.request(Command::ResetEncoders), again);
        while (line.poll())
            line.feed("FF");
        QCOMPARE(left, 0);
        QCOMPARE(line.sent.size(), std::size_t(5));
    }
};
