#pragma once

#include "common/ros/Mapping.h"
#include "protocol/messages/Daemons.h"
#include "protocol/messages/Fixes.h"
#include "protocol/messages/Motors.h"
#include "protocol/ros/Messages.h"

#include <map>

namespace hermes::ros {

/// The robot's battery: the mean voltage of the controllers that answer, and what the gauge knows.
struct BatteryOf {
    bool operator()(const PowerMessage &in, const Told &told, BatteryState &out);
};

/// Where the GPS receiver is, taken for the robot's place. Its height above the ellipsoid is not known (NaN):
/// receivers tell that above the sea.
struct FixOf {
    bool operator()(const FixMessage &in, const Told &told, NavSatFix &out);
};

/// Lines of the log.
struct LogOf {
    bool operator()(const LogMessage &in, const Told &told, Log &out);
};

/// The health of every daemon, all of it once a second. A daemon that does not answer any more is stale.
class Diagnostics : public Translator {
public:
    bool take(const TopicUpdate &update, const Told &told, std::string &cdr, QString &problem) override;
    bool refresh(const RobotModel &, double now, std::string &cdr) override;
    void lose(const QString &daemon) override;

private:
    std::map<QString, std::vector<DiagnosticStatus>> all_;
};

/// The robot as a text in URDF: its body, wheels and sensors.
class Description : public Translator {
public:
    bool take(const TopicUpdate &, const Told &, std::string &, QString &) override { return false; }
    bool refresh(const RobotModel &robot, double now, std::string &cdr) override;

private:
    int revision_ = -1;
};

std::string urdfOf(const RobotModel &robot);

} // namespace hermes::ros
