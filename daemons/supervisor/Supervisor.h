#pragma once

#include "common/daemon/Daemon.h"
#include "daemons/supervisor/Setup.h"
#include "daemons/supervisor/SupervisedProcess.h"

#include <memory>
#include <vector>

namespace hermes::supervisor {

/// Starts and watches the daemons of one host: those of its setting `processes`, in that order; ends all of
/// them at once.
class Supervisor : public Daemon {
    Q_OBJECT
public:
    Supervisor();

protected:
    Result<void> start() override;
    void stop() override;
    void settingsChanged(const QStringList &paths) override;

private:
    void declareSettings();
    void declareCommands();
    Command processCommand(const QString &name, const QString &summary, void (SupervisedProcess::*action)());
    /// Makes the processes those of the settings: what is new is added, what was changed is restarted with
    /// its new entry, what is missing is ended.
    void reconcile();
    SupervisedProcess *find(const QString &name) const;
    Result<void> add(const Call &call);
    Result<void> remove(const QString &name);
    Result<void> setEntries(const QJsonArray &entries);
    void dismiss(std::unique_ptr<SupervisedProcess> process);
    /// Says to itself and to those that it starts of which robot they are.
    void tellRobot();
    ProcessesMessage list();
    void update();

    std::shared_ptr<ProcessGuard> guard_;
    std::vector<std::unique_ptr<SupervisedProcess>> processes_;
    std::optional<RobotIdentity> robot_; ///< as it is where the settings do not name it
    QTimer timer_;
    std::unique_ptr<Setup> setup_;
};

} // namespace hermes::supervisor
