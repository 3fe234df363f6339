#include "gui/desktop/model/SessionPlayer.h"

#include <QJsonArray>

namespace hermes {

SessionPlayer::SessionPlayer(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&timer_, &QTimer::timeout, this, &SessionPlayer::poll);
    timer_.setInterval(500);
}

void SessionPlayer::play(const QJsonObject &session, double speed) {
    live();
    for (const QJsonValue &part : session["parts"].toArray()) {
        const QString logger = part["logger"].toString();
        DaemonLink *const daemon = fleet_.robot() ? fleet_.robot()->withName(logger) : nullptr;
        if (!daemon || !daemon->hasMethod("source.open"))
            continue;
        tracks_.push_back({daemon, part["start"].toDouble() - session["start"].toDouble()});
    }
    if (tracks_.empty())
        return Q_EMIT told(tr("No logger of this robot can replay %1.").arg(session["name"].toString()),
                           true);
    for (Track &track : tracks_)
        open(track, session["name"].toString(), speed);
    timer_.start();
    Q_EMIT told(tr("Replaying %1.").arg(session["name"].toString()), false);
    Q_EMIT changed();
}

void SessionPlayer::open(Track &track, const QString &recording, double speed) {
    DaemonLink *const daemon = track.daemon;
    track.isOpening = true;
    daemon->call("source.open", {{"recording", recording}, {"speed", speed}, {"delay_s", track.delay_s}},
                 this, [this, daemon](const Result<QJsonValue> &r) {
                     Track *const opened = trackOf(daemon);
                     if (!opened)
                         return;
                     opened->isOpening = false;
                     if (r)
                         return;
                     Q_EMIT told(daemon->name() + ": " + r.error().message, true);
                     finish(daemon);
                 });
}

void SessionPlayer::poll() {
    for (const Track &track : tracks_)
        if (DaemonLink *const daemon = track.daemon; daemon && !track.isOpening)
            daemon->call("source.status", {}, this, [this, daemon](const Result<QJsonValue> &status) {
                if (status)
                    onStatus(daemon, status->toObject());
            });
}

void SessionPlayer::onStatus(DaemonLink *daemon, const QJsonObject &status) {
    const Track *const track = trackOf(daemon);
    const QString state = status["source"].toObject()["state"].toString();
    if (track && !track->isOpening && state == "ended")
        finish(daemon);
}

void SessionPlayer::finish(DaemonLink *daemon) {
    if (daemon)
        daemon->call("source.open", {{"live", true}}, this, [](const Result<QJsonValue> &) {});
    tracks_.erase(
        std::remove_if(tracks_.begin(), tracks_.end(), [&](const Track &t) { return t.daemon == daemon; }),
        tracks_.end());
    if (!tracks_.empty())
        return;
    timer_.stop();
    Q_EMIT told(tr("The replay has ended; everything is live."), false);
    Q_EMIT changed();
}

void SessionPlayer::live() {
    while (!tracks_.empty())
        finish(tracks_.back().daemon);
}

SessionPlayer::Track *SessionPlayer::trackOf(DaemonLink *daemon) {
    for (Track &track : tracks_)
        if (track.daemon == daemon)
            return &track;
    return nullptr;
}

} // namespace hermes
