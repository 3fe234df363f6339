#include "gui/desktop/drive/LatchWatch.h"

#include "gui/desktop/widgets/ForeignText.h"

#include <memory>

namespace hermes::desktop {

LatchWatch::LatchWatch(Fleet &fleet, QObject *parent)
    : QObject(parent)
    , fleet_(fleet) {
    timer_.setInterval(period);
    connect(&timer_, &QTimer::timeout, this, [this] {
        if (isLooking_)
            return; // on a slow link answers take longer
        isLooking_ = true;
        look([this] { isLooking_ = false; });
    });
}

void LatchWatch::begin(const QSet<QString> &robots) {
    end();
    robots_ = robots;
    timer_.start();
}

void LatchWatch::end() {
    ++turn_;
    timer_.stop();
    robots_.clear();
    causes_.clear();
    hasBegun_ = isLooking_ = false;
}

std::vector<DaemonLink *> LatchWatch::motors() const {
    std::vector<DaemonLink *> all;
    for (const QString &address : robots_)
        if (const Robot *const robot = fleet_.robotAt(address))
            for (DaemonLink *const daemon : robot->allWithMethod("motor.estop"))
                if (daemon->hasMethod("motor.state"))
                    all.push_back(daemon);
    return all;
}

void LatchWatch::look(const std::function<void()> &done) {
    const auto waiting = std::make_shared<int>(1);
    const auto answered = [this, waiting, done] {
        if (--*waiting > 0)
            return;
        hasBegun_ = true;
        done();
    };
    for (DaemonLink *const daemon : motors()) {
        ++*waiting;
        const auto take = [guard = QPointer<LatchWatch>(this), link = QPointer<DaemonLink>(daemon),
                           turn = turn_, answered](const Result<QJsonValue> &state) {
            if (guard && guard->turn_ == turn && (!link || guard->take(*link, state)))
                answered();
        };
        daemon->client().call("motor.state", QJsonObject(), take, timeout);
    }
    answered();
}

// One that comes only now was not seen before: whatever holds it may be a stop.
bool LatchWatch::take(const DaemonLink &motors, const Result<QJsonValue> &state) {
    if (!state && state.error().is(ErrorCode::Disconnected))
        return true; // nobody is moved by it
    if (!state) {
        Q_EMIT stopped(tr("%1 does not tell whether the robot is stopped: %2")
                           .arg(fleet_.titleOf(motors), shortLine(state.error().message)));
        return false;
    }
    const QStringList told = (*state)["latched"].toObject().keys();
    const QSet<QString> causes(told.begin(), told.end());
    const bool isKnown = hasBegun_ || causes_.contains(motors.address());
    const QSet<QString> before = std::exchange(causes_[motors.address()], causes);
    if (!isKnown || before.contains(causes))
        return true;
    Q_EMIT stopped(stopOf(motors));
    return false;
}

QString LatchWatch::stopOf(const DaemonLink &motors) const {
    const Robot *const robot = fleet_.robotOf(&motors);
    return robot && fleet_.robots().size() > 1 ? tr("STOP of %1").arg(shortLine(fleet_.titleOf(*robot)))
                                               : tr("STOP");
}

} // namespace hermes::desktop
