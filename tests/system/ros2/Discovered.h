#pragma once
// What others offer and ask for.
#include "Raw.h"

#include <fastdds/dds/domain/DomainParticipantListener.hpp>

#include <iterator>

namespace ros2 {

/// What is discovered of others; told by Fast DDS' threads.
class Discovered : public dds::DomainParticipantListener {
public:
    void on_participant_discovery(dds::DomainParticipant *, rtps::ParticipantDiscoveryInfo &&found) override {
        using Status = rtps::ParticipantDiscoveryInfo;
        const auto &data = found.info;
        note(participants_, hexOf(data.m_guid),
             found.status != Status::REMOVED_PARTICIPANT && found.status != Status::DROPPED_PARTICIPANT,
             {{"name", data.m_participantName.to_string()}, {"user_data", textOf(data.m_userData)}});
    }
    void on_publisher_discovery(dds::DomainParticipant *, rtps::WriterDiscoveryInfo &&found) override {
        Json entry = endpoint(found.info);
        entry["lifespan_s"] = found.info.m_qos.m_lifespan.duration.to_ns() * 1e-9;
        note(writers_, hexOf(found.info.guid()), found.status != found.REMOVED_WRITER, entry);
    }
    void on_subscriber_discovery(dds::DomainParticipant *, rtps::ReaderDiscoveryInfo &&found) override {
        note(readers_, hexOf(found.info.guid()), found.status != found.REMOVED_READER, endpoint(found.info));
    }
    /// But for those of this participant itself.
    Json list(const std::string &own) {
        constexpr std::size_t digits = 24; // of a participant's part of a GUID
        const std::lock_guard lock(mutex_);
        Json lists = {{"participants", participants_}, {"writers", writers_}, {"readers", readers_}};
        for (Json &entries : lists)
            for (auto entry = entries.begin(); entry != entries.end();)
                entry =
                    entry.key().compare(0, digits, own, 0, digits) ? std::next(entry) : entries.erase(entry);
        return lists;
    }

private:
    std::mutex mutex_;
    Json participants_ = Json::object(), writers_ = Json::object(), readers_ = Json::object();

    template <typename UserData>
    static std::string textOf(const UserData &data) {
        return std::string(data.begin(), data.end());
    }
    template <typename Data>
    static Json endpoint(const Data &data) {
        return {{"topic", data.topicName().to_string()},
                {"type", data.typeName().to_string()},
                {"reliable", data.m_qos.m_reliability.kind == dds::RELIABLE_RELIABILITY_QOS},
                {"transient_local", data.m_qos.m_durability.kind == dds::TRANSIENT_LOCAL_DURABILITY_QOS},
                {"user_data", textOf(data.m_qos.m_userData)},
                {"has_type_information", data.has_type_information()}};
    }
    void note(Json &list, const std::string &guid, bool isThere, const Json &entry) {
        const std::lock_guard lock(mutex_);
        if (isThere)
            list[guid] = entry;
        else
            list.erase(guid);
    }
};

} // namespace ros2
