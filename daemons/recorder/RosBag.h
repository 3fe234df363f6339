#pragma once

#include "common/ros/Mapping.h"
#include "daemons/recorder/SessionReader.h"
#include "protocol/mcap/Writer.h"

#include <deque>

namespace hermes::recorder {

/// Writes a session as hermes-ros2 would have told it: an MCAP file that `ros2 bag play`, RViz and Foxglove
/// take.
class RosBag {
public:
    explicit RosBag(mcap::Writer &writer)
        : writer_(writer) {}

    void take(const SessionMessage &message);
    /// Messages written so far.
    quint64 messages() const { return messages_; }
    /// Those that could not be read as what they should be.
    quint64 unreadable() const { return unreadable_; }

private:
    struct Outlet {
        const ros::Mapping *mapping;
        QString name, daemon;
        std::unique_ptr<ros::Translator> translator;
        std::uint16_t channel;
        std::uint32_t sequence = 0;
    };

    Outlet &outletFor(const ros::Mapping &mapping, const QString &daemon);
    void write(Outlet &outlet, double stamp);
    void refresh(double stamp);

    mcap::Writer &writer_;
    ros::RobotModel robot_{QString()};
    std::deque<Outlet> outlets_;
    double refreshed_ = 0; ///< stamp
    std::string cdr_;
    quint64 messages_ = 0, unreadable_ = 0;
};

} // namespace hermes::recorder
