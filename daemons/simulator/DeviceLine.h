#pragma once

#include "common/Result.h"
#include "common/interface/PtyInterface.h"

namespace hermes {

/// The far end of a simulated device's serial line, open; link: where programs find it, none when empty.
/// Error names what cannot be made.
Result<std::shared_ptr<PtyInterface>> openDeviceLine(const QString &link);

} // namespace hermes
