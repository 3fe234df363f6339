#pragma once

#include "protocol/messages/Setup.h"

#include <chrono>

namespace hermes {

/// How long a command of the setup may take: processes end, lines are searched, daemons check their settings.
constexpr std::chrono::seconds setupTimeout{60};

/// What was found and what could not be searched, a row each: what it is, where, details. howToAsk: how
/// somebody has silent lines asked.
std::vector<QStringList> rowsOf(const Findings &found, const QString &howToAsk);

/// What these settings, by daemons, say; what holds now is not known here.
std::vector<SettingChange> changesOf(const QJsonObject &settings);

} // namespace hermes
