#pragma once

#include "vectorlib/io/TextInput.h"

#include <algorithm>
#include <string>

namespace vectorlib {

/// Which columns a CSV file must and may have.
struct CsvColumns {
    std::vector<std::string> required; ///< in this order where the file has no header
    std::vector<std::string> optional; ///< behind them, in this order
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
    const std::vector<double> *next() {
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
    static bool isNumberLike(std::string_view field) {
        if (field.empty() || parseNumber(field))
            return true;
        const char c =
            field[field[0] == '-' || field[0] == '+' ? std::min<std::size_t>(1, field.size() - 1) : 0];
        std::string lower(field);
        std::transform(lower.begin(), lower.end(), lower.begin(),
                       [](unsigned char ch) { return ch >= 'A' && ch <= 'Z' ? ch + 32 : ch; });
        return (c >= '0' && c <= '9') || c == '.' || lower.find("nan") != std::string::npos ||
               lower.find("inf") != std::string::npos;
    }

    /// Settles where the columns are from the first line; true when it is a header.
    bool takeHeader() {
        width_ = fields_.size();
        const bool header = !isNumberLike(fields_.front());
        for (std::size_t i = 0; i < columns_.required.size() + columns_.optional.size(); ++i) {
            const bool required = i < columns_.required.size();
            const std::string &column =
                required ? columns_.required[i] : columns_.optional[i - columns_.required.size()];
            const std::size_t at =
                header ? static_cast<std::size_t>(std::find(fields_.begin(), fields_.end(), column) -
                                                  fields_.begin())
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

    bool takeRow() {
        if (fields_.size() != width_) {
            error_ = lines_.errorHere(
                std::to_string(fields_.size()) + (fields_.size() == 1 ? " field" : " fields"),
                std::to_string(width_) + " fields as in the first line: " + expectation());
            return false;
        }
        row_.clear();
        for (const std::size_t at : positions_) {
            const auto number = parseNumber(fields_[at]);
            if (!number) {
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

    const std::string &columnName(std::size_t i) const {
        return i < columns_.required.size() ? columns_.required[i]
                                            : columns_.optional[i - columns_.required.size()];
    }
    /// `columns x,y` or `columns a,b[,weight]`
    std::string expectation() const {
        std::string text = "columns ";
        for (std::size_t i = 0; i < columns_.required.size(); ++i)
            text += (i ? "," : "") + columns_.required[i];
        for (const std::string &column : columns_.optional)
            text += "[," + column + "]";
        return text;
    }

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

} // namespace vectorlib
