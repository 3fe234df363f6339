#include "daemons/velodynelogger/PcapPlayer.h"

#include <utility>

namespace hermes::velodynelogger {

PcapPlayer::PcapPlayer(Sink sink, Jump jump, End end)
    : sink_(std::move(sink))
    , jump_(std::move(jump))
    , end_(std::move(end)) {}

PcapPlayer::~PcapPlayer() {
    stop();
}

Outcome<void> PcapPlayer::start(const std::vector<std::string> &paths, const Playback::Options &options,
                                const PlayTime &begin) {
    stop();
    if (const Outcome<void> opened = reader_.open(paths); !opened)
        return opened;
    time_ = begin_ = begin;
    atTarget_ = false;
    index_.start(paths, begin);
    playback_.start(options, [this] { run(); });
    return {};
}

void PcapPlayer::stop() {
    playback_.stop();
    index_.stop();
    reader_.close();
}

std::optional<double> PcapPlayer::duration_s() const {
    const auto duration_ns = index_.duration_ns();
    return duration_ns ? std::optional<double>(double(*duration_ns) * 1e-9) : std::nullopt;
}

void PcapPlayer::run() {
    bool played = false; // since the beginning of the file: an empty one is not looped
    for (;;) {
        Datagram datagram = target_;
        PcapReader::Next next = PcapReader::Next::Datagram;
        if (!std::exchange(atTarget_, false))
            next = reader_.next(datagram);
        if (next == PcapReader::Next::Datagram) {
            played = true;
            if (!play(datagram))
                return;
            continue;
        }
        if (next == PcapReader::Next::Failed)
            return end_(reader_.error());
        counts_ = reader_.counts();
        const Playback::Turn turn = playback_.waitToEnd();
        if (turn == Playback::Turn::End || (turn == Playback::Turn::Seek && !goTo(playback_.takeSeek())))
            return;
        if (turn == Playback::Turn::Seek)
            continue;
        if (!playback_.options().loop || !played)
            return end_({});
        played = false;
        if (!rewind({begin_, {}}))
            return;
        playback_.loop();
    }
}

/// False when playing is at its end.
bool PcapPlayer::play(const Datagram &datagram) {
    switch (playback_.waitFor(time_.advance(datagram))) {
    case Playback::Turn::Due:
        sink_(datagram);
        return true;
    case Playback::Turn::Seek:
        return goTo(playback_.takeSeek());
    case Playback::Turn::End:
        break;
    }
    return false;
}

bool PcapPlayer::goTo(std::int64_t time_ns) {
    PcapIndex::Mark mark = index_.before(time_ns);
    // Only what lies between here and there need be read.
    const bool ahead = time_ns > time_.now_ns() && mark.before.now_ns() <= time_.now_ns();
    if (ahead)
        jump_();
    else if (!rewind(mark))
        return false;
    playback_.jump(time_ns);
    while (!playback_.isInterrupted() && reader_.next(target_) == PcapReader::Next::Datagram) {
        PlayTime after = time_;
        if (after.advance(target_) >= time_ns) {
            atTarget_ = true;
            break;
        }
        time_ = after;
    }
    return true; // at the end of the file, where it is damaged, or sought anew: run() finds so
}

bool PcapPlayer::rewind(const PcapIndex::Mark &mark) {
    jump_();
    time_ = mark.before;
    const Outcome<void> found = reader_.seek(mark.place);
    if (!found)
        end_(found);
    return found.ok();
}

} // namespace hermes::velodynelogger
