#include "common/client/Repeater.h"

#include "common/Time.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hermes {
namespace {

constexpr double firstPeriod_s = 0.3, leastPeriod_s = 0.02;
// It goes in pieces, and so does its reply: both arrive.
constexpr double longPeriod_s = SerialLink::shortestStandstill_s;
constexpr double growth = 1.5; // of the period, at each repeat
constexpr int usualReplyBytes = 100;
// With one byte in 200 damaged a stop and its reply pass in one case of two: 99 of 100 are answered after
// seven.
constexpr int hurriedRepeats = 9;
constexpr double leastHurriedPeriod_s = 0.003;
constexpr int maxFraming = 10; // bytes around a short message

} // namespace

Repeater::Repeater(QObject *parent)
    : QObject(parent) {
    timer_.setSingleShot(true);
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &Repeater::repeatDue);
}

void Repeater::add(Channel &channel, qint64 id, const Sent &request, Channel::Rank rank) {
    channel_ = &channel;
    const int bytes = request.frame.size();
    const bool isHurried = rank == Channel::Rank::Urgent && bytes <= SerialLink::largestFrame;
    const double now = monotonicNow();
    const double wait_s =
        isHurried ? std::max(leastHurriedPeriod_s, onLine_s(bytes + maxFraming)) : period(bytes);
    requests_.insert(id, {request, rank, now, now + wait_s, wait_s, isHurried ? hurriedRepeats : 0, false});
    if (!timer_.isActive() || now + wait_s < wakesAt_)
        wakeAt(now + wait_s);
}

// As RFC 6298, but for the time that the frames take on the line.
double Repeater::period(int bytes) const {
    if (bytes > SerialLink::largestFrame)
        return longPeriod_s;
    const double way_s = onLine_s(bytes + usualReplyBytes);
    const double measured_s = roundTrip_s_ > 0 ? roundTrip_s_ + 4 * deviation_s_ : firstPeriod_s;
    return std::clamp(measured_s + way_s, leastPeriod_s + 2 * way_s, longestPeriod_s + 4 * way_s);
}

double Repeater::onLine_s(int bytes) const {
    const double rate = channel_->interface().bytesPerSecond();
    return rate > 0 ? bytes / rate : 0;
}

void Repeater::end(qint64 id, bool isAnswered) {
    const auto found = requests_.find(id);
    if (found == requests_.end())
        return;
    if (isAnswered && !found->isRepeated) { // else nobody knows which one was answered
        const double took_s = monotonicNow() - found->sentAt;
        const bool isFirst = roundTrip_s_ == 0;
        deviation_s_ = isFirst ? took_s / 2 : 0.75 * deviation_s_ + 0.25 * std::abs(took_s - roundTrip_s_);
        roundTrip_s_ = isFirst ? took_s : 0.875 * roundTrip_s_ + 0.125 * took_s;
    }
    requests_.erase(found);
}

void Repeater::clear() {
    requests_.clear();
    timer_.stop();
}

void Repeater::repeatDue() {
    const double now = monotonicNow();
    double next = std::numeric_limits<double>::infinity();
    for (Request &request : requests_) {
        if (request.dueAt <= now)
            repeat(request, now);
        next = std::min(next, request.dueAt);
    }
    if (std::isfinite(next))
        wakeAt(next);
}

void Repeater::repeat(Request &request, double now) {
    if (!channel_->isUnderWay(request.sent.ticket)) {
        if (const auto ticket = channel_->write(request.sent.frame, request.rank)) {
            request.sent.ticket = *ticket;
            request.isRepeated = true;
            ++repeats_;
            --request.hurried;
        }
        if (request.hurried == 0)
            request.period_s = period(request.sent.frame.size());
        else if (request.hurried < 0)
            request.period_s =
                std::min(growth * request.period_s, std::max(longestPeriod_s, request.period_s));
    }
    request.dueAt = now + request.period_s;
}

void Repeater::wakeAt(double due) {
    wakesAt_ = due;
    timer_.start(std::max(1, int(std::ceil((due - monotonicNow()) * 1000))));
}

} // namespace hermes
