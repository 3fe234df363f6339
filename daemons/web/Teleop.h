#pragma once

#include "common/client/Client.h"
#include "common/client/ClockOffset.h"
#include "protocol/messages/Motion.h"

namespace hermes::web {

/// Drives the robot as a panel says that tells its wish now and then, and tells nothing when it is let go. It
/// has a connection of its own, so that the motor control stops the robot when this program ends. It takes
/// the control from nobody. Whatever ends a drive but letting go (a refusal, a stop of somebody else), the
/// panel must be let go before it counts again.
class Teleop : public QObject {
    Q_OBJECT
public:
    using Tell = std::function<void(const QString &why)>;

    /// deadMan_s: after so long without a wish the robot stops. tell: why it does not drive, for people.
    Teleop(const QString &address, const QString &name, double deadMan_s, Tell tell);
    /// Stops the robot if it was driven by this.
    ~Teleop() override;

    const QString &address() const { return address_; }
    void steer(const Twist2D &wish);

private:
    enum class State { Idle, Asking, Driving };

    void acquire();
    void tick();
    void onAnswer(const Result<QJsonValue> &result);
    /// The robot stops, and is free for others.
    void end();
    void halt(const QString &why);

    const QString address_, name_;
    const double deadMan_s_;
    const Tell tell_;
    Client client_;
    ClockOffset clock_;
    bool hasClock_ = false;
    QTimer timer_;
    State state_ = State::Idle;
    bool mustRest_ = false;
    Twist2D wish_;
    double wished_ = 0, answered_ = 0, ticked_ = 0; ///< monotonic
};

} // namespace hermes::web
