#include "common/interface/AnySpeed.h"

#include <sys/ioctl.h>
#include <termios.h>

namespace hermes {
namespace {

/// The kernel's struct termios2. Its header cannot be included together with <termios.h>.
struct AnySpeed {
    tcflag_t inputFlags, outputFlags, control, local;
    cc_t line, characters[19];
    speed_t input, output;
};
const auto getAnySpeed = _IOR('T', 0x2A, AnySpeed), setAnySpeed = _IOW('T', 0x2B, AnySpeed);
constexpr tcflag_t anySpeed = 0x1000; // BOTHER

} // namespace

int speedOf(int file) {
    AnySpeed settings;
    return ::ioctl(file, getAnySpeed, &settings) == 0 ? int(settings.output) : 0;
}

bool setSpeed(int file, int baud) {
    AnySpeed settings;
    if (::ioctl(file, getAnySpeed, &settings) != 0)
        return false;
    settings.control = (settings.control & ~tcflag_t(CBAUD)) | anySpeed;
    settings.input = settings.output = speed_t(baud);
    return ::ioctl(file, setAnySpeed, &settings) == 0;
}

} // namespace hermes
