#include "gui/desktop/model/ReplayWatch.h"

#include "gui/desktop/widgets/ForeignText.h"

namespace hermes::desktop {
namespace {

constexpr int longestName = 60;

} // namespace

ReplayWatch::ReplayWatch(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&timer_, &QTimer::timeout, this, &ReplayWatch::ask);
    connect(&fleet, &Fleet::robotChosen, this, [this] {
        replays_.clear();
        Q_EMIT changed();
    });
    timer_.start(std::chrono::milliseconds(250));
}

void ReplayWatch::ask() {
    if (!fleet_.robot())
        return;
    std::map<QString, QString> there;
    for (DaemonLink *daemon : fleet_.robot()->allWithMethod("source.status")) {
        if (const auto known = replays_.find(daemon->address()); known != replays_.end())
            there.insert(*known);
        if (asked_.contains(daemon))
            continue;
        asked_.insert(daemon);
        daemon->call("source.status", {}, this, [this, daemon](const auto &answer) { take(daemon, answer); });
    }
    if (std::exchange(replays_, there) != there) // who is gone replays no more
        Q_EMIT changed();
}

void ReplayWatch::take(DaemonLink *daemon, const Result<QJsonValue> &answer) {
    asked_.remove(daemon);
    if (!fleet_.robot() || fleet_.robot()->withName(daemon->name()) != daemon || !answer)
        return;
    const QJsonValue source = answer->toObject().contains("source") ? (*answer)["source"] : *answer;
    const auto before = replays_;
    if (source["state"] == QJsonValue("replay")) {
        QString text =
            tr("%1 replays %2")
                .arg(daemon->name(), shortLine(source["name"].toString().section('/', -1), longestName));
        if (source["paused"].toBool())
            text += tr(", paused");
        if (source["position_s"].isDouble())
            text += tr(" at %1").arg(shortNumber(source["position_s"].toDouble(), 0));
        if (source["duration_s"].isDouble())
            text += tr(" of %1 s").arg(shortNumber(source["duration_s"].toDouble(), 0));
        else if (source["position_s"].isDouble())
            text += tr(" s");
        replays_[daemon->address()] = text;
    } else {
        replays_.erase(daemon->address());
    }
    if (replays_ != before)
        Q_EMIT changed();
}

QString ReplayWatch::text() const {
    QStringList all;
    for (const auto &[address, text] : replays_)
        all.append(text);
    return all.join("; ");
}

} // namespace hermes::desktop
