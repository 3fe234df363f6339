#pragma once

#include "vectorlib/registration/PointAgreement.h"
#include "vectorlib/registration/ScanSurface.h"

namespace vectorlib {

/// How much of the surfaces of two scans lies on each other, as lengths: a stretch of wall counts the same
/// whether it was seen by many points from nearby or by few from afar.
class SurfaceAgreement {
public:
    /// A scan's points and the lengths that they stand for.
    struct Scan {
        const ScanIndex &points;
        const ScanSurface &surface;
    };

    SurfaceAgreement() = default;
    /// Judges every n-th point of both scans when the moving one lies at the pose. A point `deviation` metres
    /// from the other scan's wall, along the normal, is explained to two thirds of its length.
    SurfaceAgreement(Scan fixed, Scan moving, const Transformation2D &pose, double deviation, int sample) {
        add(fixed, pose.inverse(), moving.points, deviation, sample);
        turnDirections(pose);
        add(moving, pose, fixed.points, deviation, sample);
    }
    /// Of all that was judged; metres.
    double length() const { return length_; }
    /// Share that has something of the other scan beside it.
    double explained() const { return length_ > 0 ? explained_ / length_ : 0; }
    /// Share at whose place the other scan saw through.
    double contradicted() const { return length_ > 0 ? contradicted_ / length_ : 0; }
    /// In [-1, 1]; 1 is perfect: explained less contradicted length, as a share of both and of half of what
    /// is out of the other scan's sight.
    double score() const { return balance(0.5); }
    /// The same with little weight, 0.15, on what is out of sight: the other scan says nothing of it. Two
    /// motions that fit alike what both scans could see are about equal, unless one hardly overlaps.
    double consistency() const { return balance(0.15); }
    /// In [0, 1], of the directions of what is explained as that of lines (paper (28)): small along a
    /// corridor.
    double reliability() const {
        const double sum = xx_ + yy_;
        return sum > 0 ? 2 * std::sqrt(std::max(0.0, xx_ * yy_ - xy_ * xy_)) / sum : 0;
    }
    /// The direction in which the scans slide on each other most easily; fixed frame, unit length.
    Vector2D<double> openDirection() const {
        const double angle = 0.5 * std::atan2(2 * xy_, xx_ - yy_) + pi / 2;
        return {std::cos(angle), std::sin(angle)};
    }

private:
    // What is out of sight weighs `hidden` of its length.
    double balance(double hidden) const {
        const double judged = explained_ + contradicted_, all = judged + hidden * (length_ - judged);
        return all > 0 ? (explained_ - contradicted_) / all : 0;
    }
    void add(Scan scan, const Transformation2D &motion, const ScanIndex &other, double deviation,
             int sample) {
        constexpr float gate = 0.3f, beside = 0.2f, sameWay = 0.7f; // metres, metres, cosine
        const FloatMotion move(motion);
        const float inverse = static_cast<float>(1 / (4 * deviation * deviation));
        for (int i = 0; i < scan.points.size(); i += sample) {
            const Vector2D<float> p = move * scan.points.point(i), own = move.rotate(scan.points.normal(i));
            const float length = scan.surface.lengthOf(i);
            length_ += length;
            if (const int k = other.nearestAhead(p, gate * gate); k >= 0) {
                const Vector2D<float> n = other.normal(k), off = p - other.point(k);
                const bool alone = n.squaredNorm() * own.squaredNorm() < 0.5f; // without a normal
                if (alone || n.dot(own) > sameWay) {
                    const float across = n.dot(off), square = off.squaredNorm();
                    const float q = 1 / (1 + (alone ? square : across * across) * inverse);
                    const float part = length * q * q * (square > beside * beside ? 0.5f : 1.0f);
                    explained_ += part;
                    xx_ += part * n.x * n.x;
                    xy_ += part * n.x * n.y;
                    yy_ += part * n.y * n.y;
                    continue;
                }
            }
            if (other.looksPast(p))
                contradicted_ += length;
        }
    }
    // The sums over the normals, from the moving frame to the fixed one.
    void turnDirections(const Transformation2D &pose) {
        const double c = pose.cos(), s = pose.sin(), xx = xx_, xy = xy_, yy = yy_;
        xx_ = c * c * xx - 2 * c * s * xy + s * s * yy;
        yy_ = s * s * xx + 2 * c * s * xy + c * c * yy;
        xy_ = c * s * (xx - yy) + (c * c - s * s) * xy;
    }

    double length_ = 0, explained_ = 0, contradicted_ = 0;
    double xx_ = 0, xy_ = 0, yy_ = 0; // sums over the normals
};

} // namespace vectorlib
