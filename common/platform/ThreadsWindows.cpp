#include "common/platform/Threads.h"

#include <windows.h>

namespace hermes {

void lowerThreadPriority() {
    ::SetThreadPriority(::GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL);
}

} // namespace hermes
