#include "gui/desktop/model/DaemonLink.h"

#include "common/OwnRobot.h"
#include "common/Project.h"
#include "common/Role.h"
#include "common/client/DaemonAddress.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "protocol/wire/Fields.h"

#include <QJsonArray>
#include <QPointer>

namespace hermes::desktop {
namespace {

constexpr int longestTold = 40;
constexpr double usualRate_hz = 100;

int severity(const HealthItem &item) {
    return item.level == "error" ? 3 : item.level == "stale" ? 2 : item.level == "warn" ? 1 : 0;
}

HealthItem worstItem(const DaemonStatus &status) {
    HealthItem worst;
    for (const HealthItem &item : status.health)
        if (severity(item) > severity(worst))
            worst = item;
    return worst;
}

Client::Callback whileThere(QObject *context, const Client::Callback &done) {
    return [done, guard = QPointer<QObject>(context)](const Result<QJsonValue> &result) {
        if (guard)
            done(result);
    };
}

} // namespace

DaemonLink::DaemonLink(const QString &address, QObject *parent)
    : QObject(parent)
    , address_(address) {
    ++links_;
    client_.prefer("cbor");
    client_.setFrameLimit(usualFrame);
    connect(&client_, &Client::connected, this, &DaemonLink::onConnected);
    connect(&client_, &Client::disconnected, this, [this] {
        isPolling_ = false;
        silence_.stop();
        Q_EMIT changed();
    });
    connect(&timer_, &QTimer::timeout, this, &DaemonLink::poll);
    timer_.start(pollPeriod);
    silence_.setInterval(100);
    connect(&silence_, &QTimer::timeout, this, [this] {
        if (isSilent())
            Q_EMIT changed();
    });
    client_.connectTo(asOwner(address));
    begin("status", {{"max_rate_hz", 10}}, [this](const TopicUpdate &update) { onStatus(update.data); });
}

QString DaemonLink::name() const {
    for (const QString &told : {info_.name, supervisedName_})
        if (const QString name = shortLine(told, longestTold); !name.isEmpty())
            return name;
    for (const QString &known : daemonNames())
        if (defaultPort(known) == port())
            return known;
    return address_;
}

QString DaemonLink::identity() const {
    return info_.pid > 0 ? QString("%1 %2 %3 %4")
                               .arg(info_.pid)
                               .arg(info_.started, 0, 'f', 3)
                               .arg(name(), shortLine(info_.host))
                         : QString();
}

QString DaemonLink::refusal(const QString &name) const {
    const auto needed = roleFrom(method(name)["x-role"].toString()), has = roleFrom(info_.role);
    if (!needed || !has || *has >= *needed)
        return {};
    return tr("This is for the role %1, you have %2").arg(toString(*needed), info_.role);
}

bool DaemonLink::takes(const QString &name, const QString &param) const {
    const QJsonArray params = method(name)["params"].toArray();
    return std::any_of(params.begin(), params.end(),
                       [&](const QJsonValue &one) { return one["name"] == QJsonValue(param); });
}

QString DaemonLink::title() const {
    const QString title = shortLine(info_.title);
    return title.isEmpty() ? name() : title;
}

double DaemonLink::latency_ms() const {
    if (!isConnected())
        return -1;
    return isPolling_ ? std::max(latency_ms_, double(asked_.elapsed())) : latency_ms_;
}

bool DaemonLink::isSilent() const {
    return isConnected() && isPolling_ && double(asked_.elapsed()) > std::max(500.0, 3 * latency_ms_);
}

Condition DaemonLink::condition() const {
    if (!isConnected() || isSilent())
        return Condition::Unreachable;
    const QString &state = status_.state;
    const int worst = qMax(severity(worst_), isUnderstood() ? 0 : 1);
    if (state == "fault" || worst == 3)
        return Condition::Fault;
    if (state == "degraded" || worst > 0)
        return Condition::Warning;
    return state == "ready" || state == "running" ? Condition::Ready : Condition::Busy;
}

QString DaemonLink::conditionWord() const {
    const Condition now = condition();
    if (now == Condition::Unreachable)
        return isSilent() ? tr("no answer for %1 s").arg(0.001 * latency_ms(), 0, 'f', 0) : tr("unreachable");
    const QString state = shortLine(status_.state, longestTold);
    if (now == Condition::Warning && state != "degraded")
        return tr("warning");
    if (now == Condition::Fault && state != "fault")
        return tr("error");
    return state.isEmpty() ? tr("connecting") : state;
}

QString DaemonLink::reason() const {
    QStringList lines;
    if (!isConnected())
        lines.append(client_.problem());
    else if (severity(worst_) > 0)
        lines.append(shortLine(worst_.name + ": " + worst_.message));
    if (isConnected() && !nonsense_.isEmpty())
        lines.append(nonsense_);
    const Client::Rejected &rejected = client_.rejected();
    if (rejected.unreadable > 0)
        lines.append(tr("Messages that could not be read: %1 (%2)")
                         .arg(rejected.unreadable)
                         .arg(shortLine(rejected.last)));
    if (rejected.unasked > 0)
        lines.append(tr("Messages that nobody waits for: %1").arg(rejected.unasked));
    return lines.join(".\n"); // sentences, also where they are put in one line
}

bool DaemonLink::isUnderstood() const {
    return nonsense_.isEmpty() && client_.rejected().unreadable == 0;
}

void DaemonLink::call(const QString &method, const QJsonObject &params, QObject *context,
                      const Client::Callback &done, Client::Repeats repeats) {
    client_.call(method, params, whileThere(context, done), Client::defaultTimeout, repeats);
}

void DaemonLink::callForMuch(const QString &method, const QJsonObject &params, QObject *context,
                             const Client::Callback &done) {
    client_.callForMuch(method, params, whileThere(context, done));
}

Subscription DaemonLink::subscribe(const QString &topic, const QJsonObject &options,
                                   const Client::TopicCallback &callback) {
    const int handle = begin(topic, options, callback);
    return {nullptr, [link = QPointer<DaemonLink>(this), handle](const void *) {
                if (link)
                    link->unsubscribe(handle);
            }};
}

int DaemonLink::begin(const QString &topic, const QJsonObject &options,
                      const Client::TopicCallback &callback) {
    if (options.contains("queue"))
        return client_.subscribe(topic, options, callback);
    const double rate_hz = options["max_rate_hz"].toDouble(usualRate_hz);
    // Half of the time between: what comes a little early is not to wait for the next period.
    auto *const gate = new NewestOnly(std::chrono::milliseconds(int(500 / rate_hz)), callback, this);
    const int handle =
        client_.subscribe(topic, options, [gate](const TopicUpdate &update) { gate->take(update); });
    gates_.insert(handle, gate);
    return handle;
}

void DaemonLink::unsubscribe(int handle) {
    client_.unsubscribe(handle);
    if (NewestOnly *const gate = gates_.take(handle)) {
        gate->close();
        gate->deleteLater(); // it may be passing a message on
    }
}

void DaemonLink::onConnected() {
    poll();
    nonsense_.clear();
    introduce();
}

/// Who is too busy to answer in time is asked again when it answers.
void DaemonLink::introduce() {
    isLate_ = false;
    const auto isLate = [this](const Result<QJsonValue> &answer) {
        return isLate_ = !answer && answer.error().is(ErrorCode::TimedOut);
    };
    call("daemon.info", {}, this, [this, isLate](const Result<QJsonValue> &info) {
        if (isLate(info))
            return;
        ReadReport report;
        const auto read = info ? readMessage<DaemonInfo>(WireValue(*info), report) : std::nullopt;
        if (!read) {
            nonsense_ = "daemon.info: " + shortLine(info ? report.text() : info.error().message);
            return Q_EMIT changed();
        }
        const bool isSame = !description_.isEmpty() && !read->descriptionHash.isEmpty() &&
                            read->descriptionHash == info_.descriptionHash;
        info_ = *read;
        if (info_.robot)
            info_.robot->id = isRobotId(info_.robot->id) ? info_.robot->id.toLower() : QString();
        Q_EMIT changed();
        if (isSame) {
            Q_EMIT ready();
            return;
        }
        call("rpc.discover", {}, this, [this, isLate](const Result<QJsonValue> &description) {
            if (isLate(description))
                return;
            if (description)
                return onDescription(*description);
            nonsense_ = "rpc.discover: " + shortLine(description.error().message);
            Q_EMIT changed();
        });
    });
}

void DaemonLink::onDescription(const QJsonValue &description) {
    description_ = description.toObject();
    const QJsonValue methods = description_["methods"], topics = description_["x-topics"];
    if (!methods.isArray())
        nonsense_ = tr("Its description names no commands");
    methods_.clear();
    topics_.clear();
    topicNames_.clear();
    for (const QJsonValue &method : methods.toArray())
        if (const QString name = method["name"].toString(); !name.isEmpty())
            methods_.insert(name, method.toObject());
    for (const QJsonValue &topic : topics.toArray())
        if (const QString name = topic["name"].toString(); !name.isEmpty() && !topics_.contains(name)) {
            topics_.insert(name);
            topicNames_.append(name);
        }
    Q_EMIT described();
    Q_EMIT ready();
}

void DaemonLink::onStatus(WireView status) {
    ReadReport report;
    status_ = readMessage<DaemonStatus>(status, report).value_or(DaemonStatus());
    const QString asked = "daemon.status: ";
    if (report.hasFailed())
        nonsense_ = asked + shortLine(report.text());
    else if (nonsense_.startsWith(asked))
        nonsense_.clear();
    worst_ = worstItem(status_);
    Q_EMIT changed();
}

void DaemonLink::poll() {
    if (const auto period = std::max(pollPeriod, links_ * pollShare); timer_.intervalAsDuration() != period)
        timer_.setInterval(period);
    const quint64 unreadable = client_.rejected().unreadable;
    if (std::exchange(shownUnreadable_, unreadable) != unreadable || !isConnected())
        Q_EMIT changed(); // also that somebody is there who does not answer
    if (!isConnected() || isPolling_)
        return;
    isPolling_ = true;
    asked_.start();
    silence_.start();
    ask();
}

void DaemonLink::ask() {
    call("daemon.status", {}, this, [this](const Result<QJsonValue> &status) {
        if (!status && status.error().is(ErrorCode::TimedOut) && isConnected())
            return ask(); // the silence goes on
        isPolling_ = false;
        silence_.stop();
        if (!status)
            return;
        latency_ms_ = double(asked_.nsecsElapsed()) * 1e-6;
        onStatus(WireValue(*status));
        if (isLate_)
            introduce();
    });
}

} // namespace hermes::desktop
