#pragma once

namespace hermes {

/// Lets others of this computer go before the calling thread.
void lowerThreadPriority();

} // namespace hermes
