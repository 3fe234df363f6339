#include "gui/desktop/model/MacroRunner.h"

#include "gui/desktop/widgets/ForeignText.h"

namespace hermes::desktop {

MacroRunner::MacroRunner(Fleet &fleet, DriveControl &drive, QObject *parent)
    : QObject(parent)
    , fleet_(fleet)
    , drive_(drive)
    , stops_(fleet) {
    pause_.setSingleShot(true);
    connect(&pause_, &QTimer::timeout, this, &MacroRunner::next);
    connect(&stops_, &LatchWatch::stopped, this, &MacroRunner::end);
    connect(&drive, &DriveControl::stopPressed, this, [this] { end(tr("STOP")); });
    connect(&fleet, &Fleet::robotChosen, this, [this] { // whom the STOP button is not for any more
        end(tr("another robot was chosen"));
        wasStopped_ = drive_.isStopped();
    });
    connect(&drive, &DriveControl::changed, this, [this] {
        const bool was = std::exchange(wasStopped_, drive_.isStopped());
        if (wasStopped_ && !was)
            end(tr("STOP"));
    });
}

QString MacroRunner::away(const Macro &macro) const {
    for (const MacroStep &step : macro.steps)
        if (const DaemonLink *const daemon = step.target(fleet_); !daemon || !daemon->isConnected())
            return step.daemon;
    return {};
}

QString MacroRunner::hindrance(const Macro &macro) const {
    for (const MacroStep &step : macro.steps) {
        const DaemonLink *const daemon = step.target(fleet_);
        if (!daemon || !daemon->isConnected())
            return tr("%1 of %2 is away").arg(step.daemon, step.robot);
        if (!daemon->hasMethod(step.method))
            return tr("%1 has no %2").arg(step.daemon, step.method);
        if (const QString why = daemon->refusal(step.method); !why.isEmpty())
            return why;
    }
    return {};
}

QStringList MacroRunner::destroys(const Macro &macro) const {
    QStringList all;
    for (const MacroStep &step : macro.steps)
        if (const DaemonLink *const daemon = step.target(fleet_))
            if (const QString lost = daemon->method(step.method)["x-destructive"].toString();
                !lost.isEmpty() && !all.contains(lost))
                all.append(shortLine(lost));
    return all;
}

void MacroRunner::run(const Macro &macro) {
    if (isRunning() || !hindrance(macro).isEmpty())
        return;
    macro_ = macro;
    step_ = 0;
    isSent_ = false;
    QSet<QString> robots;
    for (const MacroStep &step : macro.steps)
        robots.insert(step.robot);
    stops_.begin(robots);
    next();
}

QString MacroRunner::place() const {
    const QString title = shortLine(macro_.steps[step_].title(), 80);
    return macro_.steps.size() == 1
               ? title
               : tr("step %1 of %2, %3").arg(step_ + 1).arg(macro_.steps.size()).arg(title);
}

QString MacroRunner::where() const {
    return isSent_ ? tr("at %1").arg(place()) : tr("before %1").arg(place());
}

// No command goes out behind a stop that is not known here as yet: it could be the one that releases it.
void MacroRunner::next() {
    text_ = tr("%1: %2").arg(macro_.name, place());
    hasFailed_ = false;
    Q_EMIT changed();
    stops_.look([this, turn = ++turn_] {
        if (turn == turn_ && isRunning())
            send();
    });
}

void MacroRunner::send() {
    const MacroStep &step = macro_.steps[step_];
    DaemonLink *const daemon = step.target(fleet_);
    if (!daemon || !daemon->isConnected())
        return finish(tr("%1 ended %2: %3 is away").arg(macro_.name, where(), step.daemon), true);
    isSent_ = true;
    const auto answered = [this, turn = ++turn_](const Result<QJsonValue> &result) {
        if (turn == turn_ && isRunning())
            onAnswer(result);
    };
    if (daemon->method(step.method)["x-needs-lease"].toBool())
        daemon->call(step.method, step.params, this, answered, Client::Repeats::None); // a late one moves it
    else
        daemon->callForMuch(step.method, step.params, this, answered);
}

void MacroRunner::onAnswer(const Result<QJsonValue> &result) {
    if (!result)
        return finish(tr("%1 ended %2: %3").arg(macro_.name, where(), shortLine(result.error().message)),
                      true);
    const double pause_s = macro_.steps[step_].pause_s;
    isSent_ = false;
    if (++step_ == macro_.steps.size())
        return finish(tr("%1: done").arg(macro_.name), false);
    pause_.start(int(pause_s * 1000));
    if (pause_s == 0)
        return;
    text_ = tr("%1: waits %2 s before %3").arg(macro_.name, QString::number(pause_s), place());
    Q_EMIT changed();
}

void MacroRunner::end(const QString &why) {
    if (isRunning())
        finish(tr("%1 ended %2: %3").arg(macro_.name, where(), why), true);
}

void MacroRunner::finish(const QString &text, bool hasFailed) {
    pause_.stop();
    stops_.end();
    ++turn_;
    macro_ = {};
    step_ = 0;
    isSent_ = false;
    text_ = text;
    hasFailed_ = hasFailed;
    Q_EMIT changed();
}

} // namespace hermes::desktop
