#pragma once

namespace hermes {

/// Lets the calling thread run before all ordinary ones (SCHED_FIFO, priority 1 to 99). False without the
/// privilege for it: CAP_SYS_NICE, or a limit RTPRIO.
bool becomeRealtime(int priority);

} // namespace hermes
