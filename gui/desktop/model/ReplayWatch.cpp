#include "gui/desktop/model/ReplayWatch.h"

#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"

namespace hermes::desktop {
namespace {

constexpr int maxNames = 3;
constexpr std::chrono::milliseconds period{250};
constexpr std::size_t othersTurns = 8;      // of the period, between two questions to a robot not chosen
constexpr std::size_t maxOthersAtOnce = 50; // robots; of more than 400 each is asked less often

QString textOf(const QString &daemon, const QJsonValue &source) {
    QString text = ReplayWatch::tr("%1 replays %2")
                       .arg(daemon, shortLine(source["name"].toString().section('/', -1), longestName));
    if (source["paused"].toBool())
        text += ReplayWatch::tr(", paused");
    if (source["position_s"].isDouble())
        text += ReplayWatch::tr(" at %1").arg(durationText(source["position_s"].toDouble()));
    if (source["duration_s"].isDouble())
        text += ReplayWatch::tr(" of %1").arg(durationText(source["duration_s"].toDouble()));
    return text;
}

QString listed(const QStringList &names) {
    const int more = names.size() - maxNames;
    const QString first = names.mid(0, maxNames).join(", ");
    return more > 0 ? ReplayWatch::tr("%1 and %2 more").arg(first).arg(more) : first;
}

} // namespace

ReplayWatch::ReplayWatch(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&timer_, &QTimer::timeout, this, &ReplayWatch::ask);
    connect(&fleet, &Fleet::robotChosen, this, [this](const Robot *robot) {
        if (robot)
            askAll(*robot);
        tell();
    });
    connect(&fleet, &Fleet::robotGone, this, [this](const Robot *robot) {
        const auto daemons = robot->daemons();
        if (player_ && std::any_of(daemons.begin(), daemons.end(),
                                   [this](DaemonLink *daemon) { return player_->plays(daemon->client()); }))
            Q_EMIT lost(fleet_.titleOf(*robot));
    });
    timer_.start(period);
}

void ReplayWatch::ask() {
    if (fleet_.robot())
        askAll(*fleet_.robot());
    const auto &robots = fleet_.robots();
    const std::size_t turns = std::max(othersTurns, robots.size() / maxOthersAtOnce + 1);
    turn_ = (turn_ + 1) % turns;
    for (std::size_t i = turn_; i < robots.size(); i += turns)
        if (robots[i].get() != fleet_.robot())
            askAll(*robots[i]);
    tell();
}

void ReplayWatch::askAll(const Robot &robot) {
    for (DaemonLink *daemon : robot.daemons()) {
        if (!daemon->isConnected() || !daemon->hasMethod("source.status")) {
            forget(daemon); // who is gone replays no more
            continue;
        }
        connect(daemon, &QObject::destroyed, this, &ReplayWatch::forget, Qt::UniqueConnection);
        if (!std::exchange(sources_[daemon].isAsked, true))
            daemon->call(
                "source.status", {}, this,
                [this, daemon, name = daemon->name()](const auto &answer) { take(daemon, name, answer); });
    }
}

void ReplayWatch::take(DaemonLink *daemon, const QString &name, const Result<QJsonValue> &answer) {
    const auto found = sources_.find(daemon);
    if (found == sources_.end()) // it went meanwhile
        return;
    found->isAsked = false;
    if (!answer)
        return;
    const QJsonValue source = answer->toObject().contains("source") ? (*answer)["source"] : *answer;
    if (player_)
        player_->note(daemon->client(), source);
    found->replay = isReplay(source) ? textOf(name, source) : QString();
    tell();
}

void ReplayWatch::tell() {
    QStringList all;
    if (fleet_.robot())
        for (const DaemonLink *daemon : fleet_.robot()->daemons())
            if (const QString replay = replayOf(daemon); !replay.isEmpty())
                all.append(replay);
    const QString text = all.join("; ");
    if (std::exchange(text_, text) != text)
        Q_EMIT changed();
}

void ReplayWatch::endAll() const {
    if (!fleet_.robot())
        return;
    for (DaemonLink *daemon : fleet_.robot()->daemons())
        if (!replayOf(daemon).isEmpty())
            daemon->client().call("source.open", QJsonObject{{"live", true}}, [](const auto &) {});
}

bool ReplayWatch::isReplaying(const Robot &robot) const {
    const auto daemons = robot.daemons();
    return std::any_of(daemons.begin(), daemons.end(),
                       [this](const DaemonLink *daemon) { return !replayOf(daemon).isEmpty(); });
}

bool ReplayWatch::isOwn(const Robot &robot) const {
    const auto daemons = robot.daemons();
    return player_ && std::any_of(daemons.begin(), daemons.end(), [this](DaemonLink *daemon) {
               return daemon->isConnected() && player_->plays(daemon->client());
           });
}

QString ReplayWatch::whenClosed() const {
    QStringList own, others, lines;
    for (const auto &robot : fleet_.robots())
        if (isOwn(*robot))
            own.append(fleet_.titleOf(*robot));
        else if (isReplaying(*robot))
            others.append(fleet_.titleOf(*robot));
    if (!own.isEmpty())
        lines.append(tr("%1 still shows a recording; closing ends that replay.").arg(listed(own)));
    if (!others.isEmpty())
        lines.append(tr("What others replay goes on: %1.").arg(listed(others)));
    return lines.join(' ');
}

void ReplayWatch::endOwn() const {
    if (player_)
        player_->endAtOnce();
}

} // namespace hermes::desktop
