#pragma once

#include "daemons/simulator/Drivetrain.h"

#include <QSemaphore>
#include <QStringList>
#include <QTemporaryDir>
#include <QThread>
#include <memory>
#include <mutex>

namespace hermes {

class Daemon;

/// A robot in the test's own process: the motor control itself, in a thread of its own, and emulated
/// controllers at the far end of a line of which only the time that bytes take is left. No program is
/// started, no serial line is opened, and the controllers run in the thread that drives: they do not answer
/// too late while that one is on time.
class FakeRobot {
public:
    /// Ready to drive. Settings as `path=value`; its client may be silent for 1 s.
    explicit FakeRobot(const QStringList &settings = {});
    ~FakeRobot();

    quint16 port() const { return port_; }
    QString address() const { return QString("127.0.0.1:%1").arg(port_); }
    /// Ends the motor control: all connections are gone. start() makes another one at the same port.
    void end();
    void start();
    /// Both its threads stand still, as SIGSTOP makes them; until thaw().
    void freeze();
    void thaw();
    /// The controllers answer no more, and again.
    void setSilent(bool silent);
    /// Works on the motors while their time stands.
    template <typename Work>
    auto with(const Work &work) {
        const std::lock_guard lock(mutex_);
        advance();
        return work(motors_);
    }

private:
    class Line;

    template <typename Work>
    void inThread(const Work &work);
    /// Lets the time pass that has passed.
    void advance();

    const QStringList settings_;
    const QTemporaryDir state_; // an emergency stop of one is none of the next
    const quint16 port_;
    std::mutex mutex_;
    simulator::Drivetrain motors_;
    double last_;
    bool isSilent_ = false;
    bool isFrozen_ = false;
    QSemaphore thawing_;
    QThread thread_;
    QObject home_;             // lives in it
    Daemon *daemon_ = nullptr; // lives in it
    QObject *line_ = nullptr;  // lives in the thread that drives
};

} // namespace hermes
