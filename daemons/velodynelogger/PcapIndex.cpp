#include "daemons/velodynelogger/PcapIndex.h"

#include <algorithm>

namespace hermes::velodynelogger {

namespace {

// Both are waited for, so that no capture, however its stamps lie, fills the memory: 40 bytes a mark.
constexpr std::int64_t markTime_ns = 1000000000;
constexpr std::int64_t markBytes = 1 << 20;

} // namespace

void PcapIndex::start(const std::vector<std::string> &paths, const PlayTime &begin) {
    stop();
    begin_ = {begin, {}};
    marks_.clear();
    duration_ns_.reset();
    stopping_ = false;
    thread_ = std::thread([this, paths, begin] {
        PcapSequence reader;
        if (reader.open(paths)) // the player tells why not
            run(reader, begin);
    });
}

void PcapIndex::stop() {
    stopping_ = true;
    if (thread_.joinable())
        thread_.join();
}

void PcapIndex::run(PcapSequence &reader, PlayTime time) {
    Datagram datagram;
    Mark last{time, {}};
    while (!stopping_) {
        const Mark here{time, reader.place()};
        if (reader.next(datagram) != PcapReader::Next::Datagram) {
            const std::lock_guard<std::mutex> lock(mutex_);
            duration_ns_ = time.now_ns();
            return;
        }
        time.advance(datagram);
        if (reader.canSeek() && here.before.now_ns() - last.before.now_ns() >= markTime_ns &&
            (here.place.file != last.place.file ||
             here.place.inFile.offset - last.place.inFile.offset >= markBytes)) {
            const std::lock_guard<std::mutex> lock(mutex_);
            marks_.push_back(here);
            last = here;
        }
    }
}

std::optional<std::int64_t> PcapIndex::duration_ns() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return duration_ns_;
}

PcapIndex::Mark PcapIndex::before(std::int64_t time_ns) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = std::find_if(marks_.rbegin(), marks_.rend(),
                                    [time_ns](const Mark &mark) { return mark.before.now_ns() < time_ns; });
    return found == marks_.rend() ? begin_ : *found;
}

} // namespace hermes::velodynelogger
