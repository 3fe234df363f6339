#pragma once

#include "common/Result.h"
#include "common/interface/PtyInterface.h"

namespace hermes::simulator {

/// A simulated device's serial line: the link under which programs find it, if any, and the device.
struct LineState {
    QString link, device; ///< no device while it is pulled
};

/// The far end of a simulated device's serial line, open; link: where programs find it, none when empty.
/// Error names what cannot be made.
Result<std::shared_ptr<PtyInterface>> openDeviceLine(const QString &link);

} // namespace hermes::simulator
