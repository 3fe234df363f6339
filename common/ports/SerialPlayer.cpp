#include "common/ports/SerialPlayer.h"

#include <QJsonArray>
#include <QRegularExpression>

#include <algorithm>

namespace hermes {

namespace {

constexpr double slack_s = 60;
constexpr double farthest_s = 4e9; // of a clock
constexpr std::chrono::milliseconds roomPeriod{5};

} // namespace

Result<void> SerialPlayer::start(const StoredRecording &recording, const Playback::Options &options,
                                 double delay_s, const QueueOf &queueOf, Filled filled, End end) {
    stop();
    delay_s_ = delay_s;
    startMono_s_ = recording.sidecar.value("start_mono").toDouble();
    length_s_ = recording.length_s;
    filled_ = std::move(filled);
    end_ = std::move(end);
    const Result<QStringList> files = recording.files();
    if (!files)
        return files.error();
    missing_ = recording.isWhole();
    const QJsonArray entries = recording.sidecar.value("files").toArray();
    for (int i = 0; i < entries.size(); ++i) {
        const QString port = entries[i].toObject().value("port").toString();
        ChunkQueue *const queue = queueOf(port, recording.sidecar);
        const Result<void> added = queue ? addTrack(files->at(i), queue) : Result<void>();
        if (!added) {
            tracks_.clear();
            return added;
        }
    }
    playback_.start(options, [this] { run(); });
    return {};
}

Result<void> SerialPlayer::addTrack(const QString &path, ChunkQueue *queue) {
    auto track = std::make_unique<Track>();
    track->queue = queue;
    Result<void> result = track->reader.open(QString(path).remove(QRegularExpression("\\.raw$")));
    if (result)
        result = advance(*track);
    tracks_.push_back(std::move(track));
    return result;
}

/// A clock that goes back within the index counts as none.
Result<void> SerialPlayer::advance(Track &track) {
    Result<SerialLogReader::Piece> piece = track.reader.next();
    if (!piece)
        return piece.error();
    track.piece = piece.take();
    const double time_s = delay_s_ + track.piece.arrival.mono() - startMono_s_;
    const double most_s =
        delay_s_ + 2 * length_s_ + slack_s; // whatever the index says: the clocks may differ
    track.time_ns = std::max(track.time_ns, std::int64_t(std::clamp(time_s, 0.0, most_s) * 1e9));
    return {};
}

ReplaySource::Actions SerialPlayer::actions(const std::function<void()> &live,
                                            decltype(ReplaySource::Actions::recording) recording,
                                            std::function<void()> changed) const {
    const auto openLive = [live](const Call &) -> Result<void> {
        live();
        return {};
    };
    const auto duration = [this] { return std::optional<double>(duration_s()); };
    return {openLive, std::move(recording), {}, duration, {}, std::move(changed)};
}

void SerialPlayer::stop() {
    playback_.stop();
    tracks_.clear();
}

SerialPlayer::Track *SerialPlayer::nextTrack() const {
    Track *next = nullptr;
    for (const auto &track : tracks_)
        if (!track->piece.bytes.isEmpty() && (!next || track->time_ns < next->time_ns))
            next = track.get();
    return next;
}

void SerialPlayer::run() {
    for (;;) {
        Track *const track = nextTrack();
        const Playback::Turn turn = track ? wait(*track) : playback_.waitToEnd();
        if (turn == Playback::Turn::End)
            return;
        if (!track && turn == Playback::Turn::Due)
            return end_(missing_);
        const Result<void> done = turn == Playback::Turn::Seek ? goTo(playback_.takeSeek()) : play(*track);
        if (!done)
            return end_(done);
    }
}

/// Until the piece is due and there is room for it.
Playback::Turn SerialPlayer::wait(const Track &track) {
    for (;;) {
        const Playback::Turn turn = playback_.waitFor(track.time_ns);
        if (turn != Playback::Turn::Due || track.queue->hasRoom(std::size_t(track.piece.bytes.size())))
            return turn;
        if (!playback_.rest(roomPeriod))
            return Playback::Turn::End;
    }
}

Result<void> SerialPlayer::play(Track &track) {
    const QByteArray &bytes = track.piece.bytes;
    track.queue->push(bytes.constData(), std::size_t(bytes.size()), track.piece.arrival);
    filled_();
    return advance(track);
}

Result<void> SerialPlayer::goTo(std::int64_t time_ns) {
    const double begin_s =
        std::clamp(startMono_s_ - delay_s_, -farthest_s, farthest_s); // whatever the sidecar says
    playback_.jump(time_ns);
    for (const auto &track : tracks_) {
        track->queue->jump();
        track->time_ns = 0;
        Result<void> found = track->reader.seek(time_ns + std::int64_t(begin_s * 1e9));
        if (found)
            found = advance(*track);
        if (!found)
            return found;
    }
    return {};
}

} // namespace hermes
