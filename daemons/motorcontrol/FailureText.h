#pragma once

#include "protocol/roboclaw/Bus.h"

#include <QString>

namespace hermes::motorcontrol {

/// How a controller fails to answer a command, for people: "answers, but not command 78 (encoders)".
/// heard: it has answered others.
QString failureText(roboclaw::Command command, roboclaw::Bus::Result result, bool heard);

} // namespace hermes::motorcontrol
