#pragma once

#include "daemons/seriallogger/FixEpoch.h"

#include <QJsonObject>

namespace hermes {

/// The data of the topic fix, but for the port; what the receiver does not know is null. Degrees, metres,
/// metres a second.
QJsonObject toJson(const Fix &fix);

} // namespace hermes
