#include "daemons/recorder/RosBag.h"

#include <algorithm>

namespace hermes::recorder {
namespace {

constexpr double refreshPeriod_s = 1; // as hermes-ros2 does

/// As rosbag2 keeps it: numbers are those of rmw. Source: rosbag2_storage, qos.cpp.
std::string qualityText(const ros::Quality &quality) {
    const std::string never = "    sec: 9223372036\n    nsec: 854775807\n";
    return "- history: 1\n  depth: " + std::to_string(quality.depth) +
           "\n  reliability: " + (quality.isReliable ? "1" : "2") +
           "\n  durability: " + (quality.isLatched ? "1" : "2") + "\n  deadline:\n" + never +
           "  lifespan:\n" + never + "  liveliness: 1\n  liveliness_lease_duration:\n" + never +
           "  avoid_ros_namespace_conventions: false\n";
}

} // namespace

void RosBag::take(const SessionMessage &message) {
    const QString daemon = message.daemon(), topic = message.name();
    TopicUpdate update;
    update.topic = topic;
    update.stamp = message.stamp;
    update.data = message.data();
    if (topic == "settings")
        robot_.takeSettings(daemon, update.json().toObject());
    if (topic == "scan2d") {
        const auto &metadata = message.channel.metadata;
        const auto address = metadata.find("address");
        robot_.addScanner(daemon,
                          address == metadata.end() ? QString() : QString::fromStdString(address->second));
    }
    for (const ros::Mapping &mapping : ros::mappings()) {
        if (!mapping.topics.contains(topic))
            continue;
        Outlet &outlet = outletFor(mapping, mapping.isOfEach ? daemon : QString());
        QString problem;
        if (outlet.translator->take(update, {daemon, message.stamp, robot_}, cdr_, problem))
            write(outlet, message.stamp);
        unreadable_ += !problem.isEmpty();
    }
    if (std::abs(message.stamp - refreshed_) >= refreshPeriod_s)
        refresh(message.stamp);
}

void RosBag::refresh(double stamp) {
    refreshed_ = stamp;
    for (const ros::Mapping &mapping : ros::mappings())
        if (mapping.topics.isEmpty())
            outletFor(mapping, {});
    for (Outlet &outlet : outlets_)
        if (outlet.translator->refresh(robot_, stamp, cdr_))
            write(outlet, stamp);
}

RosBag::Outlet &RosBag::outletFor(const ros::Mapping &mapping, const QString &daemon) {
    for (Outlet &outlet : outlets_)
        if (outlet.mapping == &mapping && outlet.daemon == daemon)
            return outlet;
    const bool isFirst = std::none_of(outlets_.begin(), outlets_.end(),
                                      [&](const Outlet &one) { return one.name == mapping.rosTopic; });
    const QString name = mapping.nameOf(daemon, isFirst || daemon.isEmpty());
    const std::uint16_t schema = writer_.addSchema(mapping.type, "ros2msg", mapping.definition);
    const std::uint16_t channel = writer_.addChannel(schema, '/' + name.toStdString(), "cdr",
                                                     {{"offered_qos_profiles", qualityText(mapping.quality)},
                                                      {"topic_type_hash", mapping.hash.toStdString()}});
    outlets_.push_back({&mapping, name, daemon, mapping.make(), channel, 0});
    return outlets_.back();
}

void RosBag::write(Outlet &outlet, double stamp) {
    mcap::Message message;
    message.channel = outlet.channel;
    message.sequence = outlet.sequence++;
    message.logTime_ns = message.publishTime_ns = std::uint64_t(std::max(0.0, stamp) * 1e9);
    message.data = cdr_;
    messages_ += writer_.write(message);
}

} // namespace hermes::recorder
