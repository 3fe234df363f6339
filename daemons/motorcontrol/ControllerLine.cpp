#include "daemons/motorcontrol/ControllerLine.h"

#include "common/Time.h"

#include <algorithm>
#include <cmath>

namespace hermes {

using roboclaw::Bus;
using Task = MotorController::Task;

namespace {

constexpr std::chrono::milliseconds longestRetry{250}; // the robot stands until the line is back

// A request is not repeated as it is: what is due then is newer.
Bus::Options withoutRepetition() {
    Bus::Options options;
    options.retries = 0;
    return options;
}

} // namespace

ControllerLine::ControllerLine(Interface *interface, std::vector<MotorController *> controllers,
                               QObject *parent)
    : QObject(parent)
    , interface_(interface)
    , controllers_(std::move(controllers))
    , bus_(withoutRepetition()) {
    interface_->setParent(this);
    interface_->setReconnecting(true);
    interface_->setLongestRetry(longestRetry);
    bus_.setOpen(false);
    deadline_.setTimerType(Qt::PreciseTimer);
    deadline_.setSingleShot(true);
    connect(&deadline_, &QTimer::timeout, this, &ControllerLine::wake);
    connect(interface_, &Interface::received, this, &ControllerLine::receive);
    connect(interface_, &Interface::opened, this, [this] {
        bus_.setOpen(true);
        wake();
    });
    connect(interface_, &Interface::closed, this, [this](const QString &reason) {
        bus_.setOpen(false);
        for (MotorController *controller : controllers_)
            controller->lineClosed(reason);
        Q_EMIT closed(reason);
    });
}

void ControllerLine::submitNext(double now) {
    // One that does not answer waits until the others have what they need: each failure takes 40 ms.
    for (const bool failing : {false, true}) {
        for (int task = 0; task < MotorController::taskCount; ++task) {
            for (MotorController *controller : controllers_) {
                if (controller->isFailing() == failing && submit(*controller, Task(task), now))
                    return;
            }
        }
    }
}

bool ControllerLine::submit(MotorController &controller, Task task, double now) {
    const auto request = controller.next(task, now);
    if (request)
        bus_.submit(*request, [&controller, task](const roboclaw::Request &, const Bus::Outcome &outcome) {
            controller.finished(task, outcome, monotonicNow());
        });
    return request.has_value();
}

void ControllerLine::wake() {
    if (!interface_->isOpen())
        return;
    const double now = monotonicNow();
    bus_.cancel();  // what was not sent yet is chosen anew
    bus_.poll(now); // ends what is late
    if (bus_.isIdle())
        submitNext(now);
    if (const roboclaw::Bytes *out = bus_.poll(now)) {
        interface_->write(QByteArray(reinterpret_cast<const char *>(out->data()), int(out->size())));
        interface_->flush();
    }
    const double wait = bus_.deadline() - now;
    if (std::isfinite(wait))
        deadline_.start(std::max(0, int(std::ceil(1000 * wait))));
}

void ControllerLine::receive(const QByteArray &bytes) {
    bus_.feed(reinterpret_cast<const std::uint8_t *>(bytes.constData()), size_t(bytes.size()),
              monotonicNow());
    wake();
}

} // namespace hermes
