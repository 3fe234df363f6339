#pragma once

#include "common/Result.h"
#include "gui/desktop/drive/Gamepad.h"

#include <QVariantList>

namespace hermes::desktop {

/// Where the sticks of a gamepad rest and how far they go. Without a calibration they rest within 12 % of the
/// middle and go all the way.
class GamepadCalibration {
public:
    /// A stick that moves less was not moved all the way round.
    static constexpr double leastRange = 0.3;

    /// What the sticks say, made -1 to 1: 0 where they rest.
    GamepadSticks apply(const GamepadSticks &raw) const;

    /// From what the sticks said while nobody touched them, then while they were moved all the way round.
    /// Error: one moved while it was to rest, or was not moved.
    static Result<GamepadCalibration> of(const std::vector<GamepadSticks> &resting,
                                         const std::vector<GamepadSticks> &moving);

    QVariantList toList() const;
    /// The usual one where it is none.
    static GamepadCalibration fromList(const QVariantList &list);

private:
    struct Axis {
        double middle = 0, least = -1, most = 1;
        double play = 0.12; ///< around the middle, where it rests
        bool isPossible() const;
    };

    std::array<Axis, gamepadAxes> axes_;
};

} // namespace hermes::desktop
