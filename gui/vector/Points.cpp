#include "gui/vector/Points.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "vectorlib/io/CsvPoints.h"
#include "vectorlib/io/Pcd.h"

namespace hermes::vector {

std::vector<vectorlib::Vector2D<double>> loadPoints(const std::string &path) {
    Input input(path);
    return valueOrFail(hasExtension(path, ".pcd")
                           ? vectorlib::readPcd<double>(input.stream(), input.name())
                           : vectorlib::readCsvPoints<double>(input.stream(), input.name()));
}

} // namespace hermes::vector
