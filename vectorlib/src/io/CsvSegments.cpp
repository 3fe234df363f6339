#include "vectorlib/io/CsvSegments.h"

namespace vectorlib {

VECTORLIB_BODY Expected<SegmentTable> readCsvSegments(std::istream &in, std::string name) {
    CsvReader csv(in, std::move(name), {{"x1", "y1", "x2", "y2"}, {}}, true);
    SegmentTable table;
    while (const auto *row = csv.next()) {
        table.segments.emplace_back(Vector2D<double>((*row)[0], (*row)[1]),
                                    Vector2D<double>((*row)[2], (*row)[3]));
        if (!std::isfinite((table.segments.back().end() - table.segments.back().begin()).squaredNorm()))
            return csv.errorHere("a segment beyond all measure", "end points in metres");
        table.further.emplace_back(csv.further().begin(), csv.further().end());
    }
    if (csv.error())
        return *csv.error();
    table.furtherNames = csv.furtherNames();
    return table;
}

} // namespace vectorlib
