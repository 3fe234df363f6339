#include "common/channel/PacedWriter.h"

#include "common/Time.h"
#include "protocol/serial/SerialLink.h"

#include <algorithm>
#include <cmath>

namespace hermes {
namespace {

constexpr double longestLag_s = 0.006; // of what is written; one frame more is then added
constexpr double wakeBefore_s = 0.004; // so that the line does not fall silent
constexpr qint64 maxUnsent = 600;      // where the rate is not known
constexpr double longestSleep_s = 0.005, longestWait_s = 3600;

} // namespace

PacedWriter::PacedWriter(Interface &carrier, const std::shared_ptr<Codec> &codec, QObject *parent)
    : QObject(parent)
    , carrier_(carrier)
    , codec_(codec)
    , link_(*codec->link()) {
    timer_.setSingleShot(true);
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &PacedWriter::resume);
    connect(&carrier_, &Interface::drained, this, &PacedWriter::resume);
    link_.setBytesPerSecond(carrier_.bytesPerSecond());
}

void PacedWriter::resume() {
    pump();
    Q_EMIT resumed();
}

void PacedWriter::pump() {
    if (pumping_ || !carrier_.isOpen())
        return;
    pumping_ = true; // a carrier may tell at once that it has written
    double now = monotonicNow();
    link_.setTime(now);
    while (mayWrite(now)) {
        const QByteArray frame = link_.next();
        if (frame.isEmpty())
            break;
        carrier_.write(frame); // where it is not taken it is lost, as on the line
        if (const double rate = link_.bytesPerSecond(); rate > 0)
            busyUntil_ = std::max(now, busyUntil_) + frame.size() / rate;
        now = monotonicNow();
    }
    pumping_ = false;
    schedule(now);
}

double PacedWriter::lag(double now) const {
    const double unsent = double(carrier_.bytesToWrite() + carrier_.bytesInSystem());
    return std::max(busyUntil_ - now, unsent / link_.bytesPerSecond());
}

bool PacedWriter::mayWrite(double now) const {
    if (!carrier_.isOpen())
        return false;
    return link_.bytesPerSecond() > 0 ? lag(now) <= longestLag_s
                                      : carrier_.bytesToWrite() + carrier_.bytesInSystem() < maxUnsent;
}

void PacedWriter::schedule(double now) {
    double wait_s = std::min(link_.wakeAt() - now, longestWait_s);
    if (link_.hasNext()) // as soon as there is room; not all carriers tell
        wait_s = std::min(wait_s, link_.bytesPerSecond() > 0 ? lag(now) - wakeBefore_s : longestSleep_s);
    else if (!std::isfinite(link_.wakeAt()))
        return timer_.stop();
    timer_.start(std::max(1, int(std::ceil(wait_s * 1000))));
}

} // namespace hermes
