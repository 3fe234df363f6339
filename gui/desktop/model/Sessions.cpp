#include "gui/desktop/model/Sessions.h"

#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"
#include "protocol/wire/Fields.h"

namespace hermes::desktop {
namespace {

constexpr std::chrono::minutes longestWait{2}; // everything is to get to the disks

} // namespace

Sessions::Sessions(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet)
    , feed_(
          fleet, "session", {{"max_rate_hz", 10}}, [this](const TopicUpdate &update) { take(update.data); },
          this) {
    connect(&feed_, &TopicFeed::sourceChanged, this, [this] {
        state_ = {};
        age_.forget();
        problem_.clear();
        orders_.clear();
        tell();
    });
    connect(&fleet, &Fleet::changed, this, &Sessions::tell); // who answers, and their health
    connect(&fleet, &Fleet::robotChosen, this, &Sessions::tell);
}

void Sessions::take(WireView told) {
    ReadReport report;
    auto state = readMessage<SessionState>(told, report);
    problem_ = state ? QString() : tr("The state of the recorder: %1").arg(shortLine(report.text()));
    if (state) {
        state_ = std::move(*state);
        age_.heard(recorder());
    }
    tell();
}

void Sessions::tell() {
    const QString text = replayText();
    if (std::exchange(replay_, text) != text)
        Q_EMIT replayChanged();
    Q_EMIT changed();
}

QString Sessions::replayText() const {
    if (state_.state == "replaying") {
        const SessionReplay replay = state_.replay.value_or(SessionReplay());
        QString text =
            tr("%1 at %2").arg(shortLine(state_.name, longestName), durationText(replay.position_s));
        if (replay.duration_s > 0)
            text = tr("%1 of %2").arg(text, durationText(replay.duration_s));
        return replay.paused ? tr("%1, paused").arg(text) : text;
    }
    if (fleet_.robot())
        for (const DaemonLink *daemon : fleet_.robot()->daemons())
            for (const HealthItem &item : daemon->status().health)
                if (daemon->isConnected() && item.name == "replay" && item.level != "ok")
                    return tr("%1: %2").arg(daemon->name(), shortLine(item.message));
    return {};
}

void Sessions::call(const QString &method, const QJsonObject &params, QObject *context,
                    const Client::Callback &done) {
    if (!recorder())
        return done(Error(ErrorCode::NotReady, tr("No recorder is connected.")));
    recorder()->client().call(
        method, params,
        [done, guard = QPointer<QObject>(context)](const Result<QJsonValue> &reply) {
            if (guard)
                done(reply);
        },
        longestWait);
}

void Sessions::order(const QString &method, const QJsonObject &params) {
    if (const auto waiting = orders_.find(method); waiting != orders_.end()) {
        *waiting = params;
        return;
    }
    orders_.insert(method, std::nullopt);
    call(method, params, this, [this, method](const Result<QJsonValue> &reply) {
        const auto next = orders_.take(method);
        if (!reply)
            Q_EMIT refused(reply.error().message);
        if (next)
            order(method, *next);
    });
}

} // namespace hermes::desktop
