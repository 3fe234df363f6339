#pragma once

#include "vectorlib/Body.h"
#include "vectorlib/geometry/LineSegment2D.h"
#include "vectorlib/io/Number.h"
#include "vectorlib/io/TextInput.h"

#include <algorithm>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace vectorlib {

/// Pairs of segments that readCsvPairs() read; metres.
struct PairTable {
    std::vector<SegmentPair> pairs;
    bool hasWeights = false; ///< the file has a column `weight`
};

/// Pairs from CSV: `sx1,sy1,sx2,sy2,dx1,dy1,dx2,dy2[,weight]`. A segment of no length or a weight that is not
/// above 0 is an error, and so is a file without a pair.
Expected<PairTable> readCsvPairs(std::istream &in, std::string name);

/// Which columns a CSV file must and may have.
struct CsvColumns {
    std::vector<std::string> required; ///< in this order where the file has no header
    std::vector<std::string> optional; ///< behind them, in this order
    bool anyNumbers = false;           ///< inf and nan are no error
};

/// Rows of numbers from a CSV file: `#` comments, empty lines and one header line are allowed. With a header,
/// columns are found by name and others may stand between; without one they stand in order and none may be
/// left over unless `furtherColumns`. Any field asked for that is no finite number is an error; so is a file
/// of no bytes.
class CsvReader {
public:
    CsvReader(std::istream &in, std::string name, CsvColumns columns, bool furtherColumns = false)
        : lines_(in, std::move(name))
        , columns_(std::move(columns))
        , furtherColumns_(furtherColumns) {}

    /// The next row: the values of all required columns, then of the optional ones the file has. Nothing at
    /// the end of the file or on an error, see error().
    const std::vector<double> *next();

    const std::optional<InputError> &error() const { return error_; }
    std::size_t line() const { return lines_.number(); }
    /// An error at the row that was read last.
    InputError errorHere(std::string found, std::string expected) const {
        return lines_.errorHere(std::move(found), std::move(expected));
    }
    /// Whether the file has the optional column `index`; known after the first row.
    bool hasOptional(std::size_t index) const { return row_.size() > columns_.required.size() + index; }
    /// The columns that were not asked for, as they stand in the current row, and their names (empty without
    /// header).
    const std::vector<std::string_view> &further() const { return further_; }
    const std::vector<std::string> &furtherNames() const { return furtherNames_; }

private:
    static bool isNumberLike(std::string_view field);

    /// Settles where the columns are from the first line; true when it is a header.
    bool takeHeader();

    bool takeRow();

    const std::string &columnName(std::size_t i) const {
        return i < columns_.required.size() ? columns_.required[i]
                                            : columns_.optional[i - columns_.required.size()];
    }
    /// `columns x,y` or `columns a,b[,weight]`
    std::string expectation() const;

    LineReader lines_;
    CsvColumns columns_;
    bool furtherColumns_;
    std::size_t width_ = 0;
    std::vector<std::size_t> positions_;
    std::vector<std::size_t> furtherPositions_;
    std::vector<std::string> furtherNames_;
    std::vector<std::string_view> fields_;
    std::vector<std::string_view> further_;
    std::vector<double> row_;
    std::optional<InputError> error_;
};

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

#include VECTORLIB_BODIES("vectorlib/src/io/Csv.cpp")
