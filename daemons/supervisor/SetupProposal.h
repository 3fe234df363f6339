#pragma once

#include "protocol/messages/Setup.h"

namespace hermes::supervisor {

/// What the settings of the daemons should be with what was found. base: the settings by daemons that they
/// change; folder: of the settings files. A part of a robot that was not found changes nothing, and a note
/// says so.
Proposal propose(const Findings &findings, const QJsonObject &base, const QString &folder);

} // namespace hermes::supervisor
