#pragma once

#include "gui/hermesctl/Arguments.h"
#include "gui/hermesctl/Connection.h"
#include "gui/session/SessionMember.h"

namespace hermes::ctl {

/// The loggers of a robot, and the connections to them.
struct Loggers {
    std::vector<std::unique_ptr<Client>> clients;
    SessionMembers members;

    /// Those that --daemons names, of which each must be one; else those at the default ports of the host.
    static Result<Loggers> find(const Arguments &arguments);
};

} // namespace hermes::ctl
