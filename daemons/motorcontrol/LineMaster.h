#pragma once

#include "daemons/motorcontrol/MotorController.h"

#include <vector>

namespace hermes {

/// What goes over a line with one or more controllers on it, one request at a time, the most urgent one
/// first: each is made when the line is free, so that no outdated set-point waits in a queue. Knows no clock
/// and no line: the caller gives the time (monotonic), writes what poll() gives and feeds what it reads.
class LineMaster {
public:
    /// The controllers must outlive it. The line is closed.
    explicit LineMaster(std::vector<MotorController *> controllers);

    void setOpen();
    void setClosed(const QString &reason);
    /// What is to be written now, or nullptr. Call it after feed(), at deadline(), and when a controller
    /// wants something.
    const roboclaw::Bytes *poll(double now);
    void feed(const std::uint8_t *data, std::size_t size, double now);
    /// When poll() has to be called at the latest; infinite when nothing is pending.
    double deadline() const { return bus_.deadline(); }

    const roboclaw::Bus::Counts &counts(const MotorController &controller) const {
        return bus_.counts(controller.address());
    }
    quint64 strayBytes() const { return bus_.strayBytes(); }

private:
    void submitNext();
    bool submit(MotorController &controller, MotorController::Task task);

    std::vector<MotorController *> controllers_;
    roboclaw::Bus bus_;
    double now_ = 0;
};

} // namespace hermes
