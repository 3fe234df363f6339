#pragma once

#include "protocol/drive/Bus.h"
#include "protocol/drive/MotorDevice.h"

#include <QString>

namespace hermes::motorcontrol {

/// How a controller fails to answer a command, for people: "answers, but not command 78 (encoders)".
/// heard: it has answered others.
QString failureText(const drive::MotorDevice::Name &name, drive::Bus::Result result, bool heard);

} // namespace hermes::motorcontrol
