#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/io/Csv.h"
#include "vectorlib/io/Number.h"

namespace vectorlib {

/// Points from CSV, `x,y` a line in metres, in the order of acquisition. A header may name further columns. A
/// point with a coordinate inf or nan is a ray without return and left out.
template <typename Scalar = float>
Expected<std::vector<Vector2D<Scalar>>> readCsvPoints(std::istream &in, std::string name) {
    CsvReader csv(in, std::move(name), {{"x", "y"}, {}, true});
    std::vector<Vector2D<Scalar>> points;
    while (const auto *row = csv.next()) {
        if (!std::isfinite((*row)[0]) || !std::isfinite((*row)[1]))
            continue;
        points.emplace_back(static_cast<Scalar>((*row)[0]), static_cast<Scalar>((*row)[1]));
        if (!points.back().isFinite()) // a double beyond all floats
            return csv.errorHere("a coordinate beyond all measure", "metres");
    }
    if (csv.error())
        return *csv.error();
    return points;
}

/// Points as CSV with the header `x,y`; read back they are the same.
template <typename Scalar>
void writeCsvPoints(std::ostream &out, const std::vector<Vector2D<Scalar>> &points) {
    out << "x,y\n";
    for (const auto &p : points)
        out << Number(p.x) << ',' << Number(p.y) << '\n';
}

} // namespace vectorlib
