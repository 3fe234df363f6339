#pragma once

#include "daemons/motorcontrol/MotorController.h"

#include <vector>

namespace hermes::motorcontrol {

/// What goes over a line with one or more controllers on it, one request at a time. Each is made when the
/// line is free, so that no outdated set-point waits in a queue. Stops go before everything; else the
/// controllers have turns: in each round, a set-point and the encoders of each, and one slow reading or
/// request of a set-up. So however late answers come, each gets its share. Knows no clock and no line: the
/// caller gives the time (monotonic), writes what poll() gives and feeds what it reads.
class LineMaster {
public:
    /// The controllers must outlive it. The line is closed.
    explicit LineMaster(std::vector<MotorController *> controllers);

    void setOpen();
    void setClosed(const QString &reason);
    /// What is to be written now, or nullptr. Call it after feed(), at deadline(), and when a controller
    /// wants something.
    const drive::Bytes *poll(double now);
    void feed(const std::uint8_t *data, std::size_t size, double now);
    /// When poll() has to be called at the latest; infinite when nothing is pending.
    double deadline() const;

    const drive::Bus::Counts &counts(const MotorController &controller) const {
        return bus_.counts(controller.address());
    }
    quint64 strayBytes() const { return bus_.strayBytes(); }

private:
    using Task = MotorController::Task;
    /// A controller, and which tasks it had a turn for in this round.
    struct Place {
        MotorController *controller;
        std::array<bool, MotorController::taskCount> served{};
        int failed = 0; ///< the task that was not answered last
    };

    /// The line is silent until a controller has stopped by itself.
    double silentUntil() const;
    /// Nothing is sent before; a line is quiet for a moment after each failure, too.
    double busyUntil() const;
    bool isAnyToStop() const;
    bool submitStop();
    void submitNext();
    bool submitInRound();
    bool submitToFailing();
    bool submit(std::size_t place, Task task, drive::Bus::Urgency urgency = drive::Bus::Urgency::Normal);
    void finished(std::size_t place, Task task, const drive::Bus::Outcome &outcome);
    void tellWhetherHeld(double now);

    std::vector<Place> places_;
    std::size_t first_ = 0; // whose turn it is to go first
    drive::Bus bus_;
    bool waitsPatiently_ = false;
    double now_ = 0;
};

} // namespace hermes::motorcontrol
