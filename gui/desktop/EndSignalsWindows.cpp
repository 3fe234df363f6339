#include "gui/desktop/EndSignals.h"

namespace hermes::desktop {

EndSignals::EndSignals() = default;

EndSignals::~EndSignals() = default;

} // namespace hermes::desktop
