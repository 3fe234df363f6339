#include "common/help/HelpText.h"

#include "common/platform/Console.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace hermes {
namespace {

constexpr std::size_t narrowest = 40;
constexpr std::size_t hanging = 4; // of what follows on further lines

/// Characters of UTF-8.
std::size_t lengthOf(const std::string &text) {
    return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string spaces(std::size_t count) {
    return std::string(count, ' ');
}

/// A line of a help text, with the lines that belong to it.
struct Entry {
    std::size_t indent = 0;
    std::string name;                     ///< or the whole line
    std::size_t column = 0;               ///< of the description; 0: it has none
    std::vector<std::string> description; ///< paragraphs, those of a list with the spaces before them
};

Entry entryOf(const std::string &line) {
    Entry entry;
    entry.indent = line.find_first_not_of(' ');
    const std::size_t gap = line.find("  ", entry.indent);
    entry.name = line.substr(entry.indent, gap - entry.indent);
    if (gap == std::string::npos)
        return entry;
    entry.column = line.find_first_not_of(' ', gap);
    entry.description.push_back(line.substr(entry.column));
    return entry;
}

bool goesOn(const Entry &entry, const Entry &line) {
    return entry.indent > 0 && line.column == 0 &&
           (entry.column == 0 ? line.indent > entry.indent + hanging : line.indent >= entry.column);
}

void extend(Entry &entry, const Entry &line) {
    if (entry.column == 0)
        entry.column = line.indent;
    const std::size_t deeper = line.indent - entry.column;
    if (deeper > 0 || entry.description.empty())
        entry.description.push_back(spaces(deeper) + line.name);
    else
        entry.description.back() += ' ' + line.name;
}

/// The words, and lists without spaces in pieces that fit.
std::vector<std::string> piecesOf(const std::string &text, std::size_t room) {
    std::vector<std::string> pieces;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        std::size_t begin = 0;
        while (lengthOf(word.substr(begin)) > room) {
            const std::size_t comma = word.rfind(',', begin + room - 1);
            if (comma == std::string::npos || comma < begin)
                break;
            pieces.push_back(word.substr(begin, comma + 1 - begin) + '\n'); // goes on without a space
            begin = comma + 1;
        }
        pieces.push_back(word.substr(begin));
    }
    return pieces;
}

/// Puts words into lines; the first begins at the place where the text ends now, the others at an
/// indentation.
class Writer {
public:
    Writer(std::string &text, std::size_t width)
        : text_(text)
        , width_(width) {}

    void put(const std::string &words, std::size_t indent) {
        bool isFirst = true, isJoined = false;
        for (std::string piece : piecesOf(words, width_ - indent)) {
            const bool ends = piece.back() == '\n';
            if (ends)
                piece.pop_back();
            const std::size_t gap = isFirst || isJoined ? 0 : 1;
            if (!isFirst && (isJoined || at_ + gap + lengthOf(piece) > width_))
                begin(indent);
            else
                write(spaces(gap));
            write(piece);
            isFirst = false;
            isJoined = ends;
        }
    }
    void begin(std::size_t indent) {
        text_ += '\n';
        at_ = 0;
        write(spaces(indent));
    }
    void write(const std::string &part) {
        text_ += part;
        at_ += lengthOf(part);
    }
    std::size_t at() const { return at_; }

private:
    std::string &text_;
    std::size_t width_;
    std::size_t at_ = 0;
};

void write(const Entry &entry, std::size_t width, std::string &text) {
    Writer writer(text, width);
    writer.write(spaces(entry.indent));
    const std::size_t further = entry.indent > 0 ? entry.indent + hanging : 0;
    writer.put(entry.name, further);
    if (entry.column > 0) {
        const std::size_t column = std::min(entry.column, std::max(entry.indent + 2 * hanging, width / 3));
        if (writer.at() + 1 < column)
            writer.write(spaces(column - writer.at()));
        else
            writer.begin(column);
        for (const std::string &paragraph : entry.description) {
            const std::size_t deeper = paragraph.find_first_not_of(' ');
            if (deeper > 0)
                writer.begin(column + deeper);
            writer.put(paragraph, column + (deeper > 0 ? deeper + 2 : 0));
        }
    }
    text += '\n';
}

} // namespace

std::string fittedHelp(const std::string &text, std::size_t width) {
    std::string fitted;
    std::vector<Entry> last; // one, or none
    const auto flush = [&] {
        for (const Entry &entry : last)
            write(entry, std::max(width, narrowest), fitted);
        last.clear();
    };
    bool isExample = false;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        line.erase(line.find_last_not_of(' ') + 1);
        isExample = !line.empty() && (isExample || line == "Example:" || line == "Examples:");
        if (line.empty() || isExample) {
            flush();
            fitted += line + '\n';
            continue;
        }
        const Entry entry = entryOf(line);
        if (!last.empty() && goesOn(last.back(), entry)) {
            extend(last.back(), entry);
            continue;
        }
        flush();
        last.push_back(entry);
    }
    flush();
    return fitted;
}

std::string fittedHelp(const std::string &text) {
    return fittedHelp(text, std::size_t(terminalWidth()));
}

} // namespace hermes
