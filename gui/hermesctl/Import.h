#pragma once

#include "gui/hermesctl/Arguments.h"
#include "gui/hermesctl/Connection.h"

namespace hermes::ctl {

/// Makes a session of a bag of ROS (the word after the recorder), in the folder of the recorder, which has to
/// be on this computer: `scanner/scan2d` in the frame of the robot, `motorcontrol/odometry`, and
/// `scanmatcher/pose` where the bag has a map.
Result<void> importSession(Client &recorder, const Arguments &arguments);

} // namespace hermes::ctl
