#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/correspondence/Match.h"
#include "vectorlib/geometry/Transformation2D.h"

#include <algorithm>
#include <array>

namespace vectorlib {

/// How probable it is that a pose found in a map is right: within 10 cm and 2 degrees of where the map shows
/// the same. A logistic function of how the match came out. Constant time, allocates nothing.
struct PoseTrust {
    using Features = std::array<double, 6>;

    /// Of the features. Fitted to one half of tracked drives, of logs and drawn at random, by
    /// hermes-vector experiment pose-trust (docs/trust.md tells how well they do on the other).
    Features weights{-9.22, 4.48, -6.21, 0.617, -0.960, 3.57};

    /// What tells of a match whether its pose is right: a constant 1, how reliable it is, how far the paired
    /// edges lie apart for the most that they may (`finalDistance`, metres), the logarithm of their number,
    /// that of how far the pose is from where it was `expected` (metres, a radian counts half of one), and
    /// the share of the seen length that is in pairs.
    static Features features(const Match &match, const Transformation2D &expected, double finalDistance);
    /// The probability for these features, in [0, 1]; 0 where one of them is no number.
    double operator()(const Features &f) const;

private:
    static double within(double share) { return std::clamp(share, 0.0, 1.0); }
};

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/mapping/PoseTrust.cpp")
