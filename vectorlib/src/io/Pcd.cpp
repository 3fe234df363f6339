#include "vectorlib/io/Pcd.h"

namespace vectorlib {

VECTORLIB_BODY Expected<detail::PcdHeader> detail::readPcdHeader(LineReader &lines) {
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

} // namespace vectorlib
