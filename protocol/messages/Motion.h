#pragma once

#include "protocol/wire/FieldsOf.h"
#include "vectorlib/geometry/Pose2D.h"

#include <array>

namespace hermes {

using vectorlib::Pose2D;
using vectorlib::Twist2D;

/// Of x, y and theta, row by row (m^2, m rad, rad^2).
using Covariance = std::array<double, 9>;

/// The topic `odometry`.
struct OdometryMessage {
    Pose2D pose;
    Twist2D twist;
    Covariance covariance{};
    double mono = 0;
};

/// The topic `truth` of the simulator.
struct TruthMessage {
    double stamp = 0;
    Pose2D pose;
    Twist2D twist;
    double progress = 0;
    bool driving = false;
    bool finished = false;
    bool touching = false;
};

Fields<Pose2D> fieldsOf(Of<Pose2D>);
Fields<Twist2D> fieldsOf(Of<Twist2D>);
Fields<OdometryMessage> fieldsOf(Of<OdometryMessage>);
Fields<TruthMessage> fieldsOf(Of<TruthMessage>);

} // namespace hermes
