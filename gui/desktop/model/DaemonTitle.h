#pragma once

#include "gui/desktop/model/Fleet.h"

namespace hermes::desktop {

/// The name of a daemon, and where there are several robots that of its robot too.
inline QString titleOf(const Fleet &fleet, const Robot &robot, const DaemonLink &daemon) {
    return fleet.robots().size() > 1 ? robot.name() + ' ' + daemon.name() : daemon.name();
}

} // namespace hermes::desktop
