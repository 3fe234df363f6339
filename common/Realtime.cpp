#include "common/Realtime.h"

#include <pthread.h>

namespace hermes {

bool becomeRealtime(int priority) {
    sched_param parameter{};
    parameter.sched_priority = priority;
    return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameter) == 0;
}

} // namespace hermes
