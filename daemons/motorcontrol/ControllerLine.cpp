#include "daemons/motorcontrol/ControllerLine.h"

#include "common/Time.h"
#include "common/interface/AdapterLatency.h"

#include <algorithm>
#include <cmath>

namespace hermes::motorcontrol {
namespace {

constexpr std::chrono::milliseconds longestRetry{250}; // the robot stands until the line is back

} // namespace

ControllerLine::ControllerLine(Interface *interface, const QString &device,
                               std::vector<MotorController *> controllers, QObject *parent)
    : QObject(parent)
    , interface_(interface)
    , master_(std::move(controllers)) {
    interface_->setParent(this);
    interface_->setReconnecting(true);
    interface_->setLongestRetry(longestRetry);
    deadline_.setTimerType(Qt::PreciseTimer);
    deadline_.setSingleShot(true);
    connect(&deadline_, &QTimer::timeout, this, &ControllerLine::wake);
    connect(interface_, &Interface::received, this, &ControllerLine::receive);
    connect(interface_, &Interface::opened, this, [this, device] {
        advice_ = device.isEmpty() ? QString() : AdapterLatency::lower(device).advice;
        master_.setOpen();
        wake();
    });
    connect(interface_, &Interface::closed, this,
            [this](const QString &reason) { master_.setClosed(reason); });
}

void ControllerLine::wake() {
    if (!interface_->isOpen())
        return;
    if (guard_)
        guard_();
    const double now = monotonicNow();
    if (const drive::Bytes *out = master_.poll(now)) {
        interface_->write(QByteArray(reinterpret_cast<const char *>(out->data()), int(out->size())));
        interface_->flush();
    }
    const double wait = master_.deadline() - now;
    if (std::isfinite(wait))
        deadline_.start(std::max(0, int(std::ceil(1000 * wait))));
}

void ControllerLine::receive(const QByteArray &bytes) {
    master_.feed(reinterpret_cast<const std::uint8_t *>(bytes.constData()), size_t(bytes.size()),
                 monotonicNow());
    wake();
}

} // namespace hermes::motorcontrol
