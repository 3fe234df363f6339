#pragma once

#include "protocol/drive/ReplyReader.h"

#include <array>
#include <deque>
#include <functional>
#include <utility>

namespace hermes::drive {

/// Bytes to a device, and who reads its answer; the reader must live until then.
struct Request {
    ReplyReader *reader = nullptr;
    Bytes bytes;
    std::uint8_t address = 0; ///< modulo 8 it tells which device on the line it is
};

/// The host's side of one line with up to eight devices: sends one request at a time, awaits its answer,
/// repeats it when the answer is late or damaged, and counts. Knows no clock and no line: the caller gives
/// the time (seconds of any monotonic clock), writes what poll() gives and feeds what it reads. A request may
/// be carried out twice when its acknowledgement is lost; all commands that set something allow it.
class Bus {
public:
    struct Options {
        double replyTimeout =
            0.03; ///< from sending to the whole answer; seconds. FTDI adapters hold bytes 16 ms
        double quiet =
            0.011; ///< silence after a failure; seconds. A RoboClaw drops a part of a packet after 10 ms
        int retries = 2;
        std::size_t queue = 64; ///< requests that may wait
    };
    enum class Result { Done, TimedOut, BadCrc, Unexpected, Cancelled, LineClosed };
    struct Outcome {
        Result result = Result::Done; ///< of the last attempt
        int attempts = 0;
        double sent = 0;     ///< when the last attempt was sent
        double received = 0; ///< when its answer was whole
    };
    struct Counts {
        std::uint64_t sent = 0; ///< attempts
        std::uint64_t done = 0;
        std::uint64_t timeouts = 0;
        std::uint64_t crcErrors = 0;
        std::uint64_t unexpected = 0; ///< a byte that is no acknowledgement, a text without end
        std::uint64_t retries = 0;
        std::uint64_t failed = 0; ///< requests given up
    };
    enum class Urgency { Normal, First };
    /// When it is called with Done, the reader of the request holds the answer.
    using Handler = std::function<void(const Outcome &)>;

    Bus() = default;
    explicit Bus(const Options &options)
        : options_(options) {}

    /// Queues a request; handler is called once, from feed(), poll(), cancel() or setOpen(). False, and
    /// handler is not called, when too many wait. First goes before all that are not, and their repetitions,
    /// and does not wait for the end of foreign bytes: a device does not hear them.
    /// replyTimeout: seconds; that of the options when it is 0.
    bool submit(const Request &request, Handler handler = {}, Urgency urgency = Urgency::Normal,
                double replyTimeout = 0);
    /// Ends all that wait with Cancelled. The one that awaits its answer goes on, without further attempts.
    void cancel() {
        repeats_ = false;
        endAll(Result::Cancelled);
    }
    /// A closed line ends everything with LineClosed, also what is submitted while it is closed.
    void setOpen(bool open);

    /// What is to be written now, or nullptr. Call it after submit() and feed(), and at deadline().
    const Bytes *poll(double now);
    void feed(const std::uint8_t *data, std::size_t size, double now);
    /// When poll() has to be called at the latest; infinite when nothing is pending.
    double deadline() const;

    bool isIdle() const { return !awaiting_ && queue_.empty(); }
    /// Nothing is sent before: the line has to be quiet after a failure, and after foreign bytes.
    double quietUntil() const { return resume_; }
    /// The same of what is First.
    double pauseUntil() const { return pause_; }
    /// Requests to one address.
    const Counts &counts(std::uint8_t address) const { return counts_[address % 8]; }
    /// Bytes that came when none was awaited.
    std::uint64_t strayBytes() const { return stray_; }

private:
    struct Entry {
        Request request;
        Handler handler;
        Urgency urgency = Urgency::Normal;
        double replyTimeout = 0;
        int attempts = 0;
    };

    std::deque<Entry>::iterator behindUrgent();
    void attemptEnded(ReplyReader::Result result, double now);
    void attemptFailed(Result result, double now);
    void endAll(Result result) {
        const std::deque<Entry> ended = std::exchange(queue_, {}); // handlers may submit
        for (const Entry &entry : ended)
            finish(entry, {result, entry.attempts, 0, 0});
    }
    void finish(Entry entry, const Outcome &outcome);
    double earliest(const Entry &entry) const { return entry.urgency == Urgency::First ? pause_ : resume_; }
    Counts &countsOf(const Entry &entry) { return counts_[entry.request.address % 8]; }

    Options options_;
    std::deque<Entry> queue_;
    Entry current_; ///< while awaiting
    bool open_ = true;
    bool awaiting_ = false;
    bool repeats_ = true; ///< the current one was not cancelled
    double sent_ = 0;
    double lastByte_ = 0;
    double pause_ = 0;       ///< nothing is sent before
    double resume_ = 0;      ///< nor what is not First before that
    double resumeLimit_ = 0; ///< chatter does not put it off beyond
    std::array<Counts, 8> counts_{};
    std::uint64_t stray_ = 0;
};

} // namespace hermes::drive
