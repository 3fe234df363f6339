#include "gui/hermesctl/Import.h"

namespace hermes::ctl {

// Nothing writes MCAP there.
Result<void> importSession(Client &, const Arguments &) {
    return Error(ErrorCode::InvalidParams, "bags are imported on the computer where the recorder runs");
}

} // namespace hermes::ctl
