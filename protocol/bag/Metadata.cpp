#include "protocol/bag/Metadata.h"

#include <algorithm>
#include <sstream>

namespace hermes::bag {

namespace {

constexpr std::size_t mostFiles = 10000;

std::string trimmed(const std::string &text) {
    const char *const blanks = " \t\r";
    const std::size_t begin = text.find_first_not_of(blanks);
    return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::string unquoted(const std::string &text) {
    const bool isQuoted =
        text.size() >= 2 && text.front() == text.back() && (text[0] == '"' || text[0] == '\'');
    return isQuoted ? text.substr(1, text.size() - 2) : text;
}

/// Whatever it says: files of a bag lie in its folder.
std::string withoutFolder(const std::string &path) {
    return path.substr(path.find_last_of('/') + 1);
}

} // namespace

Metadata readMetadata(const std::string &yaml) {
    Metadata found;
    std::istringstream lines(yaml);
    bool isInFiles = false;
    for (std::string line; std::getline(lines, line);) {
        const std::string text = trimmed(line);
        const std::size_t colon = text.find(':');
        const std::string key = text.substr(0, colon);
        const std::string value = colon == std::string::npos ? "" : unquoted(trimmed(text.substr(colon + 1)));
        if (isInFiles && text.substr(0, 2) == "- ") {
            if (const std::string name = withoutFolder(unquoted(trimmed(text.substr(2))));
                !name.empty() && name != ".." && found.files.size() < mostFiles)
                found.files.push_back(name);
            continue;
        }
        isInFiles = key == "relative_file_paths";
        found.isBag = found.isBag || key == "rosbag2_bagfile_information";
        if (key == "compression_format")
            found.compression = value;
        if (isInFiles && value.size() > 2 && value.front() == '[' && value.back() == ']') { // in one line
            std::istringstream names(value.substr(1, value.size() - 2));
            for (std::string name; std::getline(names, name, ',') && found.files.size() < mostFiles;)
                found.files.push_back(withoutFolder(unquoted(trimmed(name))));
        }
    }
    return found;
}

} // namespace hermes::bag
