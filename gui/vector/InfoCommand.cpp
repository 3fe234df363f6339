#include "gui/vector/BagDrive.h"
#include "gui/vector/BagMessages.h"
#include "gui/vector/Failure.h"
#include "gui/vector/Options.h"
#include "vectorlib/io/Number.h"

#include <nlohmann/json.hpp>

#include <iostream>

namespace hermes::vector {

namespace {

using Json = nlohmann::ordered_json;

/// Of a topic what its messages tell, where the bag does not tell it.
struct TopicSpan {
    std::uint64_t messages = 0, first_ns = 0, last_ns = 0;
};

/// All messages, one by one: of a bag that does not tell all that it has.
std::vector<TopicSpan> countedOf(const std::string &path, std::string &problem) {
    const auto reader = valueOrFail(bag::open(path));
    std::vector<TopicSpan> spans(reader->topics().size());
    while (const auto message = reader->next()) {
        TopicSpan &span = spans[message->topic];
        span.first_ns = span.messages == 0 ? message->time_ns : span.first_ns;
        span.last_ns = message->time_ns;
        ++span.messages;
    }
    problem = reader->problem();
    return spans;
}

struct InfoCommand {
    std::string path;
    OutputOptions output;

    void run() const {
        Outputs files(output);
        const BagDrive drive(path);
        const bag::Reader &reader = drive.reader();
        Json json;
        json["kind"] = reader.kind();
        std::string problem = reader.problem();
        std::vector<TopicSpan> counted;
        for (const bag::Topic &topic : reader.topics())
            counted.push_back({topic.messages, reader.start_ns(), reader.end_ns()});
        if (!problem.empty())
            counted = countedOf(path, problem);
        addSpan(json, counted);
        for (std::size_t i = 0; i < counted.size(); ++i)
            json["topics"].push_back(topic(reader.topics()[i], counted[i]));
        json["scanners"] = Json::array();
        for (const BagScanner &one : drive.scanners())
            json["scanners"].push_back(scanner(one));
        json["odometry"] = drive.odometry().empty() ? Json() : Json(drive.odometry());
        if (!problem.empty()) {
            json["problem"] = problem;
            std::cerr << "hermes-vector: " << path << ": " << printable(problem) << '\n';
        }
        files.out << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
        files.commit();
    }

    static void addSpan(Json &json, const std::vector<TopicSpan> &spans) {
        std::uint64_t messages = 0, first_ns = 0, last_ns = 0;
        for (const TopicSpan &span : spans) {
            if (span.messages == 0)
                continue;
            first_ns = messages == 0 ? span.first_ns : std::min(first_ns, span.first_ns);
            last_ns = std::max(last_ns, span.last_ns);
            messages += span.messages;
        }
        json["begin"] = double(first_ns) / 1e9;
        json["seconds"] = secondsOf({0, first_ns, last_ns});
        json["messages"] = messages;
        json["topics"] = Json::array();
    }
    static double secondsOf(const TopicSpan &span) {
        return span.last_ns > span.first_ns ? double(span.last_ns - span.first_ns) / 1e9 : 0;
    }
    static Json topic(const bag::Topic &topic, const TopicSpan &span) {
        Json json{{"name", topic.name},
                  {"type", topic.type},
                  {"serialization", topic.serialization},
                  {"messages", span.messages}};
        if (const double seconds = secondsOf(span); span.messages > 1 && seconds > 0)
            json["hz"] = vectorlib::rounded(double(span.messages) / seconds, 2);
        return json;
    }
    static Json scanner(const BagScanner &scanner) {
        Json json{{"topic", scanner.topic}, {"type", scanner.type}, {"frame", scanner.frame}};
        if (!scanner.problem.empty()) {
            json["problem"] = scanner.problem;
            return json;
        }
        json["rays"] = scanner.rays;
        json["field_of_view_deg"] = vectorlib::rounded(scanner.fieldOfView * 180 / vectorlib::pi, 1);
        json["robot"] = scanner.base;
        const auto &mount = scanner.mount;
        json["sensor"] =
            mount ? Json{vectorlib::micrometres(mount->x), vectorlib::micrometres(mount->y), mount->theta}
                  : Json();
        if (scanner.isUpsideDown)
            json["upside_down"] = true;
        return json;
    }
};

} // namespace

void addInfoCommand(CLI::App &app) {
    const auto [sub, command] = addCommand<InfoCommand>(
        app, "info",
        "What is in a bag of ROS: topics, scanners and where they are on the robot, the "
        "odometry, and what cannot be read (JSON)",
        "hermes-vector info drive.bag");
    sub->add_option("BAG", command->path, "Bag: .bag, .db3, .mcap, or the folder of one")->required();
    command->output.addTo(*sub, false);
}

} // namespace hermes::vector
