#pragma once

#include "ArduinoSettings.h"
#include "daemons/motorcontrol/DriveEngine.h"
#include "daemons/motorcontrol/LineMaster.h"

#include <deque>

/// The device's end of the line, from the text of its firmware: letters until CR, of which the last before
/// the blank counts; a missing argument is 0, what follows no number is left out.
class FakeArduino {
public:
    std::array<double, 2> counts{}, speeds{}; ///< counts; counts/s
    std::array<int, 2> perFrame{};            ///< as it was told
    bool latched = false;                     ///< it answers, and keeps its set-point
    bool showsCounts = true;                  ///< its encoders have a supply
    bool answersEmpty = true;                 ///< "Invalid Command" to a CR alone
    double sinceSetPoint = 10;

    /// It hears nothing for so long, and begins anew.
    void restart(double seconds) {
        dead_ = seconds;
        perFrame = {};
        text_.clear();
    }
    void advance(double seconds) {
        dead_ -= seconds;
        sinceSetPoint += seconds;
        if (sinceSetPoint >= 2)
            perFrame = {};
        for (std::size_t i = 0; i < 2; ++i) {
            const double target = 30.0 * perFrame[i], most = 8000 * seconds; // counts/s^2
            speeds[i] += std::clamp(target - speeds[i], -most, most);
            counts[i] = dead_ > 0 ? 0 : counts[i] + (showsCounts ? speeds[i] * seconds : 0);
        }
    }
    std::string receive(std::uint8_t byte) {
        if (dead_ > 0)
            return {};
        if (byte != '\r') {
            text_.push_back(char(byte));
            return {};
        }
        const std::string command = std::exchange(text_, {});
        const auto blank = command.find(' ');
        const char letter = command.empty() || blank == 0 ? 0 : command[std::min(blank, command.size()) - 1];
        if (letter == 'e')
            return std::to_string(std::int64_t(counts[0])) + ' ' + std::to_string(std::int64_t(counts[1])) +
                   "\r\n";
        if (letter != 'm')
            return answersEmpty || letter != 0 ? "Invalid Command\r\n" : "";
        int left = 0, right = 0;
        std::sscanf(command.c_str() + blank, " %d", &left);
        const auto second = command.find(' ', blank + 1);
        if (second != std::string::npos)
            std::sscanf(command.c_str() + second, " %d", &right);
        sinceSetPoint = 0;
        if (!latched)
            perFrame = {left, right};
        return "OK\r\n";
    }
    double fastest() const { return std::max(std::abs(speeds[0]), std::abs(speeds[1])); }

private:
    std::string text_;
    double dead_ = 0;
};

/// It and the engine that drives it, on a clock of their own.
class ArduinoBench {
public:
    struct Packet {
        double time;
        std::string text;
    };

    explicit ArduinoBench(
        const hermes::motorcontrol::MotorSettings &settings = *settingsOf(arduinoSettings()))
        : engine(settings)
        , line({&engine.controller(0)}) {
        line.setOpen();
    }

    void run(double seconds) {
        for (const double end = now + seconds; now < end;)
            step();
    }
    bool runUntil(const std::function<bool()> &isSo, double limit = 10) {
        for (const double end = now + limit; now < end; step()) {
            if (isSo())
                return true;
        }
        return false;
    }
    /// The program dies: the device alone goes on.
    void die(double seconds) {
        for (const double end = now + seconds; now < end; now += tick)
            arduino.advance(tick);
    }
    bool isReady() { return engine.controller(0).isReady(); }
    bool driveOff(double vx = 0.2) {
        if (!runUntil([this] { return isReady(); }))
            return false;
        run(0.02); // the next cycle
        if (!engine.drive().acquire(client, "test", 10, now))
            return false;
        speed = vx;
        return runUntil([&] { return arduino.fastest() > 0.9 * vx / 0.033 * 3000 / 6.2832; }, 2);
    }
    /// Without the ramp.
    void stop() {
        speed = 0;
        engine.drive().stop(client, "test");
        engine.obey();
    }
    static bool isStop(const Packet &packet) { return packet.text.find("m 0 0\r") != std::string::npos; }

    static constexpr double tick = 0.001;
    static constexpr quint64 client = 1;
    double now = 1, speed = 0;
    FakeArduino arduino;
    hermes::motorcontrol::DriveEngine engine;
    hermes::motorcontrol::LineMaster line;
    std::vector<Packet> sent;
    /// What arrives of what is sent, and of what is answered.
    std::function<std::string(const std::string &)> hears = [](const std::string &text) { return text; },
                                                    passes = [](const std::string &text) { return text; };

private:
    void step() {
        now += tick;
        arduino.advance(tick);
        if (now >= nextCycle_) {
            nextCycle_ += 0.02;
            engine.cycle(now);
            if (engine.drive().lease().isHeldBy(client))
                engine.drive().driveTwist(client, {speed, 0, 0}, 0, now);
            engine.obey();
        }
        while (!answers_.empty() && answers_.front().time <= now) {
            const std::string text = answers_.front().text;
            answers_.pop_front();
            line.feed(reinterpret_cast<const std::uint8_t *>(text.data()), text.size(), now);
        }
        while (const hermes::drive::Bytes *packet = line.poll(now)) {
            sent.push_back(
                {now, std::string(reinterpret_cast<const char *>(packet->data()), packet->size())});
            for (const char letter : hears(sent.back().text)) {
                const std::string answer = passes(arduino.receive(std::uint8_t(letter)));
                if (!answer.empty())
                    answers_.push_back({now + 0.004, answer});
            }
        }
    }

    double nextCycle_ = 1;
    std::deque<Packet> answers_;
};
