#pragma once

#include "protocol/wire/FieldsOf.h"

#include <array>

namespace hermes {

/// Position (m) and heading (rad, counter-clockwise) in a frame that whoever has it names.
struct Pose {
    double x = 0;
    double y = 0;
    double theta = 0;
};

/// Velocity in the body's own frame: x forward, y left (m/s), omega counter-clockwise (rad/s).
struct Twist {
    double vx = 0;
    double vy = 0;
    double omega = 0;
};

/// Of x, y and theta, row by row (m^2, m rad, rad^2).
using Covariance = std::array<double, 9>;

/// The topic `odometry`.
struct OdometryMessage {
    Pose pose;
    Twist twist;
    Covariance covariance{};
    double mono = 0;
};

/// The topic `truth` of the simulator.
struct TruthMessage {
    double stamp = 0;
    Pose pose;
    Twist twist;
    double progress = 0;
    bool driving = false;
    bool finished = false;
    bool touching = false;
};

template <>
const Fields<Pose> &fieldsOf<Pose>();
template <>
const Fields<Twist> &fieldsOf<Twist>();
template <>
const Fields<OdometryMessage> &fieldsOf<OdometryMessage>();
template <>
const Fields<TruthMessage> &fieldsOf<TruthMessage>();

} // namespace hermes
