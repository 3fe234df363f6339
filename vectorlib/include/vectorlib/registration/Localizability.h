#pragma once

#include "vectorlib/geometry/Transformation2D.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/registration/WallDirections.h"

#include <algorithm>

namespace vectorlib {

/// How well walls fix the position of a sensor whose heading is free, too. Walls that bend about one centre
/// face in many directions, and yet leave a way open: the sensor goes on about the centre and turns by as
/// much, and sees the same. Of two scans, each of which tells the normal at a place: a product of both is
/// right on average, where the square of one would count its noise as a wall.
class Localizability {
public:
    /// A place on a wall (metres, in the frame of the sensor or of one nearby), with its normal as each of
    /// two scans tells it, of unit length or zero.
    void add(Vector2D<float> place, Vector2D<float> a, Vector2D<float> b) {
        if (a.dot(b) < sameWay)
            return;
        const float leverA = place.cross(a), leverB = place.cross(b);
        xx_ += double(a.x * b.x);
        xy_ += double(a.x * b.y + a.y * b.x) / 2;
        yy_ += double(a.y * b.y);
        xt_ += double(a.x * leverB + b.x * leverA) / 2;
        yt_ += double(a.y * leverB + b.y * leverA) / 2;
        tt_ += double(leverA * leverB);
    }
    /// What is told of the position, at any heading.
    WallDirections position() const {
        const double inverse = tt_ > 0 ? 1 / tt_ : 0;
        return WallDirections(xx_ - xt_ * xt_ * inverse, xy_ - xt_ * yt_ * inverse,
                              yy_ - yt_ * yt_ * inverse);
    }
    /// How much of what the walls tell of that position's weakest direction counts, in [0, 1].
    double kept() const {
        const WallDirections walls(xx_, xy_, yy_);
        const double share = walls.weakestShare();
        if (share < leastShare || walls.weight() < leastPoints)
            return 1;
        const double left = position().weakestShare();
        const auto between = [](double value, double none, double all) {
            return (value - none) / (all - none);
        };
        return std::clamp(
            std::max(between(left, unknownShare, knownShare), between(left / share, bent, straight)), 0.0,
            1.0);
    }
    /// The pose that the walls tell, but for the way that they leave open: there the expected one stands.
    Transformation2D leaveOpen(const Transformation2D &told, const Transformation2D &expected) const {
        const double left = 1 - kept();
        if (!(left > 0) || !(tt_ > 0))
            return told;
        const Vector2D<double> along = position().weakest();
        const double turn = -(xt_ * along.x + yt_ * along.y) / tt_; // radians a metre
        const Transformation2D off = expected.inverse() * told;
        const double slid = left * along.dot(off.translation());
        return expected * Transformation2D(off.x() - slid * along.x, off.y() - slid * along.y,
                                           off.alpha() - slid * turn);
    }

private:
    // Share of the walls that face a direction: with less it is open whatever the heading.
    static constexpr double leastShare = 0.03;
    static constexpr double leastPoints = 80; // fewer tell no bend from noise
    // The same where the heading is free: between bent walls, and in rooms.
    static constexpr double unknownShare = 0.02, knownShare = 0.06;
    // What is left then of the share: between bent walls, and between straight ones.
    static constexpr double bent = 0.2, straight = 0.5;
    static constexpr float sameWay = 0.7f; // cosine of the most between two normals of one wall

    double xx_ = 0, xy_ = 0, yy_ = 0, xt_ = 0, yt_ = 0, tt_ = 0;
};

} // namespace vectorlib
