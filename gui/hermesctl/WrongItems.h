#pragma once

#include "gui/session/SessionMember.h"

#include <QJsonArray>

namespace hermes::ctl {

/// The health items that are not ok, of what daemon.status gave: name, level and message of each.
QJsonArray wrongItems(const SessionReply &status);

/// One of them for people: "error: port gps: ...".
QString wrongText(const QJsonValue &item);

} // namespace hermes::ctl
