#include "protocol/messages/Motion.h"

#include "protocol/wire/Fields.h"

namespace hermes {
namespace {

constexpr double farthest = 1e10; // beyond it differences of poses lose their digits

} // namespace

Fields<Pose2D> fieldsOf(Of<Pose2D>) {
    return Fields<Pose2D>()
        .add("x", &Pose2D::x, "Position", "m")
        .range(-farthest, farthest)
        .add("y", &Pose2D::y, "Position", "m")
        .range(-farthest, farthest)
        .add("theta", &Pose2D::theta, "Heading, counter-clockwise", "rad")
        .range(-farthest, farthest);
}

Fields<Twist2D> fieldsOf(Of<Twist2D>) {
    return Fields<Twist2D>()
        .add("vx", &Twist2D::vx, "Forward", "m/s")
        .range(-farthest, farthest)
        .add("vy", &Twist2D::vy, "To the left", "m/s")
        .range(-farthest, farthest)
        .add("omega", &Twist2D::omega, "Counter-clockwise", "rad/s")
        .range(-farthest, farthest);
}

Fields<OdometryMessage> fieldsOf(Of<OdometryMessage>) {
    return Fields<OdometryMessage>()
        .add("pose", &OdometryMessage::pose, "Since odometry.reset")
        .add("twist", &OdometryMessage::twist, "As measured, in the robot's frame")
        .add("covariance", &OdometryMessage::covariance, "Of x, y and theta of the pose, row by row")
        .range(-farthest, farthest)
        .addMaybe("mono", &OdometryMessage::mono, "The stamp on a clock that never jumps", "s");
}

Fields<TruthMessage> fieldsOf(Of<TruthMessage>) {
    return Fields<TruthMessage>()
        .add("stamp", &TruthMessage::stamp, "On the clock of the lidar's stamps", "s")
        .include(&TruthMessage::pose)
        .include(&TruthMessage::twist)
        .add("progress", &TruthMessage::progress, "Share of the path behind the robot")
        .range(0, 1)
        .add("driving", &TruthMessage::driving, "It follows the path")
        .add("finished", &TruthMessage::finished, "It is at the end of the path")
        .add("touching", &TruthMessage::touching, "A wall or a person holds it");
}

} // namespace hermes
