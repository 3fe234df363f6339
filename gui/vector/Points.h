#pragma once

#include "gui/vector/Input.h"
#include "vectorlib/geometry/Vector2D.h"

#include <string>
#include <vector>

namespace hermes::vector {

/// The points of a CSV or (by extension .pcd) PCD file in their order; metres. Throws Failure.
std::vector<vectorlib::Vector2D<double>> loadPoints(const std::string &path);

/// The whole text of a file of one scan that was opened as path. Throws Failure that says how to take a scan
/// out, when it is a CARMEN log or a capture.
std::string readScanText(Input &input, const std::string &path);

} // namespace hermes::vector
