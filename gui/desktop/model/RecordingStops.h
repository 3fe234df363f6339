#pragma once

#include "gui/desktop/model/RecordingStop.h"

namespace hermes::desktop {

/// Those of all robots, and what of them is to be told while any robot is chosen.
class RecordingStops : public QObject {
    Q_OBJECT
public:
    RecordingStops(Fleet &fleet, const LoggerWatch &watch, QObject *parent = nullptr);

    /// Ends what the chosen robot records.
    void begin();
    /// Ends that session, in silence, at each of these loggers that has begun it all the same.
    void expect(const QString &session, const std::vector<SessionMember> &loggers);
    /// Of the chosen robot; null: none.
    RecordingStop *chosen() const { return of(fleet_.robot()); }
    /// A line for each logger of the other robots that does not answer.
    QStringList silentElsewhere() const;

Q_SIGNALS:
    void changed();
    /// How one ended; isChosen: of the chosen robot.
    void ended(const QString &text, bool isError, bool isChosen);

private:
    RecordingStop *of(const Robot *robot) const;
    RecordingStop *add(const Robot &robot);
    void drop(RecordingStop *stop);
    void tell(const RecordingStop &stop, const QStringList &problems);

    Fleet &fleet_;
    const LoggerWatch &watch_;
    std::vector<RecordingStop *> stops_; ///< its children
};

} // namespace hermes::desktop
