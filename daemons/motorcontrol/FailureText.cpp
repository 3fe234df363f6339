#include "daemons/motorcontrol/FailureText.h"

namespace hermes::motorcontrol {

using roboclaw::Bus;
using roboclaw::Command;

namespace {

QString nameOf(Command command) {
    switch (command) {
    case Command::SpeedAccel:
        return "40 (speeds)";
    case Command::Duty:
        return "34 (duties)";
    case Command::SetSerialTimeout:
        return "14 (set serial time-out)";
    case Command::ReadSerialTimeout:
        return "15 (serial time-out)";
    case Command::ReadEncoders:
        return "78 (encoders)";
    case Command::ReadVersion:
        return "21 (version)";
    case Command::ReadStatus:
        return "90 (status)";
    case Command::ReadCurrents:
        return "49 (currents)";
    case Command::ReadPwm:
        return "48 (duties)";
    case Command::ReadMainBattery:
        return "24 (main battery)";
    case Command::ReadLogicBattery:
        return "25 (logic battery)";
    case Command::ReadTemperature:
        return "82 (temperature)";
    default:
        return QString("%1 (velocity PID)").arg(int(command));
    }
}

} // namespace

QString failureText(Command command, Bus::Result result, bool heard) {
    switch (result) {
    case Bus::Result::BadCrc:
        return "answers with a wrong checksum";
    case Bus::Result::Unexpected:
        return QString("answers command %1 with something unexpected").arg(nameOf(command));
    case Bus::Result::LineClosed:
        return "has no line";
    default:
        break;
    }
    if (!heard)
        return "does not answer";
    const QString text = QString("answers, but not command %1").arg(nameOf(command));
    return command == Command::SetSerialTimeout
               ? text + ": its firmware may be older than that command, and it would not stop by itself"
               : text;
}

} // namespace hermes::motorcontrol
