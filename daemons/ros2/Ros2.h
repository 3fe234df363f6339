#pragma once

#include "common/daemon/Daemon.h"
#include "daemons/ros2/Bridge.h"
#include "daemons/ros2/Service.h"
#include "daemons/ros2/VelocityCommands.h"

namespace hermes::ros2 {

/// hermes-ros2: the robot as a node of ROS 2, by DDS. It is a client of the other daemons and nothing more.
class Ros2 : public Daemon {
public:
    Ros2();
    ~Ros2() override;

protected:
    Result<void> start() override;
    void stop() override;

private:
    void declareSettings();
    Bridge::Options options();
    void follow();
    void lookForPeers();
    Result<void> listenToRos();
    template <typename M>
    Result<void> read(const char *topic, const Quality &quality,
                      void (Ros2::*take)(const M &message, const Reader::Sample &sample));
    Result<void> serve();
    using Trigger = Service<ros::TriggerRequest, ros::TriggerResponse>;
    using GetMap = Service<ros::GetMapRequest, ros::GetMapResponse>;
    /// Calls a command of Hermes and tells how it went. isFree: anyone may.
    Result<void> serveTrigger(const char *name, const QString &command, const QJsonObject &params,
                              bool isFree = false);
    void answerMap(const GetMap::Answer &answer, int waits);
    void takeTwist(const ros::Twist &twist, const Reader::Sample &sample);
    void takeTwistStamped(const ros::TwistStamped &twist, const Reader::Sample &sample);
    void takePose(const ros::PoseWithCovarianceStamped &pose, const Reader::Sample &sample);
    void takeStop(const ros::Bool &stop, const Reader::Sample &sample);
    bool mayCommand(const char *topic, const Guid &writer);
    QString nodeOf(const Guid &writer) const;
    /// The daemon that has this command calls it; answered gets an error too when there is none.
    void call(const QString &command, const QJsonObject &params, const Client::Callback &answered);
    void updateHealth();

    RobotDaemons daemons_;
    std::unique_ptr<Bridge> bridge_;
    std::unique_ptr<VelocityCommands> velocity_;
    std::vector<std::unique_ptr<Reader>> readers_;
    std::vector<std::unique_ptr<Trigger>> triggers_;
    std::unique_ptr<GetMap> getMap_;
    quint64 unreadable_ = 0, forbidden_ = 0;
    QString lastUnreadable_;
    QTimer looks_; ///< at the health
};

} // namespace hermes::ros2
