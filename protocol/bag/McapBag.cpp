#include "protocol/bag/McapBag.h"

#include "protocol/bag/TopicList.h"
#include "protocol/bag/Zstd.h"
#include "protocol/mcap/Reader.h"

namespace hermes::bag {

namespace {

/// Whether its text is that of .msg files, and not another form of ROS or of others.
bool isMsg(const mcap::Schema &schema) {
    return schema.encoding == "ros1msg" || schema.encoding == "ros2msg";
}

class McapBag : public Reader {
public:
    explicit McapBag(mcap::Reader reader);

    std::string kind() const override {
        return std::string("MCAP") + (reader_.isWhole() ? "" : ", read without its index");
    }
    const std::vector<Topic> &topics() const override { return topics_.all(); }
    std::uint64_t start_ns() const override { return reader_.start_ns(); }
    std::uint64_t end_ns() const override { return reader_.end_ns(); }
    void select(const std::function<bool(const Topic &)> &wanted) override {
        reader_.select(
            [&](const mcap::Channel &channel) { return wanted(topics()[places_.at(channel.id)]); });
    }
    std::optional<Message> next() override;
    std::string problem() const override { return reader_.problem() + unpackProblem_; }

private:
    mcap::Reader reader_;
    TopicList topics_;
    std::map<std::uint16_t, std::size_t> places_; ///< of channels, among the topics
    std::string unpacked_, unpackProblem_;
};

McapBag::McapBag(mcap::Reader reader)
    : reader_(std::move(reader)) {
    for (const auto &[id, channel] : reader_.channels()) {
        const auto schema = reader_.schemas().find(channel.schema);
        const bool isTold = schema != reader_.schemas().end();
        const auto count = reader_.counts().find(id);
        places_[id] = topics_.add({channel.topic, isTold ? plainType(schema->second.name) : "",
                                   isTold && isMsg(schema->second) ? schema->second.data : "",
                                   channel.encoding, count == reader_.counts().end() ? 0 : count->second});
    }
}

std::optional<Message> McapBag::next() {
    while (const auto read = reader_.next()) {
        Message message{places_.at(read->channel), read->logTime_ns, read->data};
        if (topics()[message.topic].serialization == "cdr" && isZstd(message.data)) { // no CDR begins so
            const std::string why = unpackMessage(message.data, unpacked_);
            if (!why.empty() && unpackProblem_.empty())
                unpackProblem_ = (reader_.problem().empty() ? "" : "; ") + topics()[message.topic].name +
                                 ", message " + std::to_string(read->sequence) + ": " + why;
            if (!why.empty())
                continue;
            message.data = unpacked_;
        }
        return message;
    }
    return std::nullopt;
}

} // namespace

Outcome<std::unique_ptr<Reader>> openMcap(const std::string &path) {
    auto reader = mcap::Reader::open(path);
    if (!reader)
        return reader.error();
    return std::unique_ptr<Reader>(std::make_unique<McapBag>(reader.take()));
}

} // namespace hermes::bag
