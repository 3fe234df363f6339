#pragma once

#include "common/Result.h"

#include <QString>

namespace hermes {

/// Names may have 1 to 100 bytes of UTF-8, no '/', no control characters and no dot at the beginning
/// (InvalidParams otherwise). what: the parameter, for the message.
Result<void> checkName(const QString &what, const QString &name);

} // namespace hermes
