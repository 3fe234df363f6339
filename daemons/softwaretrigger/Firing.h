#pragma once

#include "common/Result.h"
#include "daemons/softwaretrigger/Watch.h"

#include <functional>
#include <vector>

namespace hermes::softwaretrigger {

/// One firing of a trigger, from its begin to the end of its last action.
struct Firing {
    struct ActionResult {
        QString action;
        bool ended = false;
        double duration_s = 0;
        Result<QJsonValue> result{QJsonValue()};
    };

    QString id;
    quint64 seq = 0;
    Occasion occasion;
    double stamp = 0, mono = 0; ///< when its actions began
    std::vector<ActionResult> results;
    std::function<void(const FiringMessage &)> ended; ///< who waits for it

    /// How long its actions began after the time that it fires for; 0 where there is none (a command).
    double late_s() const;
    bool isOver() const;
    int failures() const;
    FiringMessage message() const;
    /// A row of the log for each action; one for a firing without actions.
    QByteArray csvRows() const;
    static QByteArray csvHeader();
};

} // namespace hermes::softwaretrigger
