#pragma once

#include "common/Mailbox.h"
#include "common/daemon/Reply.h"
#include "daemons/motorcontrol/Telemetry.h"

#include <QJsonValue>
#include <atomic>
#include <functional>

namespace hermes::motorcontrol {

class DriveLoop;

/// What the drive loop's thread and the daemon's send each other, so that the one in real time never waits
/// for the ordinary one: not for a lock, and not for its heap either: who made a job deletes it.
struct DriveMail {
    /// Work on the loop, and who waits for its result.
    struct Job {
        std::function<Result<QJsonValue>(DriveLoop &)> work;
        Reply reply;
        Result<QJsonValue> result = QJsonValue();
    };
    static constexpr std::size_t capacity = 64, jobs = 256;

    Mailbox<Job *> asked{jobs}; ///< for the loop; the daemon keeps them
    std::atomic<std::size_t> finished{
        0}; ///< jobs, in the order in which they were asked, since the daemon looked
    Mailbox<Telemetry> reports{capacity}; ///< for the daemon; comes after jobs too
};

} // namespace hermes::motorcontrol
