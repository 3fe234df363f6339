#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/io/Csv.h"
#include "vectorlib/io/InputError.h"
#include "vectorlib/io/Number.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace vectorlib {

/// Segments of a CSV file with whatever else stands in their rows.
struct SegmentTable {
    std::vector<LineSegment2D<double>> segments; ///< metres; free space on the left
    std::vector<std::string> furtherNames;       ///< of the columns beside x1,y1,x2,y2; empty without header
    std::vector<std::vector<std::string>> further; ///< their fields, row by row
};

/// Segments from CSV: columns `x1,y1,x2,y2`, by name where there is a header, else the first four. A segment
/// too long for its length to be told is an error.
Expected<SegmentTable> readCsvSegments(std::istream &in, std::string name);

/// Segments as CSV with the header `x1,y1,x2,y2`.
template <typename Scalar>
void writeCsvSegments(std::ostream &out, const std::vector<LineSegment2D<Scalar>> &segments) {
    out << "x1,y1,x2,y2\n";
    for (const auto &s : segments)
        out << Number(s.begin().x) << ',' << Number(s.begin().y) << ',' << Number(s.end().x) << ','
            << Number(s.end().y) << '\n';
}

} // namespace vectorlib

#include VECTORLIB_BODIES("vectorlib/src/io/CsvSegments.cpp")
