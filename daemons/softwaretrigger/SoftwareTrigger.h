#pragma once

#include "common/daemon/Daemon.h"
#include "daemons/softwaretrigger/TriggerEngine.h"

#include <QThread>

namespace hermes::softwaretrigger {

/// Fires triggers, each of which does its actions: by period, way, time of day, a condition on a topic, the
/// firing of another, or by command. The definitions are the setting `triggers`.
class SoftwareTrigger : public Daemon {
    Q_OBJECT
public:
    SoftwareTrigger();
    ~SoftwareTrigger() override;

protected:
    Result<void> start() override;
    void stop() override;
    void settingsChanged(const QStringList &paths) override;

private:
    void declareSettings();
    void declareCommands();
    void provideHealth();

    // The commands.
    Result<QJsonValue> list();
    Result<QJsonValue> define(const QJsonObject &trigger);
    Result<void> remove(const QString &id);
    Result<void> setArmed(const QString &id, bool armed);
    void fireNow(const Call &call, const Reply &reply);
    Result<void> replaceTriggers(const QJsonArray &triggers, int edited);
    /// Of the definition in the settings; InvalidParams when there is none.
    Result<int> indexOf(const QString &id);

    /// Runs the function in the engine's thread, which never waits for anything, and waits for it.
    template <typename Function>
    void inEngine(Function function) {
        QMetaObject::invokeMethod(
            engine_, [this, &function] { function(*engine_); }, Qt::BlockingQueuedConnection);
    }

    QThread thread_;
    TriggerEngine *engine_ = nullptr; ///< lives in thread_, while running
};

} // namespace hermes::softwaretrigger
