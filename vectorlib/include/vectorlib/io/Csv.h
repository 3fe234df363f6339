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
        : m_lines(in, std::move(name))
        , m_columns(std::move(columns))
        , m_furtherColumns(furtherColumns) {}

    /// The next row: the values of all required columns, then of the optional ones the file has. Nothing at
    /// the end of the file or on an error, see error().
    const std::vector<double> *next() {
        while (const auto line = m_lines.next()) {
            const std::string_view text = trimmed(*line);
            if (text.empty() || text.front() == '#')
                continue;
            splitCommas(text, m_fields);
            if (m_width == 0 && takeHeader())
                continue;
            return !m_error && takeRow() ? &m_row : nullptr;
        }
        if (!m_error)
            m_error = m_lines.error();
        if (!m_error && m_lines.number() == 0)
            m_error = m_lines.errorHere("an empty file", expectation());
        return nullptr;
    }

    const std::optional<InputError> &error() const { return m_error; }
    std::size_t line() const { return m_lines.number(); }
    InputError errorHere(std::string found, std::string expected) const {
        return m_lines.errorHere(std::move(found), std::move(expected));
    }
    /// Whether the file has the optional column `index`; known after the first row.
    bool hasOptional(std::size_t index) const { return m_row.size() > m_columns.required.size() + index; }
    /// The columns that were not asked for, as they stand in the current row, and their names (empty without
    /// header).
    const std::vector<std::string_view> &further() const { return m_further; }
    const std::vector<std::string> &furtherNames() const { return m_furtherNames; }

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
        m_width = m_fields.size();
        const bool header = !isNumberLike(m_fields.front());
        for (std::size_t i = 0; i < m_columns.required.size() + m_columns.optional.size(); ++i) {
            const bool required = i < m_columns.required.size();
            const std::string &column =
                required ? m_columns.required[i] : m_columns.optional[i - m_columns.required.size()];
            const std::size_t at =
                header ? static_cast<std::size_t>(std::find(m_fields.begin(), m_fields.end(), column) -
                                                  m_fields.begin())
                       : i;
            if (at < m_width)
                m_positions.push_back(at);
            else if (required && !m_error)
                m_error = m_lines.errorHere("no column " + column, expectation());
            else if (!required)
                break; // optional columns count from the first on
        }
        for (std::size_t at = 0; at < m_width; ++at)
            if (std::find(m_positions.begin(), m_positions.end(), at) == m_positions.end()) {
                m_furtherPositions.push_back(at);
                m_furtherNames.emplace_back(header ? m_fields[at] : std::string_view());
            }
        if (!header && !m_furtherColumns && !m_furtherPositions.empty() && !m_error)
            m_error = m_lines.errorHere(std::to_string(m_width) + " fields and no header", expectation());
        return header && !m_error;
    }

    bool takeRow() {
        if (m_fields.size() != m_width) {
            m_error = m_lines.errorHere(
                std::to_string(m_fields.size()) + (m_fields.size() == 1 ? " field" : " fields"),
                std::to_string(m_width) + " fields as in the first line: " + expectation());
            return false;
        }
        m_row.clear();
        for (const std::size_t at : m_positions) {
            const auto number = parseNumber(m_fields[at]);
            if (!number) {
                m_error =
                    m_lines.errorHere(quoted(m_fields[at]), "a finite number as " + columnName(m_row.size()));
                return false;
            }
            m_row.push_back(*number);
        }
        m_further.clear();
        for (const std::size_t at : m_furtherPositions)
            m_further.push_back(m_fields[at]);
        return true;
    }

    const std::string &columnName(std::size_t i) const {
        return i < m_columns.required.size() ? m_columns.required[i]
                                             : m_columns.optional[i - m_columns.required.size()];
    }
    /// `columns x,y` or `columns a,b[,weight]`
    std::string expectation() const {
        std::string text = "columns ";
        for (std::size_t i = 0; i < m_columns.required.size(); ++i)
            text += (i ? "," : "") + m_columns.required[i];
        for (const std::string &column : m_columns.optional)
            text += "[," + column + "]";
        return text;
    }

    LineReader m_lines;
    CsvColumns m_columns;
    bool m_furtherColumns;
    std::size_t m_width = 0;
    std::vector<std::size_t> m_positions;
    std::vector<std::size_t> m_furtherPositions;
    std::vector<std::string> m_furtherNames;
    std::vector<std::string_view> m_fields;
    std::vector<std::string_view> m_further;
    std::vector<double> m_row;
    std::optional<InputError> m_error;
};

} // namespace vectorlib
