#pragma once
// Readers and writers of one topic.
#include "Raw.h"

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include <condition_variable>
#include <memory>
#include <thread>
#include <utility>

namespace ros2 {

inline Json matched(const std::string &topic, const char *side, int count) {
    return {{"matched", topic}, {"side", side}, {"count", count}};
}

/// Tells each sample, or counts them with how long they were on their way.
class Samples : public dds::DataReaderListener {
public:
    Samples(const std::string &topic, bool isQuiet)
        : topic_(topic)
        , isQuiet_(isQuiet) {}
    void on_data_available(dds::DataReader *reader) override {
        Bytes data;
        dds::SampleInfo info;
        while (reader->take_next_sample(&data, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
            if (info.valid_data)
                take(data, info);
    }
    void on_subscription_matched(dds::DataReader *, const dds::SubscriptionMatchedStatus &status) override {
        tell(matched(topic_, "reader", status.current_count));
    }
    void on_requested_incompatible_qos(dds::DataReader *,
                                       const dds::RequestedIncompatibleQosStatus &status) override {
        tell({{"incompatible", topic_}, {"side", "reader"}, {"policy", status.last_policy_id}});
    }
    Json report() {
        const std::lock_guard lock(mutex_);
        std::vector<double> sorted = milliseconds_;
        std::sort(sorted.begin(), sorted.end());
        const auto share = [&](double part) {
            return sorted.empty() ? Json() : Json(sorted[std::size_t(part * double(sorted.size() - 1))]);
        };
        return {{"count", sorted.size()},
                {"bytes", bytes_},
                {"median_ms", share(0.5)},
                {"p95_ms", share(0.95)},
                {"worst_ms", share(1)}};
    }

private:
    const std::string topic_;
    const bool isQuiet_;
    std::mutex mutex_;
    std::vector<double> milliseconds_;
    std::uint64_t bytes_ = 0;

    void take(const Bytes &data, const dds::SampleInfo &info) {
        const std::int64_t received = now_ns(), source = info.source_timestamp.to_ns();
        {
            const std::lock_guard lock(mutex_);
            milliseconds_.push_back(double(received - source) * 1e-6);
            bytes_ += data.size();
        }
        if (!isQuiet_)
            tell({{"topic", topic_},
                  {"hex", hexOf(data.data(), data.size())},
                  {"t", received},
                  {"source", source},
                  {"guid", hexOf(info.sample_identity.writer_guid())}});
    }
};

class Matches : public dds::DataWriterListener {
public:
    explicit Matches(const std::string &topic)
        : topic_(topic) {}
    void on_publication_matched(dds::DataWriter *, const dds::PublicationMatchedStatus &status) override {
        tell(matched(topic_, "writer", status.current_count));
    }
    void on_offered_incompatible_qos(dds::DataWriter *,
                                     const dds::OfferedIncompatibleQosStatus &status) override {
        tell({{"incompatible", topic_}, {"side", "writer"}, {"policy", status.last_policy_id}});
    }

private:
    const std::string topic_;
};

/// Sends bytes again and again in a thread of its own, until it is destroyed.
class Sender {
public:
    Sender(dds::DataWriter *writer, Bytes bytes, std::uint64_t count, double rate_hz)
        : thread_([=, data = std::move(bytes)]() mutable { run(writer, data, count, rate_hz); }) {}
    ~Sender() {
        {
            const std::lock_guard lock(mutex_);
            isOver_ = true;
        }
        wake_.notify_all();
        thread_.join();
    }

private:
    std::mutex mutex_;
    std::condition_variable wake_;
    bool isOver_ = false;
    std::thread thread_; // last: it uses the others

    void run(dds::DataWriter *writer, Bytes &data, std::uint64_t count, double rate_hz) {
        using Clock = std::chrono::steady_clock;
        const Clock::time_point begin = Clock::now();
        for (std::uint64_t sent = 0; !count || sent < count; ++sent) {
            const std::chrono::duration<double> at(rate_hz > 0 ? double(sent) / rate_hz : 0);
            std::unique_lock lock(mutex_);
            if (wake_.wait_until(lock, begin + std::chrono::duration_cast<Clock::duration>(at),
                                 [this] { return isOver_; }))
                return;
            lock.unlock();
            if (!writer->write(&data))
                tell({{"error", "a sample was not written"}});
        }
    }
};

struct Endpoint {
    dds::Topic *topic = nullptr;
    dds::DataReader *reader = nullptr;
    dds::DataWriter *writer = nullptr;
    std::unique_ptr<Samples> samples;
    std::unique_ptr<Matches> matches;
    std::unique_ptr<Sender> sender; // before the writer, of which it holds the address
};

/// Of a reader or a writer, as a request tells it.
template <typename Qos>
Qos qosOf(const Json &request, Qos qos) {
    const int depth = request.value("depth", 5);
    qos.reliability().kind =
        request.value("reliable", true) ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
    qos.durability().kind = request.value("transient_local", false) ? dds::TRANSIENT_LOCAL_DURABILITY_QOS
                                                                    : dds::VOLATILE_DURABILITY_QOS;
    qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = depth;
    qos.resource_limits().max_samples_per_instance = std::max(400, depth);
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    const std::string userData = request.value("user_data", "");
    qos.user_data().data_vec(Bytes(userData.begin(), userData.end()));
    qos.data_sharing().off();
    return qos;
}

} // namespace ros2
