#pragma once

#include "common/daemon/Command.h"
#include "common/settings/Settings.h"
#include "daemons/supervisor/DeviceSearch.h"
#include "daemons/supervisor/SettingsFiles.h"
#include "daemons/supervisor/SupervisedProcess.h"

#include <QDeadlineTimer>
#include <QPointer>
#include <optional>

namespace hermes::supervisor {

/// The first contact with a robot: finds what is plugged in, proposes settings for it, and writes them when
/// the daemons would take them. Its commands are `setup.*`.
class Setup : public QObject {
    Q_OBJECT
public:
    using Processes = std::function<std::vector<SupervisedProcess *>()>;

    /// settings: the supervisor's own, to which it adds its own; processes: those of now.
    Setup(Settings &settings, Processes processes, QObject *parent);

    std::vector<Command> commands();
    /// What is wrong with the settings files; nothing: empty.
    QString problem() const { return files().problem(); }

private:
    struct Released {
        QPointer<SupervisedProcess> process;
        int orders; ///< that it had then: with another one since it is somebody else's to start
    };
    using Stopped = std::vector<Released>;

    Command findCommand();
    Command proposeCommand();
    Command applyCommand();
    Command undoCommand();

    SettingsFiles files() const;
    static Error busy(const char *what);
    DeviceSearch::Options searchOptions(bool ask) const;
    /// Ends those that use serial lines or receive packets of lidars, or are about to.
    Stopped release();
    /// Waits for those that end, until a deadline.
    void searchWhenStopped(const Stopped &stopped, QDeadlineTimer deadline, bool ask, const Reply &reply);
    void onFound(Findings findings, const Stopped &stopped, const Reply &reply);
    /// Those that nobody else has told something meanwhile; gives their names.
    static QStringList startAgain(const Stopped &stopped);
    /// Tells what is the simulator's.
    void markSimulated(Findings &findings) const;
    /// The settings, by daemons, of a sample or of now with these changes.
    Result<QJsonObject> whole(const QString &sample, const QJsonObject &changes) const;
    Result<Proposal> proposal(const QString &sample) const;
    /// The daemons whose settings file is in the command line of a process.
    QStringList filesOf(const QJsonArray &processes) const;
    /// Writes what of that is new, and takes it. Error: what was checked is no longer what is meant.
    Result<Applied> write(const QString &sample, const QJsonObject &changes, const QJsonObject &checked);
    /// Takes what was written: the supervisor its own settings; the others are started anew, if they ran or
    /// start with it. What starts with the supervisor by these settings only is started, too.
    Result<Applied> take(const QStringList &written, const QStringList &notes);

    Settings &settings_;
    const Processes processes_;
    DeviceSearch search_;
    bool isSearching_ = false; // or ends processes for it
    bool isWriting_ = false;
    std::optional<Findings> found_;
};

} // namespace hermes::supervisor
