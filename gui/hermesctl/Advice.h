#pragma once

#include "gui/hermesctl/Commands.h"

namespace hermes::ctl {

/// What a person can do about a failure, a line each: which program to start, which name is near, what is
/// expected, who holds the control. May ask the daemon; gives nothing where nothing is known.
QStringList adviceFor(const Error &error, Client &client, const Arguments &arguments);

/// The same where no daemon was asked.
QStringList adviceFor(const Error &error, const Arguments &arguments);

} // namespace hermes::ctl
