#pragma once

#include "gui/hermesctl/Arguments.h"
#include "gui/hermesctl/Connection.h"

namespace hermes {

/// A command of hermesctl that speaks to one daemon: prints its result to stdout.
using DaemonCommand = Result<void> (*)(Client &client, const Arguments &arguments);

/// The daemons that answer at their default ports on a host, one a line: name, state, version, address.
Result<void> listDaemons(const Arguments &arguments);

Result<void> discover(Client &client, const Arguments &arguments);
Result<void> call(Client &client, const Arguments &arguments);
Result<void> getSettings(Client &client, const Arguments &arguments);
Result<void> setSettings(Client &client, const Arguments &arguments);
Result<void> showLog(Client &client, const Arguments &arguments);
Result<void> document(Client &client, const Arguments &arguments);
/// Prints a topic until the count is reached, as one JSON object a line or as CSV.
Result<void> watch(Client &client, const Arguments &arguments);

/// Prints a line to stdout at once.
void printLine(const QString &text);

} // namespace hermes
