#include "common/ros/Motion.h"

namespace hermes::ros {
namespace {

constexpr double maxPoseAge_s = 2; // of the matcher's last pose, for which the odometry stands in
constexpr double openVariance = 1e4, doubtVariance = 1; // m^2
constexpr double doubtHeadingVariance = 0.1;            // rad^2

// Of x, y and the heading among six coordinates.
constexpr std::array<std::size_t, 9> planar{0, 1, 5, 6, 7, 11, 30, 31, 35};

Covariance6 toCovariance(const Covariance &covariance) {
    Covariance6 all{};
    for (std::size_t i = 0; i < planar.size(); ++i)
        all[planar[i]] = covariance[i];
    return all;
}

/// Of the pose of something that is fixed to the other at this place: the lever adds what the heading does.
Covariance movedCovariance(const Covariance &c, const Pose2D &from, const Pose2D &to) {
    const double a = -(to.y - from.y), b = to.x - from.x; // change of x and y with the heading
    const std::array<std::array<double, 3>, 3> j{{{1, 0, a}, {0, 1, b}, {0, 0, 1}}};
    Covariance moved{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t l = 0; l < 3; ++l)
                    moved[row * 3 + column] += j[row][k] * c[k * 3 + l] * j[column][l];
    return moved;
}

/// The robot's, of the pose that the matcher told.
Pose2D baseOf(const Pose2D &sensor, const RobotModel &robot) {
    return sensor * robot.matchedMount().value_or(Mount()).pose.inverse();
}

} // namespace

bool OdometryOf::operator()(const OdometryMessage &in, const Told &told, Odometry &out) {
    out.header = headerOf(told.stamp, told.robot.odometryFrame());
    out.childFrameId = told.robot.baseFrame();
    out.pose = {toPose(in.pose), toCovariance(in.covariance)};
    out.twist.twist = {{in.twist.vx, in.twist.vy, 0}, {0, 0, in.twist.omega}};
    return true;
}

bool MapPose::operator()(const PoseMessage &in, const Told &told, PoseWithCovarianceStamped &out) {
    const Pose2D base = baseOf(in.pose, told.robot);
    Covariance covariance{openVariance, 0, 0, 0, openVariance, 0, 0, 0, doubtHeadingVariance};
    if (in.covariance)
        covariance = movedCovariance(*in.covariance, in.pose, base);
    if (in.outcome != "matched" || in.trust < leastTrust) {
        covariance[0] += doubtVariance;
        covariance[4] += doubtVariance;
        covariance[8] += doubtHeadingVariance;
    }
    out.header = headerOf(told.stamp, told.robot.mapFrame());
    out.pose = {toPose(base), toCovariance(covariance)};
    return true;
}

bool JointsOf::operator()(const WheelsMessage &in, const Told &told, JointState &out) {
    out.header = headerOf(told.stamp, {});
    out.name.clear();
    out.position.clear();
    out.velocity.clear();
    for (std::size_t i = 0; i < WheelsMessage::count; ++i)
        if (const std::optional<WheelMessage> &wheel = in.*WheelsMessage::wheels()[i]) {
            out.name.push_back(std::string(WheelsMessage::names[i]) + "_wheel_joint");
            out.position.push_back(wheel->angle);
            out.velocity.push_back(wheel->speed);
        }
    return !out.name.empty();
}

bool Transforms::take(const TopicUpdate &update, const Told &told, std::string &cdr, QString &problem) {
    out_.transforms.clear();
    ReadReport report;
    if (update.topic == "odometry") {
        if (const auto odometry = readMessage<OdometryMessage>(update.data, report))
            takeOdometry(*odometry, told);
    } else if (update.topic == "pose") {
        if (const auto pose = readMessage<PoseMessage>(update.data, report))
            takePose(*pose, told);
    } else if (const auto wheels = readMessage<WheelsMessage>(update.data, report)) {
        takeWheels(*wheels, told);
    }
    if (report.hasFailed())
        problem = report.text();
    if (out_.transforms.empty())
        return false;
    toCdr(out_, cdr);
    return true;
}

void Transforms::lose(const QString &daemon) {
    if (daemon == poseFrom_)
        odometryInMap_.reset();
}

void Transforms::takeOdometry(const OdometryMessage &odometry, const Told &told) {
    add(headerOf(told.stamp, told.robot.odometryFrame()), told.robot.baseFrame(), toTransform(odometry.pose));
    if (odometryInMap_ && told.stamp - poseAt_ < maxPoseAge_s)
        add(headerOf(told.stamp, told.robot.mapFrame()), told.robot.odometryFrame(),
            toTransform(*odometryInMap_));
}

void Transforms::takePose(const PoseMessage &pose, const Told &told) {
    odometryInMap_ = pose.odometryFrame;
    poseAt_ = told.stamp;
    poseFrom_ = told.daemon;
    if (!odometryInMap_)
        add(headerOf(told.stamp, told.robot.mapFrame()), told.robot.baseFrame(),
            toTransform(baseOf(pose.pose, told.robot)));
}

/// The wheel's own turn is about its axis, y.
void Transforms::takeWheels(const WheelsMessage &wheels, const Told &told) {
    constexpr double pause_s = 1; // while they stand: for who comes later
    std::array<double, WheelsMessage::count> angles{};
    for (std::size_t i = 0; i < angles.size(); ++i)
        if (const std::optional<WheelMessage> &wheel = wheels.*WheelsMessage::wheels()[i])
            angles[i] = wheel->angle;
    const double since_s = told.stamp - wheelsAt_;
    if (std::exchange(wheelAngles_, angles) == angles && since_s >= 0 && since_s < pause_s)
        return;
    wheelsAt_ = told.stamp;
    for (const WheelPlace &place : told.robot.wheels())
        for (std::size_t i = 0; i < WheelsMessage::count; ++i) {
            const std::optional<WheelMessage> &wheel = wheels.*WheelsMessage::wheels()[i];
            if (!wheel || place.name != WheelsMessage::names[i])
                continue;
            Transform transform = toTransform(place.pose);
            transform.translation.z = place.radius;
            const double s = std::sin(place.pose.theta / 2), c = std::cos(place.pose.theta / 2);
            const double t = std::sin(wheel->angle / 2), u = std::cos(wheel->angle / 2);
            transform.rotation = {-s * t, c * t, s * u, c * u};
            add(headerOf(told.stamp, told.robot.baseFrame()), told.robot.frame(place.name + "_wheel"),
                transform);
        }
}

void Transforms::add(const Header &parent, const std::string &child, const Transform &transform) {
    out_.transforms.push_back({parent, child, transform});
}

bool FixedTransforms::refresh(const RobotModel &robot, double now, std::string &cdr) {
    if (std::exchange(revision_, robot.revision()) == robot.revision())
        return false;
    TfMessage message;
    for (const auto &[daemon, mount] : robot.mounts()) {
        Transform transform = toTransform(mount.pose);
        transform.rotation = toQuaternion(mount);
        message.transforms.push_back(
            {headerOf(now, robot.baseFrame()), robot.sensorFrame(daemon), transform});
    }
    toCdr(message, cdr);
    return !message.transforms.empty();
}

} // namespace hermes::ros
