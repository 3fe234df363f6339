#include "gui/desktop/drive/StopControl.h"

#include "gui/desktop/widgets/ForeignText.h"

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
    connect(&fleet, &Fleet::moved, this, &StopControl::onMoved);
    connect(&fleet, &Fleet::robotGone, this, &StopControl::onRobotGone);
    follow();
}

// Second connections stand ready to what can be stopped; they end with their daemon, unless it still has to
// be.
void StopControl::follow() {
    std::vector<DaemonLink *> found;
    for (const auto &robot : fleet_.robots())
        if (robot.get() == fleet_.robot() || pressed_.contains(robot.get()))
            for (DaemonLink *daemon : robot->daemons())
                if (daemon->hasMethod(method))
                    found.push_back(daemon);
    const auto isOver = [&](const Line &line) {
        const auto isIts = [&](const DaemonLink *daemon) {
            return daemon->address() == line.stop->address();
        };
        return line.stop->phase() == StopPhase::None && std::none_of(found.begin(), found.end(), isIts);
    };
    lines_.erase(std::remove_if(lines_.begin(), lines_.end(), isOver), lines_.end());
    for (DaemonLink *daemon : found)
        reach(daemon);
}

void StopControl::reach(DaemonLink *daemon) {
    const Robot *const robot = fleet_.robotOf(daemon);
    const QString name = fleet_.titleOf(*daemon);
    for (Line &line : lines_)
        if (line.stop->address() == daemon->address()) {
            line.robot = robot;
            line.stop->setName(name);
            return line.stop->follow(daemon);
        }
    lines_.push_back({robot, std::make_unique<StopLine>(daemon, name)});
    StopLine *const stop = lines_.back().stop.get();
    connect(stop, &StopLine::changed, this, [this, stop] { onChanged(stop); });
    if (pressed_.remove(nullptr))
        pressed_.insert(robot);
    if (pressed_.contains(robot))
        stop->press();
}

void StopControl::onChanged(const StopLine *stop) {
    const auto own = std::find_if(lines_.begin(), lines_.end(),
                                  [stop](const Line &line) { return line.stop.get() == stop; });
    const auto isBusy = [own](const Line &line) {
        return line.robot == own->robot && line.stop->phase() != StopPhase::None;
    };
    if (own != lines_.end() && std::none_of(lines_.begin(), lines_.end(), isBusy))
        pressed_.remove(own->robot); // somebody has released it
    Q_EMIT changed();
}

// A STOP goes with the daemon, and is one of the robot that has it now.
void StopControl::onMoved(const DaemonLink *daemon, const Robot *from, const Robot *to) {
    bool hadLine = false, hasMore = false;
    for (Line &line : lines_) {
        if (line.stop->address() == daemon->address()) {
            line.robot = to;
            line.stop->setName(fleet_.titleOf(*daemon));
            hadLine = true;
        }
        hasMore = hasMore || line.robot == from;
    }
    if (!pressed_.contains(from))
        return;
    pressed_.insert(to);
    if (hadLine && !hasMore)
        pressed_.remove(from);
}

void StopControl::onRobotGone(const Robot *robot, const Robot *successor) {
    if (pressed_.remove(robot) && successor)
        pressed_.insert(successor);
    for (Line &line : lines_)
        if (line.robot == robot)
            line.robot = successor; // one that is on its way goes on, whoever it belongs to
    follow();
    Q_EMIT changed();
}

void StopControl::press() {
    fleet_.keepChoice();
    pressed_.insert(fleet_.robot());
    follow();
    for (const Line &line : lines_)
        if (line.robot == fleet_.robot())
            line.stop->press();
    Q_EMIT changed();
}

void StopControl::release() {
    pressed_.remove(fleet_.robot());
    pressed_.remove(nullptr);
    for (const Line &line : lines_)
        if (line.robot == fleet_.robot())
            line.stop->release();
    follow();
    Q_EMIT changed();
}

bool StopControl::reachesNobody() const {
    return std::any_of(pressed_.begin(), pressed_.end(), [this](const Robot *robot) {
        return std::none_of(lines_.begin(), lines_.end(),
                            [robot](const Line &line) { return line.robot == robot; });
    });
}

const StopLine *StopControl::worst(bool ofAny) const {
    const StopLine *worst = nullptr;
    for (const Line &line : lines_)
        if (line.stop->phase() != StopPhase::None && (ofAny || line.robot == fleet_.robot()) &&
            (!worst || line.stop->phase() < worst->phase()))
            worst = line.stop.get();
    return worst;
}

StopPhase StopControl::phase() const {
    if (const StopLine *const line = worst(false))
        return line->phase();
    return pressed_.contains(fleet_.robot()) || pressed_.contains(nullptr) ? StopPhase::Pressed
                                                                           : StopPhase::None;
}

bool StopControl::isLate() const {
    const StopLine *const line = worst(true);
    return reachesNobody() ||
           (line && line->phase() != StopPhase::Confirmed && line->unconfirmed_s() > late_s);
}

bool StopControl::isOnItsWay() const {
    const StopLine *const line = worst(true);
    return reachesNobody() || (line && line->phase() != StopPhase::Confirmed);
}

QString StopControl::text() const {
    if (reachesNobody())
        return tr("STOP REACHES NOBODY: no robot that can drive is connected. It goes out as soon as one is. "
                  "If a robot moves, use the switch on it.");
    const StopLine *const line = worst(true);
    if (!line)
        return {};
    const QString text = textOf(*line);
    const auto own = std::find_if(lines_.begin(), lines_.end(),
                                  [line](const Line &one) { return one.stop.get() == line; });
    return text.isEmpty() || !own->robot || own->robot == fleet_.robot()
               ? text
               : tr("%1: %2").arg(shortLine(fleet_.titleOf(*own->robot), 40), text);
}

QString StopControl::textOf(const StopLine &line) const {
    const QString name = line.name();
    if (isLate() && line.isWatched())
        return tr("THE ROBOT IS NOT KNOWN TO STAND for %1 s: %2 is stopped, but %3. %4 If it moves, use the "
                  "switch on the robot.")
            .arg(line.unconfirmed_s(), 0, 'f', 1)
            .arg(name, line.reason(), line.watchdogs());
    if (line.isWatched())
        return {}; // who stopped it is said
    if (isLate())
        return tr("STOP IS NOT CONFIRMED by %1 for %2 s: %3. It is sent again and again, over new "
                  "connections too. "
                  "%4 If it moves, use the switch on the robot.")
            .arg(name)
            .arg(line.unconfirmed_s(), 0, 'f', 1)
            .arg(line.reason(), line.watchdogs());
    switch (line.phase()) {
    case StopPhase::Pressed:
        return tr("STOP pressed");
    case StopPhase::Sent:
        return tr("STOP sent to %1").arg(name);
    case StopPhase::Taken:
        return tr("STOP taken by %1: the robot brakes").arg(name);
    default:
        return tr("STOPPED: %1 has measured that the robot stands, %2 s after STOP")
            .arg(name)
            .arg(line.took_s(), 0, 'f', 2);
    }
}

} // namespace hermes::desktop
