#include "gui/vector/RecordedSession.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Input.h"
#include "vectorlib/mapping/NamedSettings.h"
#include "vectorlib/motion/OdometryFault.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace hermes::vector {

namespace fs = std::filesystem;
using JsonData = nlohmann::json;

namespace {

constexpr std::size_t partDigits = 4;
const std::string scanSuffix = "/scan2d";

/// Where the number of a part begins in its path: NAME-0001.pcap.
std::optional<std::size_t> partNumberAt(const std::string &path, const std::string &extension) {
    const std::size_t end = path.rfind(extension);
    if (end == std::string::npos || end <= partDigits || path[end - partDigits - 1] != '-' ||
        !std::all_of(path.begin() + std::ptrdiff_t(end - partDigits), path.begin() + std::ptrdiff_t(end),
                     [](char c) { return c >= '0' && c <= '9'; }))
        return std::nullopt;
    return end - partDigits;
}

/// The numbered files of a folder, in order.
std::vector<std::string> partsIn(const std::string &folder, const std::string &extension) {
    std::vector<std::string> parts;
    std::error_code error;
    for (fs::directory_iterator file(fs::u8path(folder), error), end; !error && file != end;
         file.increment(error))
        if (const std::string path = file->path().u8string();
            hasExtension(path, extension) && partNumberAt(path, extension) && file->is_regular_file(error))
            parts.push_back(path);
    std::sort(parts.begin(), parts.end());
    return parts;
}

/// The number at that place of a message; nothing: there is none.
std::optional<double> numberAt(const JsonData &message, const std::string &place) {
    const JsonData value =
        message.is_object() ? message.value(JsonData::json_pointer(place), JsonData()) : JsonData();
    if (value.is_boolean())
        return value.get<bool>() ? 1 : 0;
    return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

/// Of a daemon's address, which may be a URL.
std::string withoutScheme(const std::string &address) {
    const std::size_t at = address.find("//");
    return at == std::string::npos ? address : address.substr(at + 2);
}

/// What a message of the topic `odometry` tells, when it has all members and a robot can do so.
std::optional<vectorlib::OdometrySample> sampleFrom(const mcap::Message &message) {
    const JsonData data = JsonData::parse(message.data, nullptr, false);
    vectorlib::OdometrySample sample;
    sample.stamp = 1e-9 * double(message.publishTime_ns);
    sample.covariance.emplace();
    bool isWhole = true;
    const auto take = [&](const std::string &place, double &value) {
        const auto found = numberAt(data, place);
        isWhole = isWhole && found;
        value = found.value_or(0);
    };
    take("/pose/x", sample.pose.x);
    take("/pose/y", sample.pose.y);
    take("/pose/theta", sample.pose.theta);
    take("/twist/vx", sample.twist.vx);
    take("/twist/vy", sample.twist.vy);
    take("/twist/omega", sample.twist.omega);
    for (int i = 0; i < 9; ++i)
        take("/covariance/" + std::to_string(i), (*sample.covariance)(i / 3, i % 3));
    return isWhole && vectorlib::faultOf(sample).empty() ? std::optional(sample) : std::nullopt;
}

/// What a message of the topic `scan2d` tells; nothing where its lists do not fit.
std::optional<vectorlib::TimedScan> scanFrom(const JsonData &data) {
    const auto list = [&](const char *name) {
        const JsonData values = data.is_object() ? data.value(name, JsonData::array()) : JsonData::array();
        std::vector<float> numbers;
        for (const JsonData &value : values)
            numbers.push_back(value.is_number() ? value.get<float>() : std::nanf(""));
        return numbers;
    };
    const std::vector<float> x = list("x"), y = list("y");
    vectorlib::TimedScan scan;
    scan.seconds = list("t");
    const auto stamp = numberAt(data, "/stamp");
    if (!stamp || x.size() != y.size() || (!scan.seconds.empty() && scan.seconds.size() != x.size()))
        return std::nullopt;
    scan.stamp = *stamp;
    scan.rays = std::size_t(std::clamp(numberAt(data, "/rays").value_or(double(x.size())), 0.0, 1e6));
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!std::isfinite(x[i]) || !std::isfinite(y[i]))
            return std::nullopt;
        scan.points.emplace_back(x[i], y[i]);
    }
    return scan;
}

} // namespace

std::vector<std::string> partsFrom(const std::string &path) {
    std::vector<std::string> parts{path};
    const auto at = partNumberAt(path, ".pcap");
    if (!at)
        return parts;
    std::error_code ignored;
    for (unsigned long number = std::stoul(path.substr(*at, partDigits)) + 1;; ++number) {
        const std::string digits = std::to_string(number);
        std::string next = path;
        next.replace(*at, partDigits,
                     digits.size() < partDigits ? std::string(partDigits - digits.size(), '0') + digits
                                                : digits);
        if (!fs::exists(fs::u8path(next), ignored))
            return parts;
        parts.push_back(next);
    }
}

std::optional<std::string> captureIn(const std::string &folder) {
    const std::vector<std::string> parts = partsIn(folder, ".pcap");
    if (parts.empty())
        return std::nullopt;
    const auto nameOf = [](const std::string &path) { return path.substr(0, *partNumberAt(path, ".pcap")); };
    for (const std::string &part : parts)
        if (nameOf(part) != nameOf(parts[0]))
            throw Failure(folder + ": found two captures, " + parts[0] + " and " + part +
                          ", expected one; name its first file");
    return parts[0];
}

RecordedSession::RecordedSession(const std::string &path) {
    std::error_code ignored;
    files_ = fs::is_directory(fs::u8path(path), ignored) ? partsIn(path, ".mcap") : std::vector{path};
    for (const std::string &file : files_)
        readers_.push_back(valueOrFail(mcap::Reader::open(file)));
    readSettings();
    for (mcap::Reader &reader : readers_)
        reader.select([](const mcap::Channel &channel) { return channel.topic == "motorcontrol/odometry"; });
}

void RecordedSession::readSettings() {
    for (mcap::Reader &reader : readers_) {
        reader.select([&](const mcap::Channel &channel) {
            return (channel.topic == matcherTopic || channel.topic == loggerTopic) &&
                   settings_.count(channel.topic) == 0;
        });
        while (const auto message = reader.next())
            settings_.emplace(reader.channels().at(message->channel).topic,
                              JsonData::parse(message->data, nullptr, false));
    }
}

std::optional<double> RecordedSession::number(const char *topic, std::string path) const {
    const auto found = settings_.find(topic);
    std::replace(path.begin(), path.end(), '.', '/');
    return found == settings_.end() ? std::nullopt : numberAt(found->second, '/' + path);
}

vectorlib::ScanTrackerSettings RecordedSession::tracker() const {
    if (settings_.count(matcherTopic) == 0)
        return {};
    return vectorlib::namedTrackerSettings([&](const char *name) {
        if (const auto value = number(matcherTopic, name))
            return *value;
        if (std::string_view(name).substr(0, 8) == "sensor2.") // recorded before there were two scanners
            return 0.0;
        throw Failure(files_[0] + ": found no setting " + name +
                      " in scanmatcher/settings, expected a number");
    });
}

velodyne::TurnAssembler::Options RecordedSession::decoding() const {
    velodyne::TurnAssembler::Options options;
    if (const auto laser = number(loggerTopic, "decode.laser");
        laser && *laser >= 0 && *laser < velodyne::maxLasers())
        options.laser = int(*laser);
    if (const auto offset = number(loggerTopic, "decode.stamp_offset_s"); offset && std::abs(*offset) <= 3600)
        options.stampOffset_ns = std::int64_t(*offset * 1e9);
    return options;
}

velodyne::ClockChoice RecordedSession::clock() const {
    const auto found = settings_.find(loggerTopic);
    const JsonData::json_pointer path("/decode/clock");
    if (found == settings_.end() || !found->second.contains(path) || !found->second.at(path).is_string())
        return velodyne::ClockChoice::Gps;
    return velodyne::clockChoiceFromText(found->second.at(path).get<std::string>());
}

RecordedSession::ScanTopics RecordedSession::scanTopics() const {
    const auto hostOf = [this](const char *source) {
        const auto found = settings_.find(matcherTopic);
        const JsonData::json_pointer place(std::string("/") + source + "/address");
        const JsonData address = found == settings_.end() || !found->second.is_object()
                                     ? JsonData()
                                     : found->second.value(place, JsonData());
        return address.is_string() ? withoutScheme(address.get<std::string>()) : std::string();
    };
    const std::string first = hostOf("source"), second = hostOf("source2");
    std::map<std::string, std::string> hosts; // by topic
    for (const mcap::Reader &reader : readers_)
        for (const auto &[id, channel] : reader.channels())
            if (const std::string &topic = channel.topic;
                topic.size() > scanSuffix.size() &&
                topic.substr(topic.size() - scanSuffix.size()) == scanSuffix) {
                const auto address = channel.metadata.find("address");
                hosts.emplace(topic, address == channel.metadata.end() ? "" : withoutScheme(address->second));
            }
    ScanTopics topics;
    for (const auto &[topic, host] : hosts)
        if (!second.empty() && host == second)
            topics.second = topic;
        else if (topics.first.empty() || (!first.empty() && host == first))
            topics.first = topic;
    for (const auto &[topic, host] : hosts)
        if (topic != topics.first && topic != topics.second)
            topics.others += (topics.others.empty() ? "" : ", ") + topic;
    return topics;
}

void RecordedSession::readScans(
    const std::function<void(const vectorlib::TimedScan &scan, bool partial)> &take) {
    const ScanTopics topics = scanTopics();
    std::optional<vectorlib::TimedScan> waiting; // of the second scanner
    for (const std::string &file : files_) {
        mcap::Reader reader = valueOrFail(mcap::Reader::open(file)); // beside those of the odometry
        reader.select([&](const mcap::Channel &channel) {
            return channel.topic == topics.first || channel.topic == topics.second;
        });
        while (const auto message = reader.next()) {
            const bool isFirst = reader.channels().at(message->channel).topic == topics.first;
            const JsonData data = JsonData::parse(message->data, nullptr, false);
            const bool isPartial = numberAt(data, "/partial").value_or(0) != 0;
            auto scan = scanFrom(data);
            refusedScans_ += !scan;
            if (!scan || (!isFirst && isPartial))
                continue;
            if (isUpsideDown(isFirst ? "sensor" : "sensor2"))
                scan->turnOver();
            if (!isFirst) {
                waiting = std::move(scan);
                continue;
            }
            if (waiting)
                scan->addSecond(std::move(*waiting));
            waiting.reset();
            take(*scan, isPartial);
        }
    }
}

std::optional<vectorlib::OdometrySample> RecordedSession::nextSample() {
    for (; reader_ < readers_.size(); ++reader_)
        while (const auto message = readers_[reader_].next()) {
            if (const auto sample = sampleFrom(*message))
                return sample;
            ++refused_;
        }
    return std::nullopt;
}

std::optional<vectorlib::OdometryTrack> RecordedSession::over(double begin, double end) {
    return feed_.over(begin, end, [this] { return nextSample(); });
}

std::string RecordedSession::problems() const {
    std::string text = refusedScans_ == 0 ? "" : std::to_string(refusedScans_) + " scans cannot be read";
    for (std::size_t i = 0; i < files_.size(); ++i)
        if (const std::string problem = readers_[i].problem(); !problem.empty())
            text += (text.empty() ? "" : "; ") + files_[i] + ": " + problem;
    return text;
}

} // namespace hermes::vector
