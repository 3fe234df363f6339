#pragma once

#include "daemons/softwaretrigger/FiringLog.h"
#include "protocol/messages/Motion.h"

#include <QJsonValue>
#include <QString>
#include <optional>
#include <vector>

namespace hermes::softwaretrigger {

/// Why a trigger fired; beside its kind what that kind has to tell.
struct FiringCause {
    QString kind;
    std::optional<quint64> n;
    std::optional<double> dueMono, due, travelled;
    std::optional<Pose2D> pose;
    std::optional<QJsonValue> value;
    std::optional<QString> trigger, client;
    std::optional<quint64> triggerSeq;
};

/// How an action of a firing ended.
struct ActionOutcome {
    struct Failure {
        int code = 0;
        QString message;
    };
    QString action;
    bool ok = false;
    double duration_s = 0;
    std::optional<Failure> error;
    std::optional<QJsonValue> result;
};

/// The topic `fired`, and what trigger.fire gives.
struct FiringMessage {
    QString id;
    quint64 seq = 0;
    double stamp = 0, mono = 0, jitter_s = 0;
    quint64 missed = 0;
    FiringCause cause;
    bool ok = false;
    std::vector<ActionOutcome> results;
};

/// What the watch of a trigger has seen.
struct WatchedState {
    std::optional<quint64> messages, badMessages, jumps;
    std::optional<double> travelled;
};

/// What trigger.list tells of a trigger beside its definition.
struct TriggerState {
    bool armed = false;
    quint64 fired = 0, missed = 0, failedActions = 0;
    Jitter jitter;
    std::optional<FiringMessage> last;
    QString problem;
    WatchedState watched;
};

Fields<Jitter> fieldsOf(Of<Jitter>);
Fields<FiringLog::State> fieldsOf(Of<FiringLog::State>);
Fields<FiringMessage> fieldsOf(Of<FiringMessage>);
Fields<TriggerState> fieldsOf(Of<TriggerState>);

} // namespace hermes::softwaretrigger
