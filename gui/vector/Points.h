#pragma once

#include "vectorlib/geometry/Vector2D.h"

#include <string>
#include <vector>

namespace hermes::vector {

/// The points of a CSV or (by extension .pcd) PCD file in their order; metres. Throws Failure.
std::vector<vectorlib::Vector2D<double>> loadPoints(const std::string &path);

} // namespace hermes::vector
