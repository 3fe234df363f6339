#include "gui/desktop/drive/GamepadCalibration.h"

#include <QCoreApplication>
#include <algorithm>
#include <cmath>

namespace hermes::desktop {
namespace {

constexpr double leastPlay = 0.05, maxPlay = 0.3, playOverNoise = 3;
constexpr int numbersOfAxis = 4;

QString nameOf(std::size_t axis) {
    const char *const names[]{QT_TRANSLATE_NOOP("Gamepad", "left stick, to the side"),
                              QT_TRANSLATE_NOOP("Gamepad", "left stick, ahead and back"),
                              QT_TRANSLATE_NOOP("Gamepad", "right stick, to the side")};
    return QCoreApplication::translate("Gamepad", names[axis]);
}

Error failure(const char *text, std::size_t axis) {
    return {ErrorCode::InvalidParams, QCoreApplication::translate("Gamepad", text).arg(nameOf(axis))};
}

std::pair<double, double> rangeOf(const std::vector<GamepadSticks> &sticks, std::size_t axis) {
    const auto [least, most] =
        std::minmax_element(sticks.begin(), sticks.end(),
                            [axis](const auto &one, const auto &other) { return one[axis] < other[axis]; });
    return {(*least)[axis], (*most)[axis]};
}

} // namespace

bool GamepadCalibration::Axis::isPossible() const {
    return std::abs(middle) < 1 && play >= 0 && play <= maxPlay && least >= -1 && most <= 1 &&
           middle - least > play + 0.1 && most - middle > play + 0.1;
}

GamepadSticks GamepadCalibration::apply(const GamepadSticks &raw) const {
    GamepadSticks sticks{};
    for (std::size_t i = 0; i < gamepadAxes; ++i) {
        const Axis &axis = axes_[i];
        const double off = raw[i] - axis.middle;
        const double all = off < 0 ? axis.middle - axis.least : axis.most - axis.middle;
        if (std::abs(off) > axis.play)
            sticks[i] = std::copysign(std::min(1.0, (std::abs(off) - axis.play) / (all - axis.play)), off);
    }
    return sticks;
}

Result<GamepadCalibration> GamepadCalibration::of(const std::vector<GamepadSticks> &resting,
                                                  const std::vector<GamepadSticks> &moving) {
    GamepadCalibration made;
    for (std::size_t i = 0; i < gamepadAxes; ++i) {
        if (resting.empty() || moving.empty())
            return failure(QT_TRANSLATE_NOOP("Gamepad", "%1: nothing was measured"), i);
        Axis &axis = made.axes_[i];
        const auto [restLeast, restMost] = rangeOf(resting, i);
        axis.middle = (restLeast + restMost) / 2;
        axis.play = std::max(leastPlay, playOverNoise * (restMost - restLeast) / 2);
        if (axis.play > maxPlay)
            return failure(QT_TRANSLATE_NOOP("Gamepad", "%1: it moved while it was to rest"), i);
        std::tie(axis.least, axis.most) = rangeOf(moving, i);
        if (axis.middle - axis.least < leastRange || axis.most - axis.middle < leastRange ||
            !axis.isPossible())
            return failure(QT_TRANSLATE_NOOP("Gamepad", "%1: it was not moved all the way to both sides"), i);
    }
    return made;
}

QVariantList GamepadCalibration::toList() const {
    QVariantList list;
    for (const Axis &axis : axes_)
        list << axis.middle << axis.least << axis.most << axis.play;
    return list;
}

GamepadCalibration GamepadCalibration::fromList(const QVariantList &list) {
    GamepadCalibration read;
    if (list.size() != int(gamepadAxes) * numbersOfAxis)
        return {};
    for (std::size_t i = 0; i < gamepadAxes; ++i) {
        const auto number = [&](int which) { return list[int(i) * numbersOfAxis + which].toDouble(); };
        read.axes_[i].middle = number(0);
        read.axes_[i].least = number(1);
        read.axes_[i].most = number(2);
        read.axes_[i].play = number(3);
        if (!read.axes_[i].isPossible())
            return {};
    }
    return read;
}

} // namespace hermes::desktop
