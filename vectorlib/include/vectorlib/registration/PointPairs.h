#pragma once

#include "vectorlib/registration/PointAgreement.h"

namespace vectorlib {

/// A point of one scan and the wall of the other on which it should lie.
struct PointPair {
    Vector2D<float> moving; ///< its own frame
    Vector2D<float> normal; ///< of the wall, fixed frame
    float offset;           ///< of the wall along the normal

    /// The distance of the moving scan's point from the wall along the normal; metres.
    float residual(Vector2D<float> turned, const FloatMotion &motion) const {
        return normal.dot(turned + motion.translation) - offset;
    }
};

/// Gives `each` the pairs of every n-th point of both scans when the moving one lies at the pose. `partner`
/// tells the number of the point of a scan that belongs to a point in that scan's frame, or -1. Most points
/// are paired twice, once as a point of either scan.
template <typename Partner, typename Each>
void forEachPair(const ScanIndex &fixed, const ScanIndex &moving, const Transformation2D &pose, int sample,
                 Partner partner, Each each) {
    const FloatMotion forth(pose), back(pose.inverse());
    for (int i = 0; i < moving.size(); i += sample)
        if (const int k = partner(fixed, forth * moving.point(i)); k >= 0)
            each(PointPair{moving.point(i), fixed.normal(k), fixed.normal(k).dot(fixed.point(k))});
    for (int i = 0; i < fixed.size(); i += sample)
        if (const int k = partner(moving, back * fixed.point(i)); k >= 0) {
            const Vector2D<float> normal = forth.rotate(moving.normal(k));
            each(PointPair{moving.point(k), normal, normal.dot(fixed.point(i))});
        }
}

} // namespace vectorlib
