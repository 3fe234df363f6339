#include "daemons/recorder/HaltCause.h"

#include <QHash>

namespace hermes::recorder {

HaltCause haltCause(const QString &word) {
    using Kind = HaltCause::Kind;
    static const QHash<QString, HaltCause> causes{
        {"", {"", Kind::Wish}},
        {"driver", {"the client that drove stopped", Kind::Wish}},
        {"release", {"the client that drove gave the control back", Kind::Wish}},
        {"reset", {"a stop was released", Kind::Wish}},
        {"settings", {"settings were changed, or motor control was started", Kind::Wish}},
        {"shutdown", {"motor control was ended", Kind::Wish}},
        {"stop", {"STOP: somebody stopped the robot", Kind::Fault}},
        {"time-out", {"time-out: the client that drove sent no more commands in time", Kind::Fault}},
        {"take-over", {"take-over: another client took the control", Kind::Fault}},
        {"client gone", {"lost client: the connection of the client that drove has ended", Kind::Fault}},
        {"gap", {"motor control stood still", Kind::Fault}},
        {"restart", {"motor control failed: it was started anew", Kind::Fault}},
        {"gone", {"motor control was ended or killed, or hangs", Kind::Latched}},
        {"estop", {"STOP: somebody pressed the emergency stop", Kind::Latched}},
        {"controller",
         {"lost controller: a motor controller does not answer or is not ready", Kind::Latched}},
        {"battery", {"low battery", Kind::Latched}},
        {"current", {"a motor drew too much current", Kind::Latched}},
        {"temperature", {"a controller was too hot", Kind::Latched}},
        {"encoder", {"the wheels did not do what they were told", Kind::Latched}},
    };
    return causes.value(
        word, {word.startsWith("controller_") ? "a motor controller reports a fault" : word, Kind::Latched});
}

} // namespace hermes::recorder
