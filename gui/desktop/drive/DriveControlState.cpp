// What the drive control knows of the robot's state: who holds it, what stops it, how fast it is.
#include "common/Time.h"
#include "gui/desktop/drive/DriveControl.h"
#include "gui/desktop/drive/OwnName.h"
#include "protocol/wire/Fields.h"

#include <QRegularExpression>

namespace hermes::desktop {
namespace {
/// Why a robot is stopped, as a person says it: who it was by name and host, without the addresses of
/// sockets. isOurs: this window has stopped it.
QString readableStop(const QString &reason, bool isOurs) {
    static const QString by = "emergency stop by ";
    if (isOurs && reason.startsWith(by + ownName()))
        return by + QObject::tr("you (this window)");
    static const QRegularExpression here(
        R"([a-z]+://(?:@[a-z]+:)?(127\.\S+|localhost|\[::1\]):\d+( \([^)]*\))?)"),
        behindAName(R"(, [a-z]+://\S+( \([^)]*\))?)"),
        alone(R"([a-z]+://(?:@[a-z]+:)?(\S+):\d+( \([^)]*\))?)");
    QString text = reason;
    text.remove(behindAName);
    text.replace(here, QObject::tr("a program on the robot's own computer"));
    return text.replace(alone, QObject::tr("a program on \\1"));
}
} // namespace

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
    if (update.replayed)
        return;
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
    const bool wasStopped = isStopped(), wasLatched = !hold_.latched.isEmpty();
    hold_ = std::move(*hold);
    if (!isHolding_ && hold_.control.holder == ownName() && lost_.isValid() &&
        !lost_.hasExpired(qint64(1000 * lease_s)))
        hold_.control.held = false; // the state is older than the release
    movesSideways_ = state["moves_sideways"].toBool(true);
    leastRadius_ = state["least_radius_m"].toDouble();
    target_ = readMessage<Twist2D>(WireValue(state["target"]), report).value_or(Twist2D());
    if (!isDriving_ && hold_.control.holder != ownName())
        isHolding_ = false; // it ran out
    if (isStopped() && !wasStopped) {
        isDriving_ = isHolding_ = false;
        commanded_ = {};
        inputs_.needRest();
    }
    if ((wasLatched && hold_.latched.isEmpty()) || (!hold_.control.held && problem_ == heldProblem_))
        tell({}); // what was refused because of it
    Q_EMIT changed();
}

QString DriveControl::stopReason() const {
    QStringList reasons;
    const bool isOurs = stop_.isPressedFor(fleet_.robot());
    for (const QString &reason : hold_.latched)
        reasons.append(readableStop(reason, isOurs));
    return reasons.join("; ");
}

bool DriveControl::isStanding() const {
    constexpr double slowest = 0.02; // m/s or rad/s
    const bool isMoving = measuredAge_.isFresh() && std::max(std::hypot(measured_.vx, measured_.vy),
                                                             std::abs(measured_.omega)) > slowest;
    return stop_.phase() == StopPhase::Confirmed && !isMoving;
}

bool DriveControl::isHeldByOther() const {
    return !holder().isEmpty() && !(isHolding_ && hold_.control.holder == ownName());
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
} // namespace hermes::desktop
