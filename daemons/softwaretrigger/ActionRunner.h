#pragma once

#include "common/Result.h"
#include "daemons/softwaretrigger/Definition.h"
#include "daemons/softwaretrigger/GpioLines.h"
#include "daemons/softwaretrigger/SerialLines.h"
#include "daemons/softwaretrigger/Targets.h"
#include "daemons/softwaretrigger/Watch.h"

#include <algorithm>
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
    double late_s() const {
        if (occasion.dueMono)
            return mono - *occasion.dueMono;
        return occasion.dueStamp ? stamp - *occasion.dueStamp : 0;
    }
    bool isOver() const {
        return std::all_of(results.begin(), results.end(), [](const auto &one) { return one.ended; });
    }
    int failures() const {
        return int(
            std::count_if(results.begin(), results.end(), [](const auto &one) { return !one.result; }));
    }
    FiringMessage message() const;
    /// A row of the log for each action; one for a firing without actions.
    QByteArray csvRows() const;
    static QByteArray csvHeader() {
        return "stamp,mono,id,seq,cause,jitter_s,missed,action,ok,duration_s,error\n";
    }
};

/// Does what triggers do. No action waits for another.
class ActionRunner : public QObject {
    Q_OBJECT
public:
    using Done = std::function<void(const Result<QJsonValue> &)>;

    explicit ActionRunner(QObject *parent)
        : QObject(parent)
        , serialLines_(this)
        , pulses_(this) {}

    /// Connects to the daemons and opens the lines that these name, and ends what they do not name.
    void use(const std::vector<TriggerDefinition> &definitions);
    /// done is called once, within the time that the action allows.
    void run(const ActionDefinition &action, const Done &done);

    Targets &targets() { return targets_; }
    const Targets &targets() const { return targets_; }
    const SerialLines &serialLines() const { return serialLines_; }

private:
    Targets targets_;
    SerialLines serialLines_;
    GpioLines gpioLines_;
    Pulses pulses_;
};

} // namespace hermes::softwaretrigger
