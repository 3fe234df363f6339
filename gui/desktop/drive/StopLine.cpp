#include "gui/desktop/drive/StopLine.h"

#include "common/client/DaemonAddress.h"
#include "gui/desktop/drive/OwnName.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "protocol/messages/Motors.h"
#include "protocol/wire/Fields.h"

#include <algorithm>
#include <memory>

namespace hermes::desktop {
namespace {

/// More packets make a lost one known sooner: at first each period, after three seconds each half second.
constexpr int oftenUpTo = 60, seldom = 10;
constexpr qint64 firstRenewal_ms = 1000, lastRenewal_ms = 8000, deaf_ms = 1000, lookEach_ms = 100,
                 lookWhenConfirmed_ms = 500, lookWhenFree_ms = 1000;
constexpr qint64 overtaken_ms = 1000;
constexpr double longestWait_s = 3; // that a robot may ask for before it is released
constexpr std::chrono::milliseconds lookTimeout{500};

double seconds(const QElapsedTimer &timer) {
    return timer.isValid() ? 1e-3 * double(timer.elapsed()) : 0;
}

std::optional<StandConfirmation> confirmationIn(const QJsonValue &told) {
    ReadReport report;
    return told.isObject() ? readMessage<StandConfirmation>(WireValue(told), report) : std::nullopt;
}

} // namespace

StopLine::StopLine(DaemonLink *daemon, const QString &name, QObject *parent)
    : QObject(parent)
    , daemon_(daemon)
    , address_(daemon->address())
    , name_(name) {
    second_.setFrameLimit(DaemonLink::usualFrame);
    second_.connectTo(asOwner(address_));
    connect(&timer_, &QTimer::timeout, this, &StopLine::tick);
    timer_.start(period);
    connect(daemon, &DaemonLink::ready, this, &StopLine::readWatchdogs);
    readWatchdogs();
}

void StopLine::follow(DaemonLink *daemon) {
    if (daemon_ == daemon)
        return;
    daemon_ = daemon;
    connect(daemon, &DaemonLink::ready, this, &StopLine::readWatchdogs);
    readWatchdogs();
}

void StopLine::readWatchdogs() {
    const auto read = [this](const QString &path, double &seconds) {
        daemon_->call("settings.get", {{"path", path}}, this, [&seconds](const Result<QJsonValue> &value) {
            seconds = value ? qBound(0.0, value->toDouble(), 100.0) : 0;
        });
    };
    read("safety.command_timeout_s", commandTimeout_s_);
    read("controllers.timeout_s", controllerTimeout_s_);
    daemon_->call("settings.get", {{"path", "safety.no_device_timeout"}}, this,
                  [this](const Result<QJsonValue> &value) {
                      if (value && value->toBool()) // they may have none
                          controllerTimeout_s_ = 0;
                  });
}

std::vector<Client *> StopLine::openClients() {
    std::vector<Client *> open;
    if (daemon_ && daemon_->isConnected())
        open.push_back(&daemon_->client());
    if (second_.isConnected())
        open.push_back(&second_);
    return open;
}

QString StopLine::reason() const {
    if (phase_ == StopPhase::Pressed)
        return tr("no connection: %1").arg(shortLine(second_.problem()));
    if (!reason_.isEmpty())
        return reason_;
    return phase_ == StopPhase::Sent ? tr("it does not answer") : QString();
}

QString StopLine::watchdogs() const {
    if (commandTimeout_s_ <= 0)
        return tr("A robot with watchdogs stops by itself without commands.");
    QString text = tr("Without commands it stops by itself after %1 s").arg(commandTimeout_s_);
    if (controllerTimeout_s_ > 0)
        text += tr(", its motor controllers without it after %1 s").arg(controllerTimeout_s_);
    return text + '.';
}

// Pressed again while it is not confirmed it is late since the first time.
void StopLine::press() {
    ++press_;
    tries_ = 0;
    if (phase_ == StopPhase::None || phase_ == StopPhase::Confirmed || isWatched_) {
        pressed_.start();
        unconfirmed_.start();
        took_s_ = -1;
        reason_.clear();
    }
    isWatched_ = isReleasing_ = false;
    lastPress_.start();
    renewed_.start();
    renewAfter_ms_ = firstRenewal_ms;
    looked_.invalidate();
    enter(StopPhase::Pressed);
    tick();
}

void StopLine::watch() {
    isWatched_ = true;
    unconfirmed_.start();
    heard_.start();
    enter(StopPhase::Taken);
}

// Over all connections: one of them may be dead, and not known to be.
void StopLine::release() {
    if (phase_ == StopPhase::None)
        return;
    const std::vector<Client *> clients = openClients();
    if (clients.empty())
        return forget();
    ++press_; // what answers to a stop counts no more
    isReleasing_ = true;
    const auto waiting = std::make_shared<std::size_t>(clients.size());
    const auto released = [guard = QPointer<StopLine>(this), press = press_, waiting](const auto &done) {
        if (!guard || guard->press_ != press)
            return;
        if (done)
            return guard->forget();
        if (--*waiting > 0)
            return;
        const double wait_s = done.error().data["retry_after_s"].toDouble();
        if (!(wait_s > 0 && wait_s <= longestWait_s))
            return guard->notReleased(tr("its release was refused: %1").arg(shortLine(done.error().message)));
        QTimer::singleShot(int(wait_s * 1000) + 1, guard, [guard, press] {
            if (guard->press_ == press && guard->isReleasing_)
                guard->release();
        });
    };
    for (Client *const client : clients)
        client->call("motor.reset_estop", releaseParams(daemon_), released);
    Q_EMIT changed();
}

QJsonObject StopLine::releaseParams(const DaemonLink *daemon) {
    QJsonObject params = ownNameFor(daemon, "motor.reset_estop");
    if (daemon && daemon->takes("motor.reset_estop", "confirm"))
        params.insert("confirm", true); // by whoever sits here; the second connection has never driven
    return params;
}

// It is stopped, and not to be stopped again.
void StopLine::notReleased(const QString &why) {
    ++press_;
    isReleasing_ = false;
    isWatched_ = true;
    reason_ = why;
    enter(StopPhase::Taken);
}

void StopLine::forget() {
    ++press_;
    isWatched_ = isReleasing_ = false;
    reason_.clear();
    looked_.start();
    enter(StopPhase::None);
}

void StopLine::enter(StopPhase phase) {
    if (phase == StopPhase::Confirmed) {
        if (took_s_ < 0)
            took_s_ = seconds(pressed_);
        unconfirmed_.start();
    }
    phase_ = phase;
    Q_EMIT changed();
}

void StopLine::tick() {
    const bool isOpen = !openClients().empty();
    if (phase_ == StopPhase::None)
        return isOpen ? look() : void();
    if (isReleasing_)
        return isOpen ? Q_EMIT changed() : notReleased(tr("its release was not answered"));
    if (isWatched_ || phase_ == StopPhase::Taken || phase_ == StopPhase::Confirmed) {
        look();
        if (isOpen && heard_.elapsed() < deaf_ms)
            return;
        if (isWatched_) {
            reason_ = isOpen ? tr("it does not answer") : tr("there is no connection");
            return enter(StopPhase::Taken);
        }
        tries_ = 0;
        enter(isOpen ? StopPhase::Sent : StopPhase::Pressed); // who comes back may have forgotten it
    }
    if (!isOpen && phase_ != StopPhase::Pressed)
        enter(StopPhase::Pressed);
    if (renewed_.elapsed() > renewAfter_ms_) {
        renewed_.start();
        renewAfter_ms_ = std::min(2 * renewAfter_ms_, lastRenewal_ms); // on a slow link it needs its time
        second_.connectTo(asOwner(address_));
    }
    if (++tries_ <= oftenUpTo || tries_ % seldom == 0) {
        for (Client *const client : openClients())
            send(*client);
    }
    Q_EMIT changed(); // its age
}

void StopLine::send(Client &client) {
    if (phase_ == StopPhase::Pressed)
        enter(StopPhase::Sent);
    const auto answered = [guard = QPointer<StopLine>(this), press = press_](const auto &answer) {
        if (guard && guard->press_ == press)
            guard->onAnswer(answer);
    };
    client.call("motor.estop", ownNameFor(daemon_, "motor.estop"), answered, Client::defaultTimeout,
                Client::Repeats::AtOnce);
}

void StopLine::onAnswer(const Result<QJsonValue> &answer) {
    if (phase_ == StopPhase::Taken || phase_ == StopPhase::Confirmed)
        return;
    if (!answer) {
        if (!answer.error().is(ErrorCode::Disconnected) && !answer.error().is(ErrorCode::TimedOut))
            reason_ = shortLine(answer.error().message); // it is there, and refuses
        return;
    }
    reason_.clear();
    heard_.start();
    const auto told = confirmationIn(*answer);
    enter(told && told->confirmed ? StopPhase::Confirmed : StopPhase::Taken);
    look();
}

// Asked of whoever is connected: the answer to the stop itself came before the robot could stand.
void StopLine::look() {
    const qint64 pause = phase_ == StopPhase::None        ? lookWhenFree_ms
                         : phase_ == StopPhase::Confirmed ? lookWhenConfirmed_ms
                                                          : lookEach_ms;
    if (looked_.isValid() && looked_.elapsed() < pause)
        return;
    if (phase_ == StopPhase::None && daemon_ && !daemon_->hasMethod("motor.state"))
        return; // it has nothing to tell
    looked_.start();
    const auto seen = [guard = QPointer<StopLine>(this), press = press_](const auto &state) {
        if (guard && guard->press_ == press)
            guard->onState(state);
    };
    for (Client *const client : openClients())
        client->call("motor.state", QJsonObject(), seen, lookTimeout);
}

void StopLine::onState(const Result<QJsonValue> &state) {
    const QJsonValue latched = state ? (*state)["latched"] : QJsonValue();
    const bool holds = !latched.toObject().isEmpty(); // a stop of any kind
    if (phase_ == StopPhase::None)
        return holds ? watch() : void();
    if (phase_ != StopPhase::Taken && phase_ != StopPhase::Confirmed)
        return;
    if (!state)
        return; // the other connection may tell
    heard_.start();
    if (latched.isObject() && !(isWatched_ ? holds : latched.toObject().contains("estop"))) {
        if (isWatched_ || lastPress_.elapsed() > overtaken_ms)
            return forget(); // somebody has released it
        tries_ = 0;          // a release that was on its way may have come behind the stop
        return enter(StopPhase::Sent);
    }
    const auto told = confirmationIn((*state)["standing"]);
    reason_ = told ? shortLine(told->text) : tr("it does not tell whether the robot stands");
    enter(told && told->confirmed ? StopPhase::Confirmed : StopPhase::Taken);
}

} // namespace hermes::desktop
