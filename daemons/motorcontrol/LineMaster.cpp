#include "daemons/motorcontrol/LineMaster.h"

namespace hermes {

using roboclaw::Bus;
using Task = MotorController::Task;

namespace {

// A request is not repeated as it is: what is due then is newer.
Bus::Options withoutRepetition() {
    Bus::Options options;
    options.retries = 0;
    return options;
}

} // namespace

LineMaster::LineMaster(std::vector<MotorController *> controllers)
    : controllers_(std::move(controllers))
    , bus_(withoutRepetition()) {
    bus_.setOpen(false);
}

void LineMaster::setOpen() {
    bus_.setOpen(true);
}

void LineMaster::setClosed(const QString &reason) {
    bus_.setOpen(false);
    for (MotorController *controller : controllers_)
        controller->lineClosed(reason);
}

const roboclaw::Bytes *LineMaster::poll(double now) {
    now_ = now;
    bus_.cancel();  // what was not sent yet is chosen anew
    bus_.poll(now); // ends what is late
    if (bus_.isIdle())
        submitNext();
    return bus_.poll(now);
}

void LineMaster::feed(const std::uint8_t *data, std::size_t size, double now) {
    now_ = now;
    bus_.feed(data, size, now);
}

void LineMaster::submitNext() {
    // One that does not answer waits until the others have what they need: each failure takes 40 ms.
    for (const bool failing : {false, true}) {
        for (int task = 0; task < MotorController::taskCount; ++task) {
            for (MotorController *controller : controllers_) {
                if (controller->isFailing() == failing && submit(*controller, Task(task)))
                    return;
            }
        }
    }
}

bool LineMaster::submit(MotorController &controller, Task task) {
    const auto request = controller.next(task, now_);
    if (request)
        bus_.submit(*request,
                    [this, &controller, task](const roboclaw::Request &, const Bus::Outcome &outcome) {
                        controller.finished(task, outcome, now_);
                    });
    return request.has_value();
}

} // namespace hermes
