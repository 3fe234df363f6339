#include "common/world/World.h"

#include <nlohmann/json.hpp>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace hermes {

namespace {

using Json = nlohmann::json;

constexpr double shortestEdge = 1e-6; // metres
constexpr double farthest = 1e7; // metres from the origin; beyond, products of coordinates lose all meaning
constexpr double fastestPerson = 10; // m/s

/// What is wrong, and in which line; 0 where no line can be told.
struct Fault {
    int line;
    std::string what;
};

/// Counts lines as the parser consumes text, so that values can be told the line in which they end.
class LineCounter {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char *;
    using reference = const char &;

    LineCounter(const char *position, int *line)
        : position_(position)
        , line_(line) {}
    reference operator*() const { return *position_; }
    LineCounter &operator++() {
        *line_ += *position_ == '\n';
        ++position_;
        return *this;
    }
    bool operator==(const LineCounter &o) const { return position_ == o.position_; }
    bool operator!=(const LineCounter &o) const { return position_ != o.position_; }

private:
    const char *position_;
    int *line_;
};

/// The document and the lines in which the rows of its lists end.
struct Document {
    Json root;
    std::map<std::string, std::vector<int>> lines;

    int lineOf(const std::string &list, std::size_t row) const {
        const auto found = lines.find(list);
        return found != lines.end() && row < found->second.size() ? found->second[row] : 0;
    }
};

Document parse(const std::string &text) {
    Document document;
    int line = 1;
    std::string key;
    const auto note = [&](int depth, Json::parse_event_t event, Json &parsed) {
        if (event == Json::parse_event_t::key && depth == 1) {
            key = parsed.get<std::string>();
            if (!document.lines.emplace(key, std::vector<int>()).second)
                throw Fault{line, "\"" + key + "\" appears twice"};
        }
        // Every element of a list of the root, be it the row that is expected or not.
        const bool ends = event == Json::parse_event_t::array_end ||
                          event == Json::parse_event_t::object_end || event == Json::parse_event_t::value;
        if (ends && depth == 2)
            document.lines[key].push_back(line);
        return true;
    };
    try {
        document.root =
            Json::parse(LineCounter(text.data(), &line), LineCounter(text.data() + text.size(), &line), note);
    } catch (const Json::exception &e) {
        const std::string what = e.what(); // begins with an identifier in brackets
        const auto bracket = what.find("] ");
        throw Fault{line, "not JSON: " + (bracket == std::string::npos ? what : what.substr(bracket + 2))};
    }
    return document;
}

constexpr std::size_t anyWidth = 0;

/// The rows of a list of number lists, each with width numbers.
std::vector<std::vector<double>> rows(const Document &document, const std::string &list, std::size_t width,
                                      const std::string &expected) {
    const Json &value = document.root[list];
    if (!value.is_array())
        throw Fault{0, "\"" + list + "\": a list of " + expected + " expected, found " + value.type_name()};
    std::vector<std::vector<double>> result;
    for (std::size_t i = 0; i < value.size(); ++i) {
        const auto refuse = [&](const std::string &found) {
            throw Fault{document.lineOf(list, i),
                        list + "[" + std::to_string(i) + "]: " + expected + " expected, found " + found};
        };
        if (!value[i].is_array())
            refuse(value[i].type_name());
        if (width != anyWidth && value[i].size() != width)
            refuse(std::to_string(value[i].size()) + " values");
        result.emplace_back();
        for (const Json &number : value[i]) {
            if (!number.is_number())
                refuse(number.is_null() ? "null (there is no NaN or infinity in a world)" : number.dump());
            result.back().push_back(number.get<double>());
            if (!(std::abs(result.back().back()) <= farthest))
                refuse(number.dump() + ", over 1e7");
        }
    }
    return result;
}

std::vector<World::Person> peopleOf(const Document &document) {
    const std::string expected = "[speed, x1, y1, x2, y2, ...] in m/s and metres";
    std::vector<World::Person> people;
    for (const auto &row : rows(document, "people", anyWidth, expected)) {
        const auto refuse = [&](const std::string &found) {
            const std::size_t i = people.size();
            throw Fault{document.lineOf("people", i),
                        "people[" + std::to_string(i) + "]: " + expected + " expected, found " + found};
        };
        if (row.size() < 5 || row.size() % 2 == 0)
            refuse(std::to_string(row.size()) + " values");
        if (!(row[0] > 0 && row[0] <= fastestPerson))
            refuse("a speed that is not above 0 and at most " + std::to_string(int(fastestPerson)));
        World::Person person{row[0], {}};
        for (std::size_t i = 1; i < row.size(); i += 2)
            person.way.emplace_back(row[i], row[i + 1]);
        for (std::size_t i = 1; i < person.way.size(); ++i) {
            if ((person.way[i] - person.way[i - 1]).norm() < shortestEdge)
                refuse("the same point twice in a row");
        }
        people.push_back(person);
    }
    return people;
}

World toWorld(const Document &document) {
    if (!document.root.is_object())
        throw Fault{0, std::string("an object with \"edges\" expected, found ") + document.root.type_name()};
    World world;
    for (const auto &[key, value] : document.root.items()) {
        if (key == "name" && value.is_string())
            world.name = value;
        else if (key == "name")
            throw Fault{0, "\"name\": a string expected, found " + std::string(value.type_name())};
        else if (key != "edges" && key != "poses" && key != "people")
            throw Fault{0, "unknown key \"" + key + "\", expected are name, edges, poses and people"};
    }
    if (!document.root.contains("edges") || document.root["edges"].empty())
        throw Fault{0, "no edges: \"edges\": [[x1, y1, x2, y2], ...] expected, metres"};
    for (const auto &row : rows(document, "edges", 4, "[x1, y1, x2, y2] in metres")) {
        world.edges.push_back({row[0], row[1], row[2], row[3]});
        const std::size_t i = world.edges.size() - 1;
        if (std::hypot(row[2] - row[0], row[3] - row[1]) < shortestEdge)
            throw Fault{document.lineOf("edges", i),
                        "edges[" + std::to_string(i) + "]: an edge must not begin where it ends"};
    }
    if (document.root.contains("poses")) {
        for (const auto &row : rows(document, "poses", 3, "[x, y, theta] in metres and radians"))
            world.poses.push_back({row[0], row[1], row[2]});
    }
    if (document.root.contains("people"))
        world.people = peopleOf(document);
    return world;
}

} // namespace

Outcome<World> parseWorld(const std::string &text, const std::string &path) {
    try {
        return toWorld(parse(text));
    } catch (const Fault &fault) {
        return path + ":" + (fault.line > 0 ? std::to_string(fault.line) + ":" : "") + " " + fault.what;
    }
}

Outcome<World> readWorld(const std::string &path) {
    std::ifstream file(std::filesystem::u8path(path), std::ios::binary);
    std::stringstream text;
    if (file)
        text << file.rdbuf();
    if (!file || file.bad())
        return path + ": cannot be read: " + std::strerror(errno);
    return parseWorld(text.str(), path);
}

} // namespace hermes
