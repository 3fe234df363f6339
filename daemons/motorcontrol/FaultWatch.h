#pragma once

#include "daemons/motorcontrol/Drive.h"
#include "daemons/motorcontrol/MotorSettings.h"
#include "daemons/motorcontrol/Telemetry.h"

namespace hermes::motorcontrol {

/// Judges what the controllers measure and how the wheels obey; what is wrong latches in the drive.
class FaultWatch {
public:
    void configure(const MotorSettings &settings);

    /// Battery, currents, temperature and status bits of the controllers that have told all of them. Once a
    /// cycle; levels are for people.
    void judgeControllers(Telemetry &telemetry, Drive &drive, double now);
    /// setPoint: what the wheels were told when these speeds were measured; duties: of their motors, 0 where
    /// they are not known. Gives what each wheel does that does not obey; empty for those that do.
    std::array<QString, wheelCount> judgeWheels(const WheelValues &setPoint, const WheelValues &speeds,
                                                const WheelValues &duties, Drive &drive, double now);
    /// The wheels were not watched for a while.
    void skipWheels();
    /// Somebody has released the faults.
    void forgetWheels();

private:
    struct Controller {
        Threshold battery{Threshold::Side::Below};
        std::array<Threshold, 2> current{Threshold(Threshold::Side::Above),
                                         Threshold(Threshold::Side::Above)};
        Threshold temperature{Threshold::Side::Above};
    };

    std::array<Controller, controllerCount> controllers_;
    std::array<EncoderMonitor, wheelCount> encoders_;
};

} // namespace hermes::motorcontrol
