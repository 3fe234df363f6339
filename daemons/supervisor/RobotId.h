#pragma once

#include "common/Result.h"

#include <QJsonArray>
#include <QString>

namespace hermes::supervisor {

QString newRobotId();

/// The id of the robot of this account, made once and kept in its folder of state. listen: of the settings.
/// Who does not listen at the usual port has a file of its own, named by its port: several supervisors of an
/// account are several robots. With a port that the system chooses it is another robot each time. Error: the
/// id cannot be read, or a new one cannot be kept.
Result<QString> robotId(const QJsonArray &listen);

} // namespace hermes::supervisor
