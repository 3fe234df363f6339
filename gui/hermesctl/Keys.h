#pragma once

#include "gui/hermesctl/Arguments.h"

namespace hermes::ctl {

/// Error: --role is none that a certificate can have.
Result<void> checkKeyRole(const Arguments &arguments);

/// How long a certificate is valid: --days, or the usual two years.
int daysOfKeys(const Arguments &arguments);

} // namespace hermes::ctl
