#include "gui/desktop/drive/DriveControl.h"

#include "common/Time.h"
#include "gui/desktop/drive/OwnName.h"
#include "gui/desktop/drive/StopLine.h"
#include "gui/desktop/widgets/ForeignText.h"
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
    , sessions_(fleet) {
    connect(&sessions_, &Sessions::replayChanged, this, &DriveControl::onReplay);
    connect(&odometry_, &TopicFeed::sourceChanged, this, [this] {
        measured_ = {};
        measuredAge_.forget();
        Q_EMIT changed();
    });
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &DriveControl::tick);
    letGo_.setTimerType(Qt::PreciseTimer);
    letGo_.setSingleShot(true);
    connect(&letGo_, &QTimer::timeout, this, [this] {
        if (isDriving_ && !inputs_.isAnyHeld())
            end();
    });
    connect(&pollTimer_, &QTimer::timeout, this, &DriveControl::poll);
    connect(&stop_, &StopControl::changed, this, [this] {
        const StopPhase before = std::exchange(shownPhase_, stop_.phase());
        if (before != shownPhase_ && shownPhase_ == StopPhase::None)
            poll(); // what else holds the robot
        Q_EMIT changed();
    });
    connect(&confirmation_, &SecondPress::changed, this, &DriveControl::changed);
    connect(&fleet, &Fleet::changed, this, &DriveControl::follow);
    connect(&fleet, &Fleet::robotChosen, this, [this] {
        isBlindMeant_ = false; // that was said of another
        confirmation_.forget();
        follow();
        onReplay();
    });
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
    if (motors_)
        motors_->disconnect(this);
    settings_.reset();
    motors_ = found;
    if (found && found != driven_) { // the limit is another robot's
        most_ = usualMost;
        limit_ = scaled(usualMost, usualShare);
        if (const QJsonValue kept = limits_.value(found->address()); kept.isArray())
            limit_ = {qMax(0.0, kept[0].toDouble()), qMax(0.0, kept[1].toDouble()),
                      qMax(0.0, kept[2].toDouble())};
    }
    if (found)
        driven_ = found;
    hold_ = {};
    measured_ = target_ = {};
    measuredAge_.forget();
    stateAge_.forget();
    isHolding_ = isAsking_ = isPolling_ = false;
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
    if (stop_.isPressedFor(&robot))
        return tr("STOP was pressed for %1: release it first.").arg(robot.name());
    return {};
}

void DriveControl::takeMost(const QJsonValue &motion) {
    const auto most = [&](const char *name, double usual) { // m/s or rad/s
        return qBound(0.0, motion[QLatin1String(name)].toDouble(usual), 100.0);
    };
    most_ = {most("vx", most_.vx), most("vy", most_.vy), most("omega", most_.omega)};
    if (driven_ && !limits_.contains(driven_->address()) && !inputs_.isAnyHeld())
        putLimit(scaled(most_, usualShare)); // nobody has set one yet
    else
        putLimit(least(limit_, most_));
}

void DriveControl::steer(const QString &input, const Twist2D &request, bool isHeld) {
    inputs_.steer(input, request, isHeld);
    if (isHeld)
        fleet_.keepChoice();
    if (inputs_.isAnyHeld())
        letGo_.stop();
    else if (isDriving_ && !letGo_.isActive())
        letGo_.start(repeatGap);
}

bool DriveControl::setLimit(double share) {
    const Twist2D wanted = scaled(most_, qBound(0.0, share, 1.0));
    const bool isRaised = wanted.vx > limit_.vx || wanted.vy > limit_.vy || wanted.omega > limit_.omega;
    const bool isRefused = isRaised && inputs_.isAnyHeld();
    putLimit(isRefused ? least(limit_, wanted) : wanted);
    return !isRefused;
}

void DriveControl::putLimit(const Twist2D &limit) {
    limit_ = limit;
    if (driven_)
        limits_[driven_->address()] = QJsonArray{limit.vx, limit.vy, limit.omega};
    Q_EMIT changed();
}

Twist2D DriveControl::request() const {
    const Twist2D share = inputs_.request();
    const double vx = share.vx * limit_.vx, omega = share.omega * limit_.omega;
    const double turn = leastRadius_ > 0 ? std::abs(vx) / leastRadius_ : limit_.omega;
    return {vx, movesSideways_ ? share.vy * limit_.vy : 0, qBound(-turn, omega, turn)};
}

void DriveControl::driveBlindly() {
    isBlindMeant_ = true;
    inputs_.needRest();
    tell({});
    Q_EMIT changed();
}

// A drive that is under way when a replay begins ends: what is seen from now on is not what is.
void DriveControl::onReplay() {
    if (!sessions_.isReplaying())
        isBlindMeant_ = false;
    else if (refusesForReplay())
        inputs_.needRest();
    Q_EMIT changed();
}

void DriveControl::tick() {
    // After a time in which this program stood still, what was let go meanwhile is not known as yet.
    const bool isLate = ticked_.isValid() && ticked_.hasExpired(3 * period.count());
    ticked_.start();
    if (isLate)
        QTimer::singleShot(1, this, &DriveControl::turn); // behind it
    else
        turn();
}

void DriveControl::turn() {
    const bool hadToRest = mustLetGo();
    inputs_.tick();
    if (hadToRest && !mustLetGo())
        Q_EMIT changed();
    const bool isHeld = inputs_.isAnyHeld();
    if (isHeld && refusesForReplay())
        inputs_.needRest();
    if (isDriving_ && answered_.hasExpired(qint64(1000 * lease_s))) { // the control has run out
        halt(tr("The drive has ended: %1 did not answer.").arg(shortLine(motors_->name())));
    }
    const bool wants = isHeld && !mustLetGo() && motors_ && motors_->isConnected() && !isStopped();
    if (!wants) {
        if (isDriving_ && isHeld)
            halt();
        else if (isDriving_ && !letGo_.isActive())
            end();
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
                      heldProblem_ = problem_;
                      if (!result)
                          inputs_.needRest();
                      else if (!takeOver && (!inputs_.isAnyHeld() || mustLetGo()))
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
    if (!std::exchange(isDriving_, true))
        answered_.start();
    commanded_ = request();
    const QJsonObject command{{"vx", commanded_.vx},
                              {"vy", commanded_.vy},
                              {"omega", commanded_.omega},
                              {"stamp", stampNow() + clock_.seconds()}};
    const auto done = [this, guard = QPointer<DriveControl>(this)](const Result<QJsonValue> &result) {
        if (!guard)
            return;
        answered_.start();
        if (!isDriving_)
            return; // it was on its way when the drive ended, which has its reason
        if (result)
            return tell({});
        if (result.error().is(ErrorCode::ControlHeld))
            heldProblem_ = result.error().message, yieldControl();
        else if (!result.error().is(ErrorCode::NotReady)) // one that is late is refused alone
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
    if (isHolding_) {
        hold_.control.held = false;
        lost_.start();
    }
    isHolding_ = false;
    ++losses_;
}

/// To who has taken it over: the robot was stopped by that, and a stop from here would be one of their drive.
void DriveControl::yieldControl() {
    isDriving_ = false;
    lose();
    halt();
    poll();
}

void DriveControl::halt(const QString &reason) {
    end();
    inputs_.needRest();
    if (!reason.isEmpty())
        tell(reason);
    Q_EMIT changed();
}

/// Because it was let go: the next press counts at once.
void DriveControl::end() {
    commanded_ = target_ = {};
    if (isDriving_ && motors_) {
        // Calls, which are repeated where frames are lost.
        motors_->client().call(
            "motor.stop", ownNameFor(motors_, "motor.stop"), [](const auto &) {}, Client::defaultTimeout,
            Client::Repeats::AtOnce);
        giveBack();
    }
    isDriving_ = isHolding_ = false;
    Q_EMIT changed();
}

void DriveControl::stop() {
    lose();
    commanded_ = {};
    isDriving_ = false;
    inputs_.needRest();
    confirmation_.forget();
    stop_.press();
    Q_EMIT stopPressed();
    Q_EMIT changed();
}

void DriveControl::release() {
    inputs_.needRest();
    if (!stop_.isPressedFor(fleet_.robot()) && hold_.latched.contains("estop") && !confirmation_.press())
        return;
    stop_.release();
    if (!motors_ || stop_.phase() != StopPhase::None)
        return; // whose lines ask for it
    motors_->call("motor.reset_estop", StopLine::releaseParams(motors_), this,
                  [this](const Result<QJsonValue> &result) {
                      tell(result ? QString() : result.error().message);
                      poll();
                  });
}

void DriveControl::tell(const QString &problem) {
    if (problem_ == problem)
        return;
    problem_ = problem;
    Q_EMIT changed();
}

} // namespace hermes::desktop
