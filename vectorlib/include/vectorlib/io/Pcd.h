#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/io/TextInput.h"

#include <string>
#include <vector>

namespace vectorlib {

namespace detail {

/// What the header of a PCD file says, as far as it matters here.
struct PcdHeader {
    std::size_t x = 0; ///< position of the field in a line
    std::size_t y = 0;
    std::size_t width = 0; ///< numbers a line
    std::size_t points = 0;
};

/// Reads the header up to and with its line DATA.
Expected<PcdHeader> readPcdHeader(LineReader &lines);

} // namespace detail

/// Points from an ascii PCD file, in file order, x and y only; metres. A number of points other than
/// announced, or a coordinate that is no number, is an error. A point with a coordinate inf or nan is a ray
/// without return and left out.
template <typename Scalar = float>
Expected<std::vector<Vector2D<Scalar>>> readPcd(std::istream &in, std::string name) {
    LineReader lines(in, std::move(name));
    const auto header = detail::readPcdHeader(lines);
    if (!header)
        return header.error();
    std::vector<Vector2D<Scalar>> points;
    std::vector<std::string_view> fields;
    std::size_t count = 0; // with those left out
    while (const auto line = lines.next()) {
        splitBlanks(*line, fields);
        if (fields.empty())
            continue;
        if (count++ == header->points)
            return lines.errorHere("a further line",
                                   std::to_string(header->points) + " points as the header says");
        if (fields.size() != header->width)
            return lines.errorHere(std::to_string(fields.size()) + " fields",
                                   std::to_string(header->width) + " fields");
        const auto x = parseAnyNumber(fields[header->x]), y = parseAnyNumber(fields[header->y]);
        if (!x || !y)
            return lines.errorHere(vectorlib::quoted(fields[x ? header->y : header->x]),
                                   std::string("a number as ") + (x ? "y" : "x"));
        if (!std::isfinite(*x) || !std::isfinite(*y))
            continue;
        points.emplace_back(static_cast<Scalar>(*x), static_cast<Scalar>(*y));
        if (!points.back().isFinite()) // a double beyond all floats
            return lines.errorHere("a coordinate beyond all measure", "metres");
    }
    if (lines.error())
        return *lines.error();
    if (count != header->points)
        return lines.errorHere("the end of the file after " + std::to_string(count) + " points",
                               std::to_string(header->points) + " points as the header says");
    return points;
}

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/Pcd.cpp")
