#pragma once

#include "daemons/softwaretrigger/ActionRunner.h"
#include "daemons/softwaretrigger/FiringLog.h"

#include "common/daemon/PastFaults.h"

#include <map>
#include <memory>
#include <set>

namespace hermes::softwaretrigger {

/// A health item as the engine reports it.
struct EngineHealth {
    HealthLevel level = HealthLevel::Ok;
    QString message;
    QJsonObject values;
};

/// Watches, fires and acts, in a thread of its own that runs before all ordinary ones where it may, so that
/// clients of the daemon delay nothing. All functions must be called in that thread.
class TriggerEngine : public QObject {
    Q_OBJECT
public:
    using Ended = std::function<void(const FiringMessage &)>;

    /// Of the log of all firings; no folder: none.
    TriggerEngine(const QString &folder, double fileBytes);

    void start();
    /// Ends all; what is under way has failed, and the log says so.
    void stop();

    /// Brings what runs in line with the definitions; what did not change keeps its schedule.
    void apply(const std::vector<TriggerDefinition> &definitions);
    /// Fires an armed trigger; ended gets the firing when its last action has ended.
    Result<void> fireNow(const QString &id, const QString &client, const Ended &ended);

    /// By id.
    std::map<QString, TriggerState> state() const;
    static QStringList healthItems();
    EngineHealth health(const QString &item);

Q_SIGNALS:
    /// The last action of a firing has ended.
    void fired(const hermes::softwaretrigger::FiringMessage &firing);

private:
    struct Trigger {
        TriggerDefinition definition;
        std::unique_ptr<Watch> watch; ///< while armed, for causes that are watched
        quint64 seq = 0, missed = 0, failedActions = 0;
        JitterWindow jitter;
        std::optional<FiringMessage> last;
    };

    void watch(Trigger &trigger);
    void fire(Trigger &trigger, const Occasion &occasion, const Ended &ended = {});
    void beginAction(const std::shared_ptr<Firing> &firing, size_t index, const ActionDefinition &action);
    void endIfOver(const std::shared_ptr<Firing> &firing);
    void fireFollowers(const Firing &firing);
    EngineHealth scheduleHealth();
    EngineHealth targetHealth() const;
    EngineHealth lineHealth() const;
    EngineHealth actionHealth();
    EngineHealth logHealth();

    FiringLog log_;
    std::unique_ptr<Schedule> schedule_;
    std::unique_ptr<ActionRunner> runner_;
    std::map<QString, Trigger> triggers_;
    std::set<std::shared_ptr<Firing>> underWay_;
    JitterWindow jitter_; ///< of all by period
    bool realtime_ = false;
    QString lastFailure_;
    quint64 failedActions_ = 0;
    PastFaults pastMissed_, pastLost_, pastFailures_;
};

} // namespace hermes::softwaretrigger
