#include "daemons/velodynelogger/Recorder.h"

#include "common/recording/DiskError.h"
#include "daemons/velodynelogger/ThreadPriority.h"
#include "protocol/velodyne/PositionPacket.h"

#include <algorithm>

namespace hermes::velodynelogger {

namespace {

constexpr std::size_t datagramsAtOnce = 4096; // until progress is told
constexpr std::chrono::milliseconds period{
    20}; // what a crash may cost; rather than to wake up for each packet

/// What the last position packet says, if it says anything.
QJsonObject gpsOf(const std::vector<std::uint8_t> &bytes, std::uint64_t packets) {
    QJsonObject gps{{"position_packets", double(packets)}};
    velodyne::PositionPacket packet;
    if (velodyne::decodePosition(bytes.data(), bytes.size(), packet) != velodyne::PositionFault::None)
        return gps;
    gps.insert("pps", velodyne::toText(packet.pps));
    gps.insert("stamp_us", double(packet.stamp_us));
    gps.insert("nmea", QString::fromLatin1(packet.nmea.data(), int(packet.nmea.size())));
    return gps;
}

} // namespace

Recorder::Recorder(std::size_t capacity)
    : ring_(capacity) {}

Recorder::~Recorder() {
    end();
}

Result<void> Recorder::begin(const RecordingPlan &plan) {
    end();
    const Outcome<void> opened = files_.open(plan);
    account_ = PacketAccount();
    queueDrops_ = kernelDrops_ = tooLong_ = afterFailure_ = 0;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        progress_ = Progress();
        progress_.earlier = plan.earlier;
    }
    publish(opened);
    if (!opened)
        return diskError(QString::fromStdString(opened.error()), plan.folder);
    stopping_ = false;
    accepting_ = true;
    thread_ = std::thread([this] { run(); });
    return {};
}

void Recorder::end() {
    accepting_ = false;
    while (pushing_) // the queue is to be complete, and empty when the next recording begins
        std::this_thread::yield();
    stopping_ = true;
    if (thread_.joinable())
        thread_.join();
    failed_ = false;
    while (pushing_) // one that began before may still count
        std::this_thread::yield();
}

void Recorder::push(const Datagram &datagram, bool wait) {
    pushing_ = true;
    bool isTaken = false;
    while (accepting_ && !isTaken) {
        isTaken = ring_.push(datagram);
        if (!isTaken && !wait) {
            ++queueDrops_;
            isTaken = true;
        }
        if (!isTaken)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (!isTaken)
        afterFailure_ += failed_;
    pushing_ = false;
}

void Recorder::noteLosses(std::uint64_t kernel, std::uint64_t tooLong) {
    if (!accepting_ && !failed_)
        return;
    kernelDrops_ += kernel;
    tooLong_ += tooLong;
}

void Recorder::run() {
    preferThisThread();
    Outcome<void> written;
    bool stopping = false;
    while (written && !stopping) {
        stopping = stopping_; // before the queue is looked at for the last time
        bool more = true;
        while (written && more)
            written = writeWaiting(more);
        if (!stopping)
            std::this_thread::sleep_for(period);
    }
    failed_ = !written;
    accepting_ = false;
    while (pushing_)
        std::this_thread::yield();
    Datagram datagram;
    for (; ring_.front(datagram); ring_.pop()) // nothing but after an error
        account_.add(datagram);
    const Outcome<void> closed = files_.close();
    publish(written ? closed : written);
}

Outcome<void> Recorder::writeWaiting(bool &more) {
    Datagram datagram;
    Outcome<void> written;
    std::size_t count = 0;
    for (; written && count < datagramsAtOnce && ring_.front(datagram); ++count) {
        account_.add(datagram);
        written = files_.write(datagram);
        ring_.pop();
    }
    if (written)
        written = files_.flush();
    more = count == datagramsAtOnce;
    publish(written);
    return written;
}

void Recorder::publish(const Outcome<void> &written) {
    const std::vector<PcapFiles::File> &files = files_.files();
    const std::lock_guard<std::mutex> lock(mutex_);
    // Files before the last that is known here have not changed.
    const std::size_t known = std::min(progress_.files.size(), files.size());
    progress_.files.resize(files.size());
    std::copy(files.begin() + std::ptrdiff_t(known > 0 ? known - 1 : 0), files.end(),
              progress_.files.begin() + std::ptrdiff_t(known > 0 ? known - 1 : 0));
    progress_.path = files.empty() ? std::string() : files_.path();
    progress_.counts = account_.counts();
    progress_.position = account_.position();
    progress_.error = written ? std::nullopt : std::optional(written.error());
}

RecordingState Recorder::state() const {
    Progress progress;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        progress = progress_;
    }
    const PacketAccount::Counts &counts = progress.counts;
    RecordingState state;
    state.path = QString::fromStdString(progress.path);
    state.files = toJson(progress.files);
    std::uint64_t written = 0;
    for (const PcapFiles::File &file : progress.files) {
        state.bytes += double(file.bytes);
        written += file.packets;
    }
    state.counts = {{"packets", double(written)},
                    {"data", double(counts.data)},
                    {"position", double(counts.position)},
                    {"other", double(counts.other)},
                    {"late", double(counts.late)},
                    {"sensor_clock_jumps", double(counts.sensorClockJumps)},
                    {"host_clock_steps", double(counts.hostClockSteps)}};
    state.losses = {{"missing", double(counts.missing)},
                    {"kernel", double(kernelDrops_)},
                    {"queue", double(queueDrops_)},
                    {"too_long", double(tooLong_)},
                    {"unwritten", double(counts.packets - written + afterFailure_)}};
    state.addEarlier(progress.earlier);
    state.gps = gpsOf(progress.position, counts.position);
    if (progress.error)
        state.error = diskError(QString::fromStdString(*progress.error), state.path);
    return state;
}

} // namespace hermes::velodynelogger
