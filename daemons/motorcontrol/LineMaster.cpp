#include "daemons/motorcontrol/LineMaster.h"

#include <algorithm>
#include <limits>

namespace hermes::motorcontrol {

using drive::Bus;

namespace {

// A request is not repeated as it is: what is due then is newer.
Bus::Options withoutRepetition() {
    Bus::Options options;
    options.retries = 0;
    return options;
}

} // namespace

LineMaster::LineMaster(std::vector<MotorController *> controllers)
    : bus_(withoutRepetition()) {
    for (MotorController *controller : controllers)
        places_.push_back({controller, {}, 0});
    bus_.setOpen(false);
}

void LineMaster::setOpen() {
    bus_.setOpen(true);
}

void LineMaster::setClosed(const QString &reason) {
    bus_.setOpen(false);
    for (const Place &place : places_)
        place.controller->lineClosed(reason);
}

double LineMaster::silentUntil() const {
    double until = 0;
    for (const Place &place : places_)
        until = std::max(until, place.controller->silentUntil());
    return until;
}

double LineMaster::busyUntil() const {
    return std::max(bus_.quietUntil(), silentUntil());
}

double LineMaster::deadline() const {
    if (!bus_.isIdle())
        return bus_.deadline();
    if (isAnyToStop())
        return bus_.pauseUntil();
    return busyUntil() > now_ ? busyUntil() : std::numeric_limits<double>::infinity();
}

const drive::Bytes *LineMaster::poll(double now) {
    now_ = now;
    bus_.poll(now); // ends what is late
    if (bus_.isIdle() && now >= bus_.pauseUntil() && !submitStop() && now >= bus_.quietUntil())
        submitNext();
    const drive::Bytes *out = bus_.poll(now);
    tellWhetherHeld(now);
    return out;
}

void LineMaster::tellWhetherHeld(double now) {
    const bool held = bus_.isIdle() ? now < silentUntil() : waitsPatiently_;
    for (const Place &place : places_)
        place.controller->setLineHeld(held);
}

void LineMaster::feed(const std::uint8_t *data, std::size_t size, double now) {
    now_ = now;
    bus_.feed(data, size, now);
}

bool LineMaster::isAnyToStop() const {
    return std::any_of(places_.begin(), places_.end(),
                       [](const Place &place) { return place.controller->isToStop(); });
}

// The first stop of each breaks the silence that another one needs: it is one packet.
bool LineMaster::submitStop() {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        if (places_[i].controller->isToStop() && submit(i, Task::SetPoint, Bus::Urgency::First))
            return true;
    }
    return false;
}

void LineMaster::submitNext() {
    if (now_ < silentUntil() || submitInRound())
        return;
    for (Place &place : places_) // the next round
        place.served = {};
    submitInRound();
}

bool LineMaster::submitInRound() {
    for (int task = 0; task < MotorController::taskCount; ++task) {
        for (std::size_t k = 0; k < places_.size(); ++k) {
            const std::size_t i = (first_ + k) % places_.size();
            const bool served = places_[i].served[std::size_t(task)] || places_[i].controller->isFailing();
            if (!served && submit(i, Task(task)))
                return true;
        }
    }
    return submitToFailing();
}

// One that does not answer waits until the others have what they need, each failure takes 40 ms or more; then
// it has one request in a round, each time another one.
bool LineMaster::submitToFailing() {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        Place &place = places_[i];
        for (int k = 0; k < MotorController::taskCount && place.controller->isFailing(); ++k) {
            const int task = (place.failed + 1 + k) % MotorController::taskCount;
            if (!place.served[std::size_t(task)] && submit(i, Task(task)))
                return true;
        }
    }
    return false;
}

bool LineMaster::submit(std::size_t place, Task task, Bus::Urgency urgency) {
    const auto asked = places_[place].controller->next(task, now_);
    if (!asked)
        return false;
    waitsPatiently_ = asked->isPatient();
    return bus_.submit(
        asked->request, [this, place, task](const Bus::Outcome &outcome) { finished(place, task, outcome); },
        urgency, asked->timeout_s);
}

void LineMaster::finished(std::size_t place, Task task, const Bus::Outcome &outcome) {
    MotorController &controller = *places_[place].controller;
    controller.finished(outcome, now_);
    if (task == Task::Background) {   // one in a round for the whole line; then it is the next one's turn
        for (Place &each : places_) { // but one that has to stop, or to be set up, has turns of its own
            if (each.controller->isReady())
                each.served[std::size_t(task)] = true;
        }
        first_ = (place + 1) % places_.size();
    }
    Place &served = places_[place];
    if (outcome.result != Bus::Result::Done)
        served.failed = int(task);
    if (controller.isFailing())
        served.served.fill(true);
    else // a byte may be damaged on any line: that is asked again at once
        served.served[std::size_t(task)] = outcome.result == Bus::Result::Done;
}

} // namespace hermes::motorcontrol
