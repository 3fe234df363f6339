#pragma once

#include "daemons/simulator/ArduinoEmulator.h"
#include "daemons/simulator/OpenCrEmulator.h"
#include "daemons/simulator/RoboClawEmulator.h"
#include "daemons/simulator/RoboteqEmulator.h"
#include "daemons/simulator/VescEmulator.h"

#include <memory>

namespace hermes::simulator {

/// What turns the wheels of a robot, and what each kind of it can be.
struct MotorOptions {
    std::string kind = "roboclaw"; ///< the name of one of motorKinds()
    std::array<RoboClawEmulator::Options, 2> controller = twoAddresses();
    ArduinoEmulator::Options arduino;
    VescEmulator::Options vesc;
    OpenCrEmulator::Options openCr;
    RoboteqEmulator::Options roboteq;

private:
    static std::array<RoboClawEmulator::Options, 2> twoAddresses() {
        std::array<RoboClawEmulator::Options, 2> options;
        options[1].address = std::uint8_t(options[0].address + 1);
        return options;
    }
};

/// A kind of motor controllers, each with two motors.
struct MotorKind {
    const char *name;                 ///< in the setting motors.kind
    const char *title;                ///< for people, with its article
    int controllers;                  ///< two turn a wheel with each motor, one turns both wheels of a side
    int baud;                         ///< of its line; at another one all bytes are garbage; 0: any will do
    bool checksums;                   ///< without, damaged bytes may be another command or another number
    std::vector<const char *> faults; ///< of a controller, as sim.fault has them
    std::unique_ptr<MotorEmulator> (*make)(const MotorOptions &options, std::size_t number);
};

const std::vector<MotorKind> &motorKinds();
/// That of this name, or else the first.
const MotorKind &motorKind(const std::string &name);

} // namespace hermes::simulator
