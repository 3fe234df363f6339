#pragma once

#include "common/interface/Interface.h"
#include "daemons/motorcontrol/LineMaster.h"

#include <QTimer>
#include <functional>

namespace hermes::motorcontrol {

/// A serial line and the master of it.
class ControllerLine : public QObject {
    Q_OBJECT
public:
    /// Takes over the interface. The controllers must outlive the line.
    /// device: of a serial line; empty: it is another one.
    ControllerLine(Interface *interface, const QString &device, std::vector<MotorController *> controllers,
                   QObject *parent);

    void open() { interface_->open(); }
    /// Called before anything is sent.
    void setGuard(std::function<void()> guard) { guard_ = std::move(guard); }
    /// Sends what is due, if the line is free. To be called when a controller wants something.
    void wake();
    const LineMaster &master() const { return master_; }
    /// What a person should do about the adapter of the line; empty when nothing.
    const QString &advice() const { return advice_; }

private:
    void receive(const QByteArray &bytes);

    Interface *interface_;
    LineMaster master_;
    std::function<void()> guard_;
    QTimer deadline_;
    QString advice_;
};

} // namespace hermes::motorcontrol
