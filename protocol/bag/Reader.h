#pragma once

#include "protocol/mcap/File.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hermes::bag {

using mcap::Outcome;

/// What a bag tells of one of its topics.
struct Topic {
    std::string name;
    std::string type;           ///< as sensor_msgs/LaserScan, without the msg/ of ROS 2
    std::string definition;     ///< text of the .msg and of those in it; empty: the bag has none
    std::string serialization;  ///< "ros1", "cdr", "json" or another by its name
    std::uint64_t messages = 0; ///< as the bag tells, or as they were counted
};

struct Message {
    std::size_t topic = 0; ///< its place among the topics
    std::uint64_t time_ns = 0;
    std::string_view data;
};

/// Reads a recording of topics. Whatever it holds, memory is bounded, and what cannot be read is told.
class Reader {
public:
    virtual ~Reader() = default;

    /// Its format, for people.
    virtual std::string kind() const = 0;
    virtual const std::vector<Topic> &topics() const = 0;
    virtual std::uint64_t start_ns() const = 0; ///< least time of a message; 0 without any
    virtual std::uint64_t end_ns() const = 0;   ///< greatest one
    /// Only messages of these topics follow, from the first on.
    virtual void select(const std::function<bool(const Topic &)> &wanted) = 0;
    /// In the order of time, unless problem() tells otherwise. Its data are valid until the next call.
    virtual std::optional<Message> next() = 0;
    /// What could not be read so far, with the record and where it stands; empty: nothing.
    virtual std::string problem() const = 0;
};

/// Opens a .bag of ROS 1, a .db3 or .mcap, plain or packed as a whole by zstd, or the folder of a bag of ROS
/// 2. Fails with the reason when it is none of them, or is of a format that this program was built without.
/// path: in UTF-8.
Outcome<std::unique_ptr<Reader>> open(const std::string &path);

/// Whether the path is a file that begins like a bag, or a folder that has one of ROS 2. Of a recording of
/// hermes-recorder, too.
bool isBag(const std::string &path);

/// sensor_msgs/msg/LaserScan and sensor_msgs/LaserScan are one type.
std::string plainType(std::string type);

} // namespace hermes::bag
