#pragma once

#include "protocol/bag/Reader.h"

#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace hermes::bag {

/// Topics, each once: several writers of a bag may have told of one.
class TopicList {
public:
    const std::vector<Topic> &all() const { return topics_; }

    /// Its place in the list; what is known already is counted on.
    std::size_t add(Topic topic) {
        const auto [known, isNew] =
            places_.emplace(std::tuple(topic.name, topic.type, topic.serialization), topics_.size());
        if (isNew)
            topics_.push_back(std::move(topic));
        else
            topics_[known->second].messages += topic.messages;
        return known->second;
    }
    /// More messages of the one at that place.
    void count(std::size_t place, std::uint64_t messages) { topics_[place].messages += messages; }

private:
    std::vector<Topic> topics_;
    std::map<std::tuple<std::string, std::string, std::string>, std::size_t> places_;
};

} // namespace hermes::bag
