#pragma once

#include <QString>

namespace hermes::desktop {

/// "6.3 GiB", "512 B".
QString sizeText(double bytes);
/// "42 s", "3 min 20 s", "2 h 5 min".
QString durationText(double seconds);
/// Of an estimate: "under 1 min", "35 min", "2 h 5 min".
QString roughDurationText(double seconds);

} // namespace hermes::desktop
