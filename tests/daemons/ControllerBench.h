#pragma once

#include "daemons/motorcontrol/LineMaster.h"
#include "daemons/simulator/RoboClawEmulator.h"

/// Controllers of the motor control on one line with emulated RoboClaws, on a clock of its own. What is sent
/// and answered passes through hooks that may lose or change it.
class ControllerBench {
public:
    using Bytes = hermes::roboclaw::Bytes;
    using Command = hermes::roboclaw::Command;
    static constexpr qint32 fast = 30000; ///< counts/s: half a metre a second
    /// What was sent: when, to which controller (0, 1), what.
    struct Packet {
        double time;
        int controller;
        Bytes bytes;

        Command command() const { return Command(bytes[1]); }
        qint32 number(std::size_t at) const {
            quint32 value = 0;
            for (std::size_t i = 0; i < 4; ++i)
                value = value << 8 | bytes[at + i];
            return qint32(value);
        }
        /// A set-point of zero, or no duty.
        bool isStop() const {
            return (command() == Command::SpeedAccel && number(6) == 0 && number(10) == 0) ||
                   (command() == Command::Duty && number(2) == 0);
        }
        bool isSetPoint() const { return command() == Command::SpeedAccel && !isStop(); }
    };

    explicit ControllerBench(int count = 2, double timeout_s = 0.2) {
        hermes::Settings values;
        hermes::motorcontrol::declareMotorSettings(values);
        settings = hermes::motorcontrol::MotorSettings::from(values);
        settings.serialTimeout_s = timeout_s;
        std::vector<hermes::motorcontrol::MotorController *> onLine;
        for (int i = 0; i < count; ++i) {
            settings.controllers[std::size_t(i)].url = "serial:///dev/line";
            auto controller = std::make_unique<hermes::motorcontrol::MotorController>(
                i + 1, settings.controllers[std::size_t(i)], count);
            controller->configure(settings);
            onLine.push_back(controller.get());
            controllers_.push_back(std::move(controller));
            hermes::simulator::RoboClawEmulator::Options options;
            options.address = std::uint8_t(0x80 + i);
            emulators_.emplace_back(options);
        }
        line = std::make_unique<hermes::motorcontrol::LineMaster>(onLine);
        line->setOpen();
    }

    hermes::motorcontrol::MotorController &controller(int i) { return *controllers_[std::size_t(i)]; }
    hermes::simulator::RoboClawEmulator &emulator(int i) { return emulators_[std::size_t(i)]; }
    double now() const { return now_; }
    /// Counts/s of the fastest motor of all.
    double fastest() const {
        double most = 0;
        for (const auto &emulator : emulators_) {
            for (int motor : {0, 1})
                most = std::max(most, std::abs(emulator.channel(motor).speed()));
        }
        return most;
    }

    /// For so many seconds; the set-point of all motors is speed (counts/s).
    void run(double seconds) {
        for (const double end = now_ + seconds; now_ < end;)
            step();
    }
    /// Until it is so; false after limit seconds.
    bool runUntil(const std::function<bool()> &isSo, double limit = 10) {
        for (const double end = now_ + limit; now_ < end; step()) {
            if (isSo())
                return true;
        }
        return false;
    }
    /// With all motors, until they are fast.
    void driveOff() {
        QVERIFY2(runUntil([this] { return areReady(); }), qPrintable(controller(0).error()));
        speed = fast;
        QVERIFY(runUntil([this] { return fastest() > 0.95 * fast; }));
        sent.clear();
    }
    bool areReady() {
        return std::all_of(controllers_.begin(), controllers_.end(), [](auto &c) { return c->isReady(); });
    }

    hermes::motorcontrol::MotorSettings settings;
    std::unique_ptr<hermes::motorcontrol::LineMaster> line;
    qint32 speed = 0;
    /// Seconds by which each answer is late, as by an adapter that holds bytes.
    double latency = 0;
    /// False: the controller does not hear it.
    std::function<bool(const Packet &)> hears = [](const Packet &) { return true; };
    /// What arrives of an answer; nothing: it is lost.
    std::function<std::optional<Bytes>(const Packet &, const Bytes &)> passes =
        [](const Packet &, const Bytes &b) { return std::optional<Bytes>(b); };
    std::vector<Packet> sent;

private:
    static constexpr double period = 0.02, tick = 0.001; // seconds

    struct Late {
        double due;
        Bytes bytes;
    };

    void step() {
        now_ += tick;
        for (auto &emulator : emulators_)
            emulator.advance(tick, 24);
        if (now_ >= nextCycle_) {
            nextCycle_ += period;
            for (auto &controller : controllers_) {
                controller->beginCycle(now_);
                controller->command({speed, speed});
            }
        }
        while (!answers_.empty() && answers_.front().due <= now_) {
            const Bytes answer = answers_.front().bytes;
            answers_.pop_front();
            line->feed(answer.data(), answer.size(), now_);
        }
        while (const Bytes *packet = line->poll(now_))
            deliver(*packet);
    }
    void deliver(const Bytes &bytes) {
        const Packet packet{now_, bytes[0] - 0x80, bytes};
        sent.push_back(packet);
        const bool heard = hears(packet);
        for (std::size_t e = 0; e < emulators_.size(); ++e) {
            if (int(e) == packet.controller && !heard)
                continue;
            for (std::size_t i = 0; i < bytes.size(); ++i) {
                for (const auto &answer : emulators_[e].receive(bytes[i], now_)) {
                    if (const auto arrives = passes(packet, answer.bytes))
                        answers_.push_back({now_ + tick + latency + answer.delay, *arrives});
                }
            }
        }
    }

    std::vector<std::unique_ptr<hermes::motorcontrol::MotorController>> controllers_;
    std::vector<hermes::simulator::RoboClawEmulator> emulators_;
    double now_ = 1, nextCycle_ = 1;
    std::deque<Late> answers_;
};
