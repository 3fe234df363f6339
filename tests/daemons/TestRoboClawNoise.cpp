#include "daemons/simulator/Drivetrain.h"
#include "protocol/roboclaw/Bus.h"
#include "tests/support/HeapGrowth.h"

using namespace hermes;
using namespace hermes::simulator;
using namespace hermes::roboclaw;

/// Serial traffic of ten minutes and of a day, on a clock of its own.
class TestRoboClawNoise : public QObject {
    Q_OBJECT

    static constexpr double step = 0.001, byteTime = 1 / 11520.0; // 115200 baud
    static constexpr double cycle = 0.02;

    /// A host that drives at 50 Hz over a line that damages bytes, on a clock of its own.
    class NoisyDrive {
    public:
        explicit NoisyDrive(double flips)
            : flips_(flips) {
            for (const std::uint8_t address : {0x80, 0x81}) {
                for (const Command command : {Command::SetVelocityPidM1, Command::SetVelocityPidM2})
                    bus.submit(*Request::make(address, command, {0, 0x10000, 0x8000, qpps}));
            }
        }

        /// Simulates so many seconds; with physics the wheels turn.
        void run(double seconds, bool physics) {
            for (const double end = now_ + seconds; now_ < end; now_ += step) {
                if (now_ >= nextCycle_)
                    beginCycle();
                exchange();
                if (physics)
                    checkMotors();
            }
        }

        Bus bus;
        Drivetrain drivetrain;
        std::uint64_t flipped = 0, bytes = 0;
        double longestStall = 0; ///< between two set-points that one controller acknowledged
        int wrong = 0;           ///< what no command asked for: too fast, encoders set, settings changed

    private:
        static constexpr std::int64_t qpps = 150000, fastest = 30000;

        void beginCycle() {
            nextCycle_ += cycle;
            bus.cancel();
            const auto speed = std::int64_t(double(fastest) * std::sin(now_));
            for (const std::uint8_t address : {0x80, 0x81}) {
                const std::size_t index = address - 0x80U;
                bus.submit(*Request::make(address, Command::SpeedAccel, {200000, speed, speed}),
                           [this, index](const Request &, const Bus::Outcome &outcome) {
                               if (outcome.result != Bus::Result::Done)
                                   return;
                               longestStall = std::max(longestStall, now_ - obeyed_[index]);
                               obeyed_[index] = now_;
                           });
                bus.submit(*Request::make(address, Command::ReadEncoders));
            }
        }

        void exchange() {
            while (const Bytes *packet = bus.poll(now_)) {
                const Bytes sent = damaged(*packet);
                answers_.clear();
                const double arrived = now_ + byteTime * double(sent.size());
                for (const auto &answer : drivetrain.receive(0, sent.data(), sent.size(), arrived))
                    answers_.push_back(damaged(answer.bytes));
                for (const Bytes &answer : answers_)
                    bus.feed(answer.data(), answer.size(), arrived);
            }
        }

        Bytes damaged(const Bytes &packet) {
            Bytes result;
            for (std::size_t i = 0; i < packet.size(); ++i, ++bytes) {
                const bool flip = flips_ > 0 && std::uniform_real_distribution<double>()(random_) < flips_;
                flipped += flip;
                result.push(std::uint8_t(packet[i] ^ (flip ? 1 << random_() % 8 : 0)));
            }
            return result;
        }

        void checkMotors() {
            drivetrain.advance(step);
            for (int wheel = 0; wheel < 4; ++wheel) {
                const MotorChannel &motor = drivetrain.wheel(wheel);
                const std::int64_t count = motor.count(), way = std::abs(count - counts_[std::size_t(wheel)]);
                counts_[std::size_t(wheel)] = count;
                const bool fast = std::abs(motor.speed()) > fastest * 1.05;
                const bool jumped = double(way) > fastest * 1.05 * step + 1;
                const bool changed = now_ > 1 && (motor.pid().qpps != qpps || motor.pid().p != 1);
                wrong += fast || jumped || changed;
            }
            for (const int controller : {0, 1})
                wrong += drivetrain.controller(controller).serialTimeout() != 0;
        }

        double flips_;
        std::mt19937_64 random_{5};
        double now_ = 0, nextCycle_ = 1; // first the gains are set
        std::array<double, 2> obeyed_{nextCycle_, nextCycle_};
        std::array<std::int64_t, 4> counts_{};
        std::vector<Bytes> answers_;
    };

private Q_SLOTS:
    void tenMinutesOfFlippedBytes() {
        NoisyDrive drive(1e-3);
        drive.run(600, true);
        QVERIFY(drive.flipped > 500);
        QCOMPARE(drive.wrong, 0);
        QVERIFY2(drive.longestStall < 0.25, qPrintable(QString::number(drive.longestStall)));
        std::uint64_t counted = 0;
        for (const std::uint8_t address : {0x80, 0x81}) {
            const Bus::Counts &counts = drive.bus.counts(address);
            counted += counts.timeouts + counts.crcErrors + counts.unexpected;
            QVERIFY2(counts.done > 54000, qPrintable(QString::number(counts.done)));
        }
        qInfo("%llu of %llu bytes flipped, %llu failures counted, longest stall %.3f s", drive.flipped + 0ULL,
              drive.bytes + 0ULL, counted + 0ULL, drive.longestStall);
        QVERIFY(counted > drive.flipped * 8 / 10 && counted <= drive.flipped * 2);
    }

    void aCleanLineLosesNothing() {
        NoisyDrive drive(0);
        drive.run(60, true);
        for (const std::uint8_t address : {0x80, 0x81}) {
            QCOMPARE(drive.bus.counts(address).failed, std::uint64_t(0));
            QCOMPARE(drive.bus.counts(address).retries, std::uint64_t(0));
        }
        QVERIFY(drive.longestStall < 0.0211);
    }

    void trafficNeedsNoMoreMemory() {
        NoisyDrive drive(1e-3);
        verifyTrafficNeedsNoMoreMemory([&](double seconds) { drive.run(seconds, false); },
                                       [&] { return drive.bytes; });
    }
};

QTEST_GUILESS_MAIN(TestRoboClawNoise)
#include "TestRoboClawNoise.moc"
