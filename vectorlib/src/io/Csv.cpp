#include "vectorlib/io/Csv.h"

namespace vectorlib {

VECTORLIB_BODY Expected<PairTable> readCsvPairs(std::istream &in, std::string name) {
    CsvReader csv(in, std::move(name),
                  {{"sx1", "sy1", "sx2", "sy2", "dx1", "dy1", "dx2", "dy2"}, {"weight"}});
    PairTable table;
    while (const auto *row = csv.next()) {
        const std::vector<double> &r = *row;
        SegmentPair pair;
        pair.fixed = {{r[0], r[1]}, {r[2], r[3]}};
        pair.moving = {{r[4], r[5]}, {r[6], r[7]}};
        table.hasWeights = csv.hasOptional(0);
        if (table.hasWeights)
            pair.weight = r[8];
        for (const LineSegment2D<double> &s : {pair.fixed, pair.moving})
            if (!(s.direction().squaredNorm() > 0.5 && std::isfinite(s.length())))
                return csv.errorHere("a segment of no length or beyond all measure",
                                     "two distinct end points");
        if (!(pair.weight > 0))
            return csv.errorHere("a weight of " + std::to_string(pair.weight), "a weight above 0");
        table.pairs.push_back(pair);
    }
    if (csv.error())
        return *csv.error();
    if (table.pairs.empty())
        return csv.errorHere("the end of the file and no pair", "at least one pair of segments");
    return table;
}

VECTORLIB_BODY const std::vector<double> *CsvReader::next() {
    while (const auto line = lines_.next()) {
        const std::string_view text = trimmed(*line);
        if (text.empty() || text.front() == '#')
            continue;
        splitCommas(text, fields_);
        if (width_ == 0 && takeHeader())
            continue;
        return !error_ && takeRow() ? &row_ : nullptr;
    }
    if (!error_)
        error_ = lines_.error();
    if (!error_ && lines_.number() == 0)
        error_ = lines_.errorHere("an empty file", expectation());
    return nullptr;
}

VECTORLIB_BODY bool CsvReader::isNumberLike(std::string_view field) {
    if (field.empty() || parseNumber(field))
        return true;
    const char c = field[field[0] == '-' || field[0] == '+' ? std::min<std::size_t>(1, field.size() - 1) : 0];
    std::string lower(field);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char ch) { return ch >= 'A' && ch <= 'Z' ? ch + 32 : ch; });
    return (c >= '0' && c <= '9') || c == '.' || lower.find("nan") != std::string::npos ||
           lower.find("inf") != std::string::npos;
}

VECTORLIB_BODY bool CsvReader::takeHeader() {
    width_ = fields_.size();
    const bool header = !isNumberLike(fields_.front());
    for (std::size_t i = 0; i < columns_.required.size() + columns_.optional.size(); ++i) {
        const bool required = i < columns_.required.size();
        const std::string &column =
            required ? columns_.required[i] : columns_.optional[i - columns_.required.size()];
        const std::size_t at = header
                                   ? static_cast<std::size_t>(
                                         std::find(fields_.begin(), fields_.end(), column) - fields_.begin())
                                   : i;
        if (at < width_)
            positions_.push_back(at);
        else if (required && !error_)
            error_ = lines_.errorHere("no column " + column, expectation());
        else if (!required)
            break; // optional columns count from the first on
    }
    for (std::size_t at = 0; at < width_; ++at)
        if (std::find(positions_.begin(), positions_.end(), at) == positions_.end()) {
            furtherPositions_.push_back(at);
            furtherNames_.emplace_back(header ? fields_[at] : std::string_view());
        }
    if (!header && !furtherColumns_ && !furtherPositions_.empty() && !error_)
        error_ = lines_.errorHere(std::to_string(width_) + " fields and no header", expectation());
    return header && !error_;
}

VECTORLIB_BODY bool CsvReader::takeRow() {
    if (fields_.size() != width_) {
        error_ =
            lines_.errorHere(std::to_string(fields_.size()) + (fields_.size() == 1 ? " field" : " fields"),
                             std::to_string(width_) + " fields as in the first line: " + expectation());
        return false;
    }
    row_.clear();
    for (const std::size_t at : positions_) {
        const auto number = parseAnyNumber(fields_[at]);
        if (!number || !(std::isfinite(*number) || columns_.anyNumbers)) {
            error_ = lines_.errorHere(vectorlib::quoted(fields_[at]),
                                      "a finite number as " + columnName(row_.size()));
            return false;
        }
        row_.push_back(*number);
    }
    further_.clear();
    for (const std::size_t at : furtherPositions_)
        further_.push_back(fields_[at]);
    return true;
}

VECTORLIB_BODY std::string CsvReader::expectation() const {
    std::string text = "columns ";
    for (std::size_t i = 0; i < columns_.required.size(); ++i)
        text += (i ? "," : "") + columns_.required[i];
    for (const std::string &column : columns_.optional)
        text += "[," + column + "]";
    return text;
}

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
