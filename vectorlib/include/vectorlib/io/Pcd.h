#pragma once

#include "vectorlib/geometry/Vector2D.h"
#include "vectorlib/io/TextInput.h"

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
inline Expected<PcdHeader> readPcdHeader(LineReader &lines) {
    constexpr std::size_t limit = std::size_t(1) << 30;
    PcdHeader header;
    std::vector<std::string> names;
    std::vector<std::size_t> counts;
    std::vector<std::string_view> fields;
    bool havePoints = false;
    while (const auto line = lines.next()) {
        const std::string_view text = trimmed(*line);
        if (text.empty() || text.front() == '#')
            continue;
        splitBlanks(text, fields);
        const std::string keyword(fields.front());
        fields.erase(fields.begin());
        if (keyword == "FIELDS" || keyword == "COLUMNS") {
            names.assign(fields.begin(), fields.end());
        } else if (keyword == "COUNT" || keyword == "POINTS") {
            for (const std::string_view field : fields) {
                const auto count = parseCount(field, keyword == "COUNT" ? 10000 : limit);
                if (!count || (keyword == "COUNT" && *count == 0)) // a field of no numbers has no place
                    return lines.errorHere(vectorlib::quoted(field), "a count as " + keyword);
                if (keyword == "COUNT")
                    counts.push_back(*count);
                else
                    header.points = *count;
                havePoints |= keyword == "POINTS";
            }
        } else if (keyword == "DATA") {
            if (fields.empty() || fields.front() != "ascii")
                return lines.errorHere(vectorlib::quoted(text), "DATA ascii");
            if (!havePoints)
                return lines.errorHere("a header without POINTS", "the number of points");
            bool hasX = false, hasY = false;
            for (std::size_t i = 0; i < names.size(); ++i) {
                if (names[i] == "x" && !hasX) {
                    header.x = header.width;
                    hasX = true;
                } else if (names[i] == "y" && !hasY) {
                    header.y = header.width;
                    hasY = true;
                }
                header.width += i < counts.size() ? counts[i] : 1;
            }
            if (!hasX || !hasY)
                return lines.errorHere("a header without the fields x and y", "FIELDS x y ...");
            return header;
        } else if (keyword != "VERSION" && keyword != "SIZE" && keyword != "TYPE" && keyword != "WIDTH" &&
                   keyword != "HEIGHT" && keyword != "VIEWPOINT") {
            return lines.errorHere(vectorlib::quoted(keyword),
                                   "a line of a PCD header such as FIELDS or DATA");
        }
    }
    return lines.error() ? *lines.error()
                         : lines.errorHere("the end of the file", "a PCD header with a line DATA");
}

} // namespace detail

/// Points from an ascii PCD file, in file order, x and y only; metres. A number of points other than
/// announced, or a coordinate that is no finite number, is an error.
template <typename Scalar = float>
Expected<std::vector<Vector2D<Scalar>>> readPcd(std::istream &in, std::string name) {
    LineReader lines(in, std::move(name));
    const auto header = detail::readPcdHeader(lines);
    if (!header)
        return header.error();
    std::vector<Vector2D<Scalar>> points;
    std::vector<std::string_view> fields;
    while (const auto line = lines.next()) {
        splitBlanks(*line, fields);
        if (fields.empty())
            continue;
        if (points.size() == header->points)
            return lines.errorHere("a further line",
                                   std::to_string(header->points) + " points as the header says");
        if (fields.size() != header->width)
            return lines.errorHere(std::to_string(fields.size()) + " fields",
                                   std::to_string(header->width) + " fields");
        const auto x = parseNumber(fields[header->x]), y = parseNumber(fields[header->y]);
        if (!x || !y)
            return lines.errorHere(vectorlib::quoted(fields[x ? header->y : header->x]),
                                   std::string("a finite number as ") + (x ? "y" : "x"));
        points.emplace_back(static_cast<Scalar>(*x), static_cast<Scalar>(*y));
        if (!points.back().isFinite()) // a double beyond all floats
            return lines.errorHere("a coordinate beyond all measure", "metres");
    }
    if (lines.error())
        return *lines.error();
    if (points.size() != header->points)
        return lines.errorHere("the end of the file after " + std::to_string(points.size()) + " points",
                               std::to_string(header->points) + " points as the header says");
    return points;
}

} // namespace vectorlib
