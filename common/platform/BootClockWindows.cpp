#include "common/platform/BootClock.h"

#include <windows.h>

namespace hermes {

double bootNow() {
    return 1e-3 * double(::GetTickCount64());
}

} // namespace hermes
