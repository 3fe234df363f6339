#pragma once

#include "daemons/motorcontrol/DriveEngine.h"
#include "daemons/motorcontrol/LineMaster.h"
#include "daemons/simulator/Drivetrain.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace campaign {

/// The motor control without its thread on a clock of its own, with one line or two to emulated controllers,
/// of 115,200 baud where they do not demand another speed.
class VirtualRobot {
public:
    /// Called after each step of at most a millisecond.
    using Watch = std::function<void()>;

    VirtualRobot(const hermes::motorcontrol::MotorSettings &settings,
                 const hermes::simulator::Drivetrain::Options &options)
        : robot(options)
        , kind(hermes::simulator::motorKind(options.kind))
        , ownLines_(options.ownLines)
        , byteTime_(10.0 / (kind.baud > 0 ? kind.baud : 115200)) {
        restart(settings, std::nullopt);
    }

    /// As another process, which knows nothing of before but the emergency stop.
    void restart(const hermes::motorcontrol::MotorSettings &settings, const std::optional<QString> &stop) {
        std::vector<bool> pulled;
        for (const Line &line : lines_)
            pulled.push_back(line.pulled);
        lines_.clear();
        engine.emplace(settings);
        std::vector<hermes::motorcontrol::MotorController *> all;
        for (int i = 0; i < engine->controllers(); ++i) {
            all.push_back(&engine->controller(i));
            if (ownLines_)
                lines_.emplace_back(std::vector{all.back()});
        }
        if (!ownLines_)
            lines_.emplace_back(all);
        for (std::size_t i = 0; i < lines_.size(); ++i)
            setPulled(int(i), i < pulled.size() && pulled[i]);
        if (stop)
            engine->drive().restoreStop(*stop, now_);
        nextCycle_ = now_;
    }

    double now() const { return now_; }
    int lineOf(int controller) const { return lines_.size() > 1 ? controller : 0; }
    int lines() const { return int(lines_.size()); }

    /// From event to event.
    void run(double until, const Watch &watch) {
        while (now_ < until) {
            const double next = std::min(until, nextEvent());
            pass(next, watch);
            if (now_ >= nextCycle_) {
                nextCycle_ += period;
                engine->cycle(now_);
            }
            exchange();
        }
    }
    /// The process stands still, the robot does not. What came meanwhile is there when it goes on.
    void stall(double until, const Watch &watch) {
        pass(until, watch);
        nextCycle_ = now_;
    }
    /// After a command, as the drive loop does it.
    void obey() {
        engine->obey();
        exchange();
    }
    /// The host finds a line again a quarter of a second after it came back, at the latest.
    void setPulled(int line, bool pulled) {
        Line &l = lines_[std::size_t(line)];
        l.answers.clear();
        l.pulled = pulled;
        if (pulled)
            l.master.setClosed("the line is gone");
        else
            l.master.setOpen();
    }
    bool isPulled(int line) const { return lines_[std::size_t(line)].pulled; }

    std::optional<hermes::motorcontrol::DriveEngine> engine;
    hermes::simulator::Drivetrain robot;
    vectorlib::Pose2D truth; ///< of the body, which nothing is in the way of
    const hermes::simulator::MotorKind &kind;

private:
    static constexpr double period = 0.02, longestStep = 0.001; // seconds

    struct Late {
        double due;
        hermes::roboclaw::Bytes bytes;
    };
    struct Line {
        explicit Line(const std::vector<hermes::motorcontrol::MotorController *> &controllers)
            : master(controllers) {}
        hermes::motorcontrol::LineMaster master;
        std::vector<Late> answers;
        bool pulled = false;
    };

    double nextEvent() const {
        double next = nextCycle_;
        for (const Line &line : lines_) {
            if (line.pulled)
                continue;
            next = std::min(next, line.master.deadline());
            for (const Late &late : line.answers)
                next = std::min(next, late.due);
        }
        return std::max(now_ + 1e-6, next);
    }
    void pass(double until, const Watch &watch) {
        while (now_ < until) {
            const double step = std::min(longestStep, until - now_);
            truth = truth * robot.advance(step).motion(step);
            now_ = step < longestStep ? until : now_ + step;
            watch();
        }
    }
    void exchange() {
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            Line &line = lines_[i];
            if (line.pulled)
                continue;
            take(line);
            while (const hermes::roboclaw::Bytes *packet = line.master.poll(now_))
                deliver(int(i), *packet);
        }
    }
    void take(Line &line) {
        for (;;) {
            const auto first = std::min_element(line.answers.begin(), line.answers.end(),
                                                [](const Late &a, const Late &b) { return a.due < b.due; });
            if (first == line.answers.end() || first->due > now_)
                return;
            const hermes::roboclaw::Bytes bytes = first->bytes;
            line.answers.erase(first);
            line.master.feed(bytes.data(), bytes.size(), now_);
        }
    }
    void deliver(int number, const hermes::roboclaw::Bytes &packet) {
        const double arrived = now_ + byteTime_ * double(packet.size());
        double end = arrived;
        for (const auto &answer : robot.receive(number, packet.data(), packet.size(), arrived)) {
            end = std::max(end, arrived + answer.delay) + byteTime_ * double(answer.bytes.size());
            lines_[std::size_t(number)].answers.push_back({end, answer.bytes});
        }
    }

    const bool ownLines_;
    const double byteTime_; // seconds
    std::deque<Line> lines_;
    double now_ = 1, nextCycle_ = 1;
};

} // namespace campaign
