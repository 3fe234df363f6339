#pragma once

#include "common/client/Client.h"
#include "common/client/ClockOffset.h"

#include <QElapsedTimer>
#include <functional>
#include <optional>

namespace hermes {

/// Turns one wheel of a lifted robot slowly for a second and measures what its encoder tells: the angle
/// between two readings over the time between them, by the robot's clock, however late they come. It takes
/// the control, sends the speed at the rate that the watchdog of the motor control needs, stops, and gives
/// the control back.
class WheelTurn : public QObject {
    Q_OBJECT
public:
    static constexpr double turn_s = 1;
    /// Called once, when the robot stands: the mean speed in rad/s, or why the turn ended early.
    using Done = std::function<void(const Result<double> &)>;

    /// motors: the client of a motor control; holder: what others see who has the control; timeout: with
    /// the connection and with controllers that are not found yet.
    WheelTurn(Client &motors, QString holder, std::chrono::milliseconds timeout, QObject *parent = nullptr);

    /// One turn at a time; speed in rad/s.
    void begin(const QString &wheel, double speed, const Done &done);
    bool isBusy() const { return done_ != nullptr; }
    /// The control was asked for, and nobody knows yet whether it was given.
    bool isAcquiring() const { return isAcquiring_; }
    /// The robot stops; the turn ends with an error.
    void giveUp();

private:
    enum class Phase { Standing, Preparing, Turning, Stopping };

    void awaitReady();
    void acquire();
    void onOdometry(const TopicUpdate &update);
    void onWheels(const TopicUpdate &update);
    void tick();
    void fail(const Error &error);
    void stop();
    void release();
    void finish();
    void call(const QString &method, const QJsonObject &params, const Client::Callback &answered,
              std::chrono::milliseconds timeout, Client::Repeats repeats = Client::Repeats::Usual);
    /// From the first reading to the last.
    double measured_s() const { return first_ ? last_.stamp - first_->stamp : 0; }
    Result<double> measured() const;

    Client &motors_;
    const QString holder_;
    const std::chrono::milliseconds timeout_;
    QTimer timer_;
    QElapsedTimer waiting_, turning_;
    QString wheel_;
    double speed_ = 0; // rad/s
    Done done_;
    Phase phase_ = Phase::Standing;
    ClockOffset clock_;
    double latency_s_ = 0;
    bool isClockKnown_ = false, isAcquiring_ = false, isHolding_ = false;
    int odometry_ = 0, wheels_ = 0; // subscriptions
    std::optional<double> begin_;   // of the turn, by the robot's clock
    /// Of the wheel while it turned with the speed that was asked for.
    struct Reading {
        double stamp, angle;
    };
    std::optional<Reading> first_;
    Reading last_{};
    Result<void> failure_;
};

} // namespace hermes
