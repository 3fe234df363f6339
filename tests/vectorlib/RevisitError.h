#pragma once

#include <vectorlib/geometry/Transformation2D.h>

#include <cstddef>

inline vectorlib::Transformation2D between(const vectorlib::Pose2D &from, const vectorlib::Pose2D &to) {
    return vectorlib::Transformation2D(from).inverse() * vectorlib::Transformation2D(to);
}
/// Of motions between places that were met again, those of each `step`-th pose; metres.
inline double revisitError(const std::vector<vectorlib::Pose2D> &drive,
                           const std::vector<vectorlib::Pose2D> &found, std::size_t step = 1) {
    double sum = 0;
    int pairs = 0;
    for (std::size_t k = 0; k < drive.size(); k += step)
        for (std::size_t i = 0; i + 100 < k; ++i)
            if (std::hypot(drive[i].x - drive[k].x, drive[i].y - drive[k].y) < 2) {
                sum += (between(drive[i], drive[k]).inverse() * between(found[i], found[k]))
                           .translation()
                           .norm();
                ++pairs;
            }
    return pairs > 0 ? sum / pairs : 1e9;
}
