#include "gui/desktop/view/MapColours.h"
#include "gui/desktop/Theme.h"

namespace hermes::desktop {
namespace {
std::array<QColor, 5> coloursOf(const std::array<QRgb, 5> &all) {
    return {all[0], all[1], all[2], all[3], all[4]};
}
} // namespace

MapColours mapColours() {
    const bool isDark = theme::isDark();
    const auto either = [isDark](QRgb light, QRgb dark) { return QColor(isDark ? dark : light); };
    MapColours colours;
    colours.background = either(0xfcfcfb, 0x171a1c);
    colours.grid = either(0xe9eae8, 0x2a2f33);
    colours.axis = either(0xc9ccc9, 0x454c52);
    colours.map = either(0x24292e, 0xd5dade);
    colours.accent = either(0x007dc5, 0x4dc4ff);
    colours.scan = either(0xb85c00, 0xc98a2b);
    colours.correspondence = either(0x86a88c, 0x6d8b74);
    colours.path = either(0x0b63c4, 0x5aa9ff);
    colours.odometry = either(0x8a4fbf, 0xb88ce0);
    colours.truth = either(0x6a7178, 0x8f989f);
    colours.robot = either(0xd95300, 0xff8a3d);
    colours.text = either(0x3b4147, 0xc3c9ce);
    colours.loop = either(0x7d6f00, 0xf0e442);
    colours.trust = coloursOf(isDark ? std::array<QRgb, 5>{0xff7a1a, 0xf2b16e, 0xd8d4c8, 0x85b4e0, 0x358ce8}
                                     : std::array<QRgb, 5>{0xc44e00, 0xe08e4c, 0xa8a498, 0x5b93c9, 0x0a4fa0});
    return colours;
}

std::array<QColor, 5> cloudColours() {
    return coloursOf(theme::isDark() ? std::array<QRgb, 5>{0x4f6fe8, 0x27a9d6, 0x3fd08c, 0xd9d53a, 0xff8a3d}
                                     : std::array<QRgb, 5>{0x2a2aa8, 0x0a74b0, 0x008a5e, 0xb08a00, 0xc43c00});
}
} // namespace hermes::desktop
