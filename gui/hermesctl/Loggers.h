#pragma once

#include "gui/hermesctl/Arguments.h"
#include "gui/hermesctl/Connection.h"
#include "gui/session/SessionMember.h"

namespace hermes::ctl {

/// The loggers of a robot, and the connections to them.
struct Loggers {
    std::vector<std::unique_ptr<Client>> clients;
    SessionMembers members;

    /// Those that --daemons names, or else those at the default ports of the host. A named one that is none
    /// or does not answer is among the silent: nothing begins without it, but the others can be stopped.
    static Result<Loggers> find(const Arguments &arguments);
};

} // namespace hermes::ctl
