#include "gui/desktop/drive/DriveControl.h"

#include "common/Time.h"
#include "gui/desktop/drive/OwnName.h"
#include "protocol/wire/Fields.h"

#include <QPointer>

namespace hermes::desktop {
namespace {

const QString driveMethod = "motor.drive";

} // namespace

DriveControl::DriveControl(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet)
    , odometry_(
          fleet, "odometry", {{"max_rate_hz", 10}}, [this](const TopicUpdate &u) { onOdometry(u); }, this)
    , stop_(fleet)
    , replay_(fleet) {
    connect(&replay_, &ReplayWatch::changed, this, &DriveControl::onReplay);
    connect(&odometry_, &TopicFeed::sourceChanged, this, [this] {
        measured_ = {};
        measuredAge_.forget();
        Q_EMIT changed();
    });
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &DriveControl::tick);
    connect(&pollTimer_, &QTimer::timeout, this, &DriveControl::poll);
    connect(&stop_, &StopControl::changed, this, [this] {
        const StopPhase before = std::exchange(shownPhase_, stop_.phase());
        if (before != shownPhase_ && shownPhase_ == StopPhase::None)
            poll(); // what else holds the robot
        Q_EMIT changed();
    });
    connect(&fleet, &Fleet::changed, this, &DriveControl::follow);
    connect(&fleet, &Fleet::robotChosen, this, &DriveControl::follow);
    connect(&fleet, &Fleet::moved, this, [this](const DaemonLink *daemon, const Robot *from, Robot *to) {
        if (from == fleet_.robot())
            onMoved(daemon, to);
    });
    fleet.setObjection([guard = QPointer<DriveControl>(this)](const Robot &robot) {
        return guard ? guard->objection(robot) : QString();
    });
    timer_.start(period);
    pollTimer_.start(std::chrono::milliseconds(500));
    follow();
}

DaemonLink *DriveControl::motors() const {
    const Robot *const robot = fleet_.robot();
    if (!robot)
        return nullptr;
    // Who is driven stays so, whoever else appears, and is waited for while it is away.
    if (driven_ && robot->has(driven_) && driven_->hasMethod(driveMethod))
        return driven_->isConnected() ? driven_.data() : nullptr;
    return robot->withMethod(driveMethod);
}

void DriveControl::follow() {
    DaemonLink *const found = motors();
    if (found == motors_)
        return;
    halt();
    if (motors_) {
        motors_->disconnect(this);
        motors_->unsubscribe(settings_);
    }
    motors_ = found;
    if (found && found != driven_) { // what the limit means is another robot's
        limit_ = usualLimit;
        most_ = usualMost;
    }
    if (found)
        driven_ = found;
    hold_ = {};
    measured_ = {};
    measuredAge_.forget();
    stateAge_.forget();
    isHolding_ = isAsking_ = isPolling_ = false;
    mustCentre_ = isAnyHeld();
    clock_ = {};
    if (!found)
        return tell(tr("No robot that can drive is connected."));
    tell({});
    found->call("settings.get", {{"path", "motion"}}, this,
                [this, asked = motors_](const Result<QJsonValue> &motion) {
                    if (motion && asked == motors_)
                        takeMost(*motion);
                });
    settings_ = found->subscribe("settings", {{"max_rate_hz", 2}},
                                 [this](const TopicUpdate &update) { takeMost(update.json()["motion"]); });
    poll();
}

// It is another robot's now: nobody has said that this one is to be driven. It is the chosen one then:
// whoever drives on is to move the same wheels as before, and not those of who is left.
void DriveControl::onMoved(const DaemonLink *daemon, Robot *to) {
    if (daemon != driven_)
        return;
    const bool wasDriving = isDriving_;
    halt();
    fleet_.goAlong(to);
    if (wasDriving)
        tell(tr("The drive has ended: %1 belongs to the robot %2 now.")
                 .arg(daemon->name(), fleet_.titleOf(*to)));
}

QString DriveControl::objection(const Robot &robot) const {
    if (isDriving_ && robot.has(motors_))
        return tr("%1 is driven: let go first.").arg(robot.name());
    if (stop_.isPressedFor(robot))
        return tr("STOP was pressed for %1: release it first.").arg(robot.name());
    return {};
}

void DriveControl::takeMost(const QJsonValue &motion) {
    const auto most = [&](const char *name, double usual) { // m/s or rad/s
        return qBound(0.0, motion[QLatin1String(name)].toDouble(usual), 100.0);
    };
    most_ = {most("vx", most_.vx), most("vy", most_.vy), most("omega", most_.omega)};
    Q_EMIT changed();
}

void DriveControl::steer(const QString &input, const Twist2D &wish, bool isHeld) {
    inputs_[input] = {wish, isHeld};
    if (isHeld)
        fleet_.keepChoice();
    if (mustCentre_ && !isAnyHeld())
        mustCentre_ = false;
}

void DriveControl::setLimit(double share) {
    limit_ = qBound(leastLimit, share, 1.0);
    Q_EMIT changed();
}

bool DriveControl::isAnyHeld() const {
    return std::any_of(inputs_.begin(), inputs_.end(), [](const Input &input) { return input.isHeld; });
}

Twist2D DriveControl::wish() const {
    Twist2D sum;
    for (const Input &input : inputs_) {
        if (!input.isHeld)
            continue;
        sum.vx += input.wish.vx;
        sum.vy += input.wish.vy;
        sum.omega += input.wish.omega;
    }
    const auto scaled = [this](double share, double most) {
        return qBound(-1.0, share, 1.0) * limit_ * most;
    };
    return {scaled(sum.vx, most_.vx), scaled(sum.vy, most_.vy), scaled(sum.omega, most_.omega)};
}

void DriveControl::driveBlindly() {
    isBlindMeant_ = true;
    mustCentre_ = isAnyHeld();
    tell({});
    Q_EMIT changed();
}

// A drive that is under way when a replay begins ends: what is seen from now on is not what is.
void DriveControl::onReplay() {
    if (!replay_.isReplaying())
        isBlindMeant_ = false;
    else if (refusesForReplay())
        mustCentre_ = mustCentre_ || isAnyHeld();
    Q_EMIT changed();
}

void DriveControl::tick() {
    if (isAnyHeld() && refusesForReplay())
        mustCentre_ = true;
    const bool wants = isAnyHeld() && !mustCentre_ && motors_ && motors_->isConnected() && !isStopped();
    if (!wants) {
        if (isDriving_)
            halt();
        return;
    }
    if (isHolding_)
        send();
    else if (!isAsking_)
        acquire(false);
}

void DriveControl::acquire(bool takeOver) {
    if (!motors_)
        return;
    isAsking_ = true;
    QJsonObject params{{"client", ownName()}, {"timeout_s", lease_s}};
    if (takeOver)
        params["take_over"] = true;
    motors_->call("control.acquire", params, this,
                  [this, takeOver, asked = motors_](const Result<QJsonValue> &result) {
                      if (!asked || asked != motors_)
                          return; // another robot's answer; its control ends by itself
                      isAsking_ = false;
                      isHolding_ = result.ok();
                      tell(result ? QString() : result.error().message);
                      if (!result)
                          mustCentre_ = isAnyHeld();
                      else if (!takeOver && (!isAnyHeld() || mustCentre_))
                          giveBack(); // let go meanwhile
                      if (!result && takeOver && result.error().is(ErrorCode::NotAuthorised))
                          ask();
                      poll();
                  });
}

// Who may not take the control can still say that they would like it.
void DriveControl::ask() {
    motors_->call(
        "control.ask", {{"client", ownName()}}, this,
        [this, asked = motors_](const Result<QJsonValue> &result) {
            if (!asked || asked != motors_)
                return;
            tell(result ? tr("You may not take the control over; %1 has been asked for it.").arg(holder())
                        : result.error().message);
        });
}

void DriveControl::send() {
    isDriving_ = true;
    commanded_ = wish();
    const QJsonObject command{{"vx", commanded_.vx},
                              {"vy", commanded_.vy},
                              {"omega", commanded_.omega},
                              {"stamp", stampNow() + clock_.seconds()}};
    const auto done = [this, guard = QPointer<DriveControl>(this)](const Result<QJsonValue> &result) {
        if (!guard)
            return;
        if (result)
            return tell({});
        if (!isDriving_)
            return;                                  // it was on its way when the drive ended
        if (!result.error().is(ErrorCode::NotReady)) // one that is late is refused alone
            halt();
        tell(result.error().message);
    };
    motors_->client().call(driveMethod, command, done, Client::defaultTimeout,
                           Client::Repeats::None); // a late one would move the robot
    Q_EMIT changed();
}

void DriveControl::giveBack() {
    if (motors_)
        motors_->client().call("control.release", QJsonObject(), [](const auto &) {});
    lose();
}

/// The control, as the next state will tell; one that was asked for before tells nothing of it.
void DriveControl::lose() {
    if (isHolding_)
        hold_.control.held = false;
    isHolding_ = false;
    ++losses_;
}

void DriveControl::halt() {
    commanded_ = {};
    if (isDriving_ && motors_) {
        // Calls, which are repeated where frames are lost.
        motors_->client().call(
            "motor.stop", named("motor.stop"), [](const auto &) {}, Client::defaultTimeout,
            Client::Repeats::AtOnce);
        giveBack();
    }
    isDriving_ = isHolding_ = false;
    mustCentre_ = isAnyHeld();
    Q_EMIT changed();
}

// With the name of this program, where the method takes one.
QJsonObject DriveControl::named(const QString &method) const {
    return motors_->takes(method, "client") ? QJsonObject{{"client", ownName()}} : QJsonObject();
}

void DriveControl::stop() {
    lose();
    commanded_ = {};
    isDriving_ = false;
    mustCentre_ = isAnyHeld();
    stop_.press();
    Q_EMIT stopPressed();
    Q_EMIT changed();
}

void DriveControl::release() {
    mustCentre_ = isAnyHeld();
    stop_.release();
    if (!motors_ || stop_.phase() != StopPhase::None)
        return; // whose lines ask for it
    motors_->call("motor.reset_estop", named("motor.reset_estop"), this,
                  [this](const Result<QJsonValue> &result) {
                      tell(result ? QString() : result.error().message);
                      poll();
                  });
}

void DriveControl::poll() {
    if (!motors_ || !motors_->isConnected() || isPolling_)
        return;
    isPolling_ = true;
    motors_->call("motor.state", {}, this,
                  [this, losses = losses_, asked = motors_](const Result<QJsonValue> &state) {
                      if (!asked || asked != motors_)
                          return;
                      isPolling_ = false;
                      if (losses != losses_)
                          poll();
                      else if (state)
                          onState(*state);
                  });
}

void DriveControl::onOdometry(const TopicUpdate &update) {
    ReadReport report;
    const auto odometry = readMessage<OdometryMessage>(update.data, report);
    if (!odometry)
        return tell(tr("Odometry: %1").arg(report.text()));
    measured_ = odometry->twist;
    measuredAge_.heard(odometry_.source());
    if (odometry_.source() == motors_) // no other clock is asked for
        clock_.add(update.stamp, stampNow(), motors_ ? motors_->latency_ms() / 1000 : 0);
    Q_EMIT changed();
}

void DriveControl::onState(const QJsonValue &state) {
    ReadReport report;
    auto hold = readMessage<MotionHold>(WireValue(state), report);
    if (!hold)
        return tell(tr("State of the motors: %1").arg(report.text()));
    stateAge_.heard(motors_);
    const bool wasStopped = isStopped();
    hold_ = std::move(*hold);
    if (!isDriving_ && hold_.control.holder != ownName())
        isHolding_ = false; // it ran out
    if (isStopped() && !wasStopped) {
        isDriving_ = isHolding_ = false;
        commanded_ = {};
        mustCentre_ = isAnyHeld();
    }
    Q_EMIT changed();
}

QString DriveControl::holder() const {
    if (!hold_.control.held)
        return {};
    const QString name = hold_.control.holder.value_or(QString());
    return isHolding_ && name == ownName() ? tr("you") : name;
}

QString DriveControl::wanted() const {
    return isHolding_ ? hold_.control.wanted.value_or(QString()) : QString();
}

void DriveControl::tell(const QString &problem) {
    if (problem_ == problem)
        return;
    problem_ = problem;
    Q_EMIT changed();
}

} // namespace hermes::desktop
