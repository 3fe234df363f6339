#pragma once

#include "daemons/motorcontrol/DriveEngine.h"
#include "daemons/motorcontrol/LineMaster.h"
#include "daemons/simulator/Drivetrain.h"

/// The motor control without its thread, on a clock of its own: it drives emulated controllers about over a
/// line of 115,200 baud, of whose bytes a share has one bit flipped, both ways.
class VirtualDrive {
public:
    explicit VirtualDrive(double flips)
        : engine(defaults())
        , line({&engine.controller(0), &engine.controller(1)})
        , flips_(flips) {
        line.setOpen();
    }

    /// For so many seconds, from event to event; wheels and body move in steps of at most longestStep.
    void run(double seconds, double longestStep) {
        for (const double end = now_ + seconds; now_ < end;) {
            const double answer = answers_.empty() ? nextCycle_ : answers_.front().due;
            const double next = std::max(now_ + 1e-6, std::min({nextCycle_, answer, line.deadline()}));
            while (now_ < next)
                moveRobot(std::min(longestStep, next - now_));
            if (now_ >= nextCycle_)
                cycle();
            exchange();
        }
    }
    /// The program stands still for so long, while the robot does not.
    void stall(double seconds) {
        for (const double end = now_ + seconds; now_ < end;)
            moveRobot(0.001);
        nextCycle_ = now_;
    }
    /// The client falls silent, for so long.
    void rest(double seconds) {
        asks_ = false;
        run(seconds, 0.001);
    }

    hermes::motorcontrol::DriveEngine engine;
    hermes::motorcontrol::LineMaster line;
    hermes::simulator::Drivetrain robot;
    vectorlib::Pose2D truth; ///< of the body; it began at zero
    quint64 bytes = 0, flipped = 0;
    int refused = 0;         ///< motion commands
    int halts = 0;           ///< cycles in which the robot was held though its client drove
    int foreign = 0;         ///< packets that a controller carried out and that were never sent
    double longestPause = 0; ///< between two set-points that one controller carried out; seconds

private:
    static constexpr double period = 0.02, byteTime = 1 / 11520.0; // seconds
    static constexpr quint64 driver = 1;

    struct Late {
        double due;
        hermes::roboclaw::Bytes bytes;
    };

    static hermes::motorcontrol::MotorSettings defaults() {
        hermes::Settings settings;
        hermes::motorcontrol::declareMotorSettings(settings);
        return hermes::motorcontrol::MotorSettings::from(settings);
    }

    void moveRobot(double seconds) {
        truth = body_.move(truth, robot.advance(seconds), seconds);
        now_ += seconds;
    }
    void cycle() {
        nextCycle_ += period;
        engine.cycle(now_);
        const bool drives = asks_ && engine.drive().lease().isHeldBy(driver);
        halts += drives && !engine.report().haltReason.isEmpty();
        if (asks_ && ++cycles_ % 3 == 0)
            ask();
    }
    // At 17 Hz, speeds that change all the time, so that an old or a damaged set-point is another one.
    void ask() {
        if (!engine.controller(0).isReady() || !engine.controller(1).isReady())
            return;
        if (!engine.drive().lease().isHeldBy(driver) && !engine.drive().acquire(driver, "driver", 10, now_))
            return;
        const vectorlib::Twist2D twist{0.4 * std::sin(now_), 0.2 * std::sin(0.7 * now_),
                                       0.5 * std::cos(1.3 * now_)};
        refused += !engine.drive().driveTwist(driver, twist, 0, now_);
        engine.obey();
    }

    void exchange() {
        while (!answers_.empty() && answers_.front().due <= now_) {
            const hermes::roboclaw::Bytes answer = answers_.front().bytes;
            answers_.pop_front();
            line.feed(answer.data(), answer.size(), now_);
        }
        while (const hermes::roboclaw::Bytes *packet = line.poll(now_))
            deliver(*packet);
    }
    void deliver(const hermes::roboclaw::Bytes &packet) {
        remember(packet);
        std::array<quint64, 2> before{};
        for (int i = 0; i < 2; ++i)
            before[std::size_t(i)] = robot.controller(i).counts().requests;
        const hermes::roboclaw::Bytes sent = damaged(packet);
        const double arrived = now_ + byteTime * double(sent.size());
        const auto answers = robot.receive(0, sent.data(), sent.size(), arrived);
        for (int i = 0; i < 2; ++i) {
            if (robot.controller(i).counts().requests != before[std::size_t(i)])
                judge(i, !answers.empty() && answers.front().bytes.size() == 1);
        }
        for (const auto &answer : answers)
            answers_.push_back(
                {arrived + answer.delay + byteTime * double(answer.bytes.size()), damaged(answer.bytes)});
    }
    // Set-points: command 40 with acceleration and two speeds, 4 bytes each, the most significant one first.
    void remember(const hermes::roboclaw::Bytes &packet) {
        if (packet[1] != 40)
            return;
        const auto number = [&](std::size_t at) {
            quint32 value = 0;
            for (std::size_t i = 0; i < 4; ++i)
                value = value << 8 | packet[at + i];
            return double(qint32(value));
        };
        auto &asked = asked_[packet[0] % 2];
        asked.push_back({number(6), number(10)});
        if (asked.size() > 8)
            asked.pop_front();
    }
    void judge(int number, bool acknowledged) {
        const auto &asked = asked_[std::size_t(number)];
        const std::pair<double, double> targets{robot.controller(number).channel(0).target(),
                                                robot.controller(number).channel(1).target()};
        foreign +=
            targets != std::pair(0.0, 0.0) && std::find(asked.begin(), asked.end(), targets) == asked.end();
        if (!acknowledged)
            return;
        double &last = executed_[std::size_t(number)];
        if (last > 0)
            longestPause = std::max(longestPause, now_ - last);
        last = now_;
    }
    hermes::roboclaw::Bytes damaged(const hermes::roboclaw::Bytes &packet) {
        hermes::roboclaw::Bytes result;
        for (std::size_t i = 0; i < packet.size(); ++i, ++bytes) {
            const bool flip = std::uniform_real_distribution<double>()(random_) < flips_;
            flipped += flip;
            result.push(quint8(packet[i] ^ (flip ? 1 << random_() % 8 : 0)));
        }
        return result;
    }

    double flips_;
    bool asks_ = true;
    std::mt19937_64 random_{5};
    hermes::simulator::RobotBody body_; // no walls
    double now_ = 1, nextCycle_ = 1;
    quint64 cycles_ = 0;
    std::deque<Late> answers_;
    std::array<std::deque<std::pair<double, double>>, 2> asked_;
    std::array<double, 2> executed_{};
};
