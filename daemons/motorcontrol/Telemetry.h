#pragma once

#include "daemons/motorcontrol/CycleTimer.h"
#include "daemons/motorcontrol/Drive.h"
#include "daemons/motorcontrol/MotorController.h"

namespace hermes::motorcontrol {

/// What the drive loop tells about one cycle. Stamps are seconds since the epoch. To copy it allocates
/// nothing.
struct Telemetry {
    struct Controller {
        QString name, error, version, interface;
        QString advice; ///< what a person should do about its line; empty when nothing
        bool ready = false;
        bool mayTurn = false;            ///< MotorController::mayTurn()
        bool stands = false;             ///< has confirmed it: MotorController::stands()
        std::optional<double> timeout_s; ///< after which it stops by itself; nothing: it never does
        bool coasts = false;             ///< then its wheels roll
        double rate_Hz = 0;              ///< of readings; 0: not known
        drive::Readings readings;
        drive::Bus::Counts counts;
        quint64 strayBytes = 0; ///< on its line: they came when none was awaited
        quint64 overruns = 0;
    };

    /// Those that the robot has; they need no heap.
    struct Controllers : std::array<Controller, controllerCount> {
        std::size_t count = 2;
        std::size_t size() const { return count; }
        iterator end() { return begin() + count; }
        const_iterator end() const { return begin() + count; }
    };

    double stamp = 0, mono = 0; ///< of the readings behind pose and speeds
    bool moved = false;         ///< whether there are new readings in this cycle
    Pose2D pose;
    Twist2D twist;
    Odometry::Covariance covariance{};
    WheelValues target{}, setPoint{}, speeds{}, turns{}; ///< rad/s; turns: rad since the start
    double targetSteering = 0, steering = 0;             ///< rad, to the left, of a steered axle
    double slip = 0;                                     ///< m/s
    quint64 counterJumps = 0;                            ///< motions that were no motions and were left out
    Controllers controllers;
    CycleStatistics cycle;
    bool realtime = false; ///< the cycle goes before all ordinary threads
    QString unopened;      ///< why nothing is driven before the next start; empty when it is
    QString haltCause, haltReason;
    StopLatch latch;
    ControlLease lease;
    quint64 unread = 0;                       ///< reports that the rest of the daemon was too slow to take
    std::array<Threshold::Level, 3> levels{}; ///< battery, current, temperature: the worst
};

} // namespace hermes::motorcontrol
