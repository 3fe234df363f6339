#include "protocol/drive/Bus.h"

#include <algorithm>
#include <limits>

namespace hermes::drive {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr int longestQuiet = 5; // times the option, when bytes keep coming

} // namespace

bool Bus::submit(const Request &request, Handler handler, Urgency urgency, double replyTimeout) {
    if (queue_.size() >= options_.queue)
        return false;
    const auto place = urgency == Urgency::First ? behindUrgent() : queue_.end();
    queue_.insert(place, Entry{request, std::move(handler), urgency,
                               replyTimeout > 0 ? replyTimeout : options_.replyTimeout, 0});
    return true;
}

std::deque<Bus::Entry>::iterator Bus::behindUrgent() {
    return std::find_if(queue_.begin(), queue_.end(),
                        [](const Entry &entry) { return entry.urgency != Urgency::First; });
}

void Bus::setOpen(bool open) {
    open_ = open;
    if (open)
        return;
    if (std::exchange(awaiting_, false))
        queue_.push_front(std::move(current_));
    endAll(Result::LineClosed);
}

void Bus::finish(Entry entry, const Outcome &outcome) {
    ++(outcome.result == Result::Done ? countsOf(entry).done : countsOf(entry).failed);
    if (entry.handler)
        entry.handler(outcome);
}

const Bytes *Bus::poll(double now) {
    if (!open_) {
        endAll(Result::LineClosed);
        return nullptr;
    }
    if (awaiting_ && current_.request.reader->received() > 0 && now - lastByte_ >= options_.quiet) {
        lastByte_ = never; // once for each silence
        attemptEnded(current_.request.reader->silence(), now);
    }
    if (awaiting_ && now - sent_ >= current_.replyTimeout)
        attemptFailed(Result::TimedOut, now);
    if (awaiting_ || queue_.empty() || now < earliest(queue_.front()))
        return nullptr;
    current_ = std::move(queue_.front());
    queue_.pop_front();
    awaiting_ = repeats_ = true;
    sent_ = now;
    ++countsOf(current_).sent;
    countsOf(current_).retries += current_.attempts++ > 0;
    current_.request.reader->begin(current_.request.bytes);
    return &current_.request.bytes;
}

void Bus::feed(const std::uint8_t *data, std::size_t size, double now) {
    for (std::size_t i = 0; i < size; ++i) {
        if (!awaiting_) {
            ++stray_;
            if (now >= resume_ && queue_.empty())
                resumeLimit_ = now + longestQuiet * options_.quiet;
            resume_ = std::max(resume_, std::min(now + options_.quiet, resumeLimit_));
            continue;
        }
        lastByte_ = now;
        attemptEnded(current_.request.reader->feed(data[i]), now);
    }
}

void Bus::attemptEnded(ReplyReader::Result result, double now) {
    switch (result) {
    case ReplyReader::Result::Incomplete:
        return;
    case ReplyReader::Result::BadCrc:
        return attemptFailed(Result::BadCrc, now);
    case ReplyReader::Result::Unexpected:
        return attemptFailed(Result::Unexpected, now);
    case ReplyReader::Result::Done:
        awaiting_ = false;
        Entry entry = std::move(current_);
        const Outcome outcome{Result::Done, entry.attempts, sent_, now};
        finish(std::move(entry), outcome);
    }
}

void Bus::attemptFailed(Result result, double now) {
    awaiting_ = false;
    pause_ = resume_ = now + options_.quiet;
    resumeLimit_ = now + longestQuiet * options_.quiet;
    Counts &counts = countsOf(current_);
    ++(result == Result::TimedOut ? counts.timeouts
       : result == Result::BadCrc ? counts.crcErrors
                                  : counts.unexpected);
    Entry entry = std::move(current_);
    if (repeats_ && entry.attempts <= options_.retries)
        queue_.insert(entry.urgency == Urgency::First ? queue_.begin() : behindUrgent(), std::move(entry));
    else
        finish(entry, {result, entry.attempts, sent_, now});
}

double Bus::deadline() const {
    if (!awaiting_)
        return queue_.empty() ? never : earliest(queue_.front());
    const double timeout = sent_ + current_.replyTimeout;
    return current_.request.reader->received() > 0 ? std::min(timeout, lastByte_ + options_.quiet) : timeout;
}

} // namespace hermes::drive
