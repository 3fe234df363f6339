#pragma once

#include "daemons/softwaretrigger/Definition.h"
#include "daemons/softwaretrigger/Schedule.h"
#include "daemons/softwaretrigger/Targets.h"
#include "daemons/softwaretrigger/TriggerMessages.h"

#include <functional>
#include <memory>
#include <optional>

namespace hermes::softwaretrigger {

/// Why a trigger fires now.
struct Occasion {
    std::optional<double> dueMono;  ///< the time that it fires for, by the monotonic clock
    std::optional<double> dueStamp; ///< the same, or the stamp of the message, since the Unix epoch
    quint64 missed = 0;             ///< firings before this one that did not happen, since the last
    FiringCause cause;              ///< no kind: that of the trigger
};

/// Watches for what fires one armed trigger, from its making to its end.
class Watch {
public:
    struct Listener {
        std::function<void(const Occasion &)> fire;
        std::function<void()> missed; ///< a firing was missed, and none follows now
    };
    virtual ~Watch() = default;

    /// Why it cannot watch at the moment; empty when it can.
    virtual QString problem() const { return {}; }
    /// What it has seen.
    virtual WatchedState state() const { return {}; }

    /// None for causes that need no watch: trigger, command. The daemon of the definition must be in use.
    static std::unique_ptr<Watch> make(const TriggerDefinition &definition, Schedule &schedule,
                                       Targets &targets, const Listener &listener);
};

/// The daemon whose topic a definition watches; empty for none.
QString watchedDaemon(const TriggerDefinition &definition);

} // namespace hermes::softwaretrigger
