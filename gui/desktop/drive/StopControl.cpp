#include "gui/desktop/drive/StopControl.h"

#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr const char *method = "motor.estop";

} // namespace

StopControl::StopControl(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    connect(&fleet, &Fleet::changed, this, &StopControl::follow);
    connect(&fleet, &Fleet::robotChosen, this, &StopControl::follow);
    follow();
}

// Second connections stand ready to what can be stopped; they end with their daemon, unless it still has to
// be.
void StopControl::follow() {
    std::vector<DaemonLink *> found;
    if (const Robot *const robot = fleet_.robot())
        for (DaemonLink *daemon : robot->daemons())
            if (daemon->hasMethod(method))
                found.push_back(daemon);
    const auto isOver = [&](const std::unique_ptr<StopLine> &line) {
        const auto isIts = [&](const DaemonLink *daemon) { return daemon->address() == line->address(); };
        return line->phase() == StopPhase::None && std::none_of(found.begin(), found.end(), isIts);
    };
    lines_.erase(std::remove_if(lines_.begin(), lines_.end(), isOver), lines_.end());
    for (DaemonLink *daemon : found)
        reach(daemon);
}

void StopControl::reach(DaemonLink *daemon) {
    for (const auto &line : lines_)
        if (line->address() == daemon->address())
            return line->follow(daemon);
    const bool isOne = fleet_.robots().size() <= 1 || !fleet_.robot();
    lines_.push_back(std::make_unique<StopLine>(
        daemon, isOne ? daemon->name() : tr("%1 of %2").arg(daemon->name(), fleet_.robot()->name())));
    StopLine *const line = lines_.back().get();
    connect(line, &StopLine::changed, this, [this] {
        const auto isOver = [](const auto &other) { return other->phase() == StopPhase::None; };
        if (std::all_of(lines_.begin(), lines_.end(), isOver))
            isPressed_ = false; // somebody has released it
        Q_EMIT changed();
    });
    if (isPressed_ && (!robot_ || fleet_.robot() == robot_))
        line->press();
}

void StopControl::press() {
    isPressed_ = true;
    robot_ = fleet_.robot();
    follow();
    for (const auto &line : lines_)
        line->press();
    Q_EMIT changed();
}

void StopControl::release() {
    if (!robot_ || robot_ == fleet_.robot())
        isPressed_ = false;
    for (const auto &line : lines_)
        if (isOfChosen(*line))
            line->release();
    follow();
    Q_EMIT changed();
}

// Who is of no robot any more belongs to whichever is chosen.
bool StopControl::isOfChosen(const StopLine &line) const {
    for (const auto &robot : fleet_.robots())
        for (const DaemonLink *daemon : robot->daemons())
            if (daemon->address() == line.address())
                return robot.get() == fleet_.robot();
    return true;
}

const StopLine *StopControl::worst(bool ofAny) const {
    const StopLine *worst = nullptr;
    for (const auto &line : lines_)
        if (line->phase() != StopPhase::None && (ofAny || isOfChosen(*line)) &&
            (!worst || line->phase() < worst->phase()))
            worst = line.get();
    return worst;
}

StopPhase StopControl::phase() const {
    if (const StopLine *const line = worst(false))
        return line->phase();
    return isPressed_ && (!robot_ || robot_ == fleet_.robot()) ? StopPhase::Pressed : StopPhase::None;
}

bool StopControl::isLate() const {
    if (const StopLine *const line = worst(true))
        return line->phase() != StopPhase::Confirmed && line->unconfirmed_s() > late_s;
    return isPressed_;
}

QString StopControl::text() const {
    const StopLine *const line = worst(true);
    if (!line)
        return isPressed_
                   ? tr("STOP REACHES NOBODY: no robot that can drive is connected. It goes out as soon as "
                        "one is. If a robot moves, use the switch on it.")
                   : QString();
    const QString name = line->name();
    if (isLate() && line->isWatched())
        return tr("THE ROBOT IS NOT KNOWN TO STAND for %1 s: %2 is stopped, but %3. %4 If it moves, use the "
                  "switch on the robot.")
            .arg(line->unconfirmed_s(), 0, 'f', 1)
            .arg(name, line->reason(), line->watchdogs());
    if (line->isWatched())
        return {}; // who stopped it is said
    if (isLate())
        return tr("STOP IS NOT CONFIRMED by %1 for %2 s: %3. It is sent again and again, over new "
                  "connections too. "
                  "%4 If it moves, use the switch on the robot.")
            .arg(name)
            .arg(line->unconfirmed_s(), 0, 'f', 1)
            .arg(line->reason(), line->watchdogs());
    switch (line->phase()) {
    case StopPhase::Pressed:
        return tr("STOP pressed");
    case StopPhase::Sent:
        return tr("STOP sent to %1").arg(name);
    case StopPhase::Taken:
        return tr("STOP taken by %1: the robot brakes").arg(name);
    default:
        return tr("STOPPED: %1 has measured that the robot stands, %2 s after STOP")
            .arg(name)
            .arg(line->took_s(), 0, 'f', 2);
    }
}

} // namespace hermes::desktop
