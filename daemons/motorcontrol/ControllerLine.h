#pragma once

#include "common/interface/Interface.h"
#include "daemons/motorcontrol/MotorController.h"

#include <QTimer>
#include <vector>

namespace hermes {

/// A serial line with one or more controllers on it. Asks one thing at a time, the most urgent one first:
/// what is sent is made when the line is free, so that no outdated set-point waits in a queue.
class ControllerLine : public QObject {
    Q_OBJECT
public:
    /// Takes over the interface. The controllers must outlive the line.
    ControllerLine(Interface *interface, std::vector<MotorController *> controllers, QObject *parent);

    void open() { interface_->open(); }
    /// Sends what is due, if the line is free. To be called when a controller wants something.
    void wake();
    const roboclaw::Bus::Counts &counts(const MotorController &controller) const {
        return bus_.counts(controller.address());
    }
    quint64 strayBytes() const { return bus_.strayBytes(); }
    const Interface &interface() const { return *interface_; }

Q_SIGNALS:
    void closed(const QString &reason);

private:
    void submitNext(double now);
    bool submit(MotorController &controller, MotorController::Task task, double now);
    void receive(const QByteArray &bytes);

    Interface *interface_;
    std::vector<MotorController *> controllers_;
    roboclaw::Bus bus_;
    QTimer deadline_;
};

} // namespace hermes
