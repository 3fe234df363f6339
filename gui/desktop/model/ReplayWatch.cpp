#include "gui/desktop/model/ReplayWatch.h"

#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"

namespace hermes::desktop {
namespace {

constexpr int longestName = 60;

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

} // namespace

ReplayWatch::ReplayWatch(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&timer_, &QTimer::timeout, this, &ReplayWatch::ask);
    connect(&fleet, &Fleet::robotChosen, this, [this] {
        replays_.clear();
        asked_.clear();
        Q_EMIT changed();
    });
    timer_.start(std::chrono::milliseconds(250));
}

void ReplayWatch::ask() {
    if (!fleet_.robot())
        return;
    std::map<QString, QString> there;
    QSet<QString> asked;
    for (DaemonLink *daemon : fleet_.robot()->allWithMethod("source.status")) {
        const QString address = daemon->address();
        if (const auto known = replays_.find(address); known != replays_.end())
            there.insert(*known);
        asked.insert(address);
        if (asked_.contains(address))
            continue;
        daemon->call("source.status", {}, this, [this, address, name = daemon->name()](const auto &answer) {
            take(address, name, answer);
        });
    }
    asked_ = asked;
    if (std::exchange(replays_, there) != there) // who is gone replays no more
        Q_EMIT changed();
}

void ReplayWatch::take(const QString &address, const QString &name, const Result<QJsonValue> &answer) {
    if (!asked_.remove(address) || !answer) // another robot was chosen meanwhile, or it went
        return;
    const QJsonValue source = answer->toObject().contains("source") ? (*answer)["source"] : *answer;
    const auto before = replays_;
    const QString state = source["state"].toString();
    if (state == "replay" || state == "ended") // at its end it still shows what was
        replays_[address] = textOf(name, source);
    else
        replays_.erase(address);
    if (replays_ != before)
        Q_EMIT changed();
}

void ReplayWatch::endAll() const {
    if (!fleet_.robot())
        return;
    for (DaemonLink *daemon : fleet_.robot()->daemons())
        if (replays_.count(daemon->address()) > 0)
            daemon->client().call("source.open", QJsonObject{{"live", true}}, [](const auto &) {});
}

QString ReplayWatch::text() const {
    QStringList all;
    for (const auto &[address, text] : replays_)
        all.append(text);
    return all.join("; ");
}

} // namespace hermes::desktop
