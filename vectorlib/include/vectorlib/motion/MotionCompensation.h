#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Twist2D.h"
#include "vectorlib/geometry/Vector2D.h"

#include <vector>

namespace vectorlib {

/// The middle between the first and the last of the points' times; 0 without any. The best time to refer a
/// scan to: a wrong velocity then bends the scan without shifting it, while at its beginning the shift would
/// come back as a wrong velocity of the next scan, and grow.
float middleTime(const std::vector<float> &seconds);

/// Moves points measured while the sensor moved to where they would have been seen from its place at time
/// `reference`. `seconds` holds the time of each point; both of the same size, or no times for a scan
/// measured at once.
void compensateMotion(std::vector<Vector2D<float>> &points, const std::vector<float> &seconds,
                      float reference, const Twist2D &twist);

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/motion/MotionCompensation.cpp")
