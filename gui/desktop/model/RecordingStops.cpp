#include "gui/desktop/model/RecordingStops.h"

#include <algorithm>

namespace hermes::desktop {

RecordingStops::RecordingStops(Fleet &fleet, const LoggerWatch &watch, QObject *parent)
    : QObject(parent)
    , fleet_(fleet)
    , watch_(watch) {}

RecordingStop *RecordingStops::of(const Robot *robot) const {
    for (RecordingStop *const stop : stops_)
        if (stop->isOf(robot))
            return stop;
    return nullptr;
}

void RecordingStops::begin() {
    if (!fleet_.robot())
        return;
    RecordingStop *const known = chosen();
    (known ? known : add(*fleet_.robot()))->begin(watch_);
}

void RecordingStops::expect(const QString &session, const std::vector<SessionMember> &loggers) {
    for (const SessionMember &logger : loggers)
        for (const auto &robot : fleet_.robots())
            for (DaemonLink *const daemon : robot->daemons())
                if (&daemon->client() == logger.client) {
                    RecordingStop *const known = of(robot.get());
                    (known ? known : add(*robot))->expect(session, daemon->address(), logger);
                }
}

QStringList RecordingStops::silentElsewhere() const {
    QStringList lines;
    for (const RecordingStop *const stop : stops_)
        if (!stop->isOf(fleet_.robot()))
            for (const QString &logger : stop->silent())
                lines.append(
                    tr("%1: %2 does not answer, and may go on recording.").arg(stop->title(), logger));
    return lines;
}

RecordingStop *RecordingStops::add(const Robot &robot) {
    auto *const stop = new RecordingStop(fleet_, fleet_.titleOf(robot), this);
    stops_.push_back(stop);
    connect(stop, &RecordingStop::changed, this, &RecordingStops::changed);
    connect(stop, &RecordingStop::ended, this,
            [this, stop](const QStringList &problems) { tell(*stop, problems); });
    connect(stop, &RecordingStop::removed, this, [this, stop](bool doubt) {
        drop(stop);
        if (doubt)
            Q_EMIT ended(
                tr("%1 was removed before its recording had ended: it may still record.").arg(stop->title()),
                true, false);
    });
    return stop;
}

void RecordingStops::drop(RecordingStop *stop) {
    stops_.erase(std::remove(stops_.begin(), stops_.end(), stop), stops_.end());
    stop->disconnect(this);
    stop->deleteLater();
}

/// With the name of the robot where it is not the chosen one.
void RecordingStops::tell(const RecordingStop &stop, const QStringList &problems) {
    const bool isChosen = stop.isOf(fleet_.robot());
    const QString text = problems.isEmpty() ? tr("Stopped, nothing missing.") : problems.join('\n');
    Q_EMIT ended(isChosen ? text : tr("%1: %2").arg(stop.title(), text), !problems.isEmpty(), isChosen);
}

} // namespace hermes::desktop
