// GpioLines in a build without libgpiod.
#include "daemons/softwaretrigger/GpioLines.h"

namespace hermes::softwaretrigger {

bool GpioLines::isAvailable() {
    return false;
}

Result<void> GpioLines::set(const QString &chip, int offset, bool) {
    return Error(
        ErrorCode::DeviceFault,
        QString("GPIO chip %1, line %2: this program was built without libgpiod").arg(chip).arg(offset));
}

void GpioLines::close() {}

} // namespace hermes::softwaretrigger
