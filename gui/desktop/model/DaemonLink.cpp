#include "gui/desktop/model/DaemonLink.h"

#include "common/Project.h"

#include <QElapsedTimer>
#include <QJsonArray>
#include <QPointer>

namespace hermes {
namespace {

QJsonObject named(const QJsonValue &list, const QString &name) {
    for (const QJsonValue &entry : list.toArray())
        if (entry["name"].toString() == name)
            return entry.toObject();
    return {};
}

int severity(const QJsonValue &item) {
    const QString level = item["level"].toString();
    return level == "error" ? 3 : level == "stale" ? 2 : level == "warn" ? 1 : 0;
}

QJsonObject worstItem(const QJsonObject &status) {
    QJsonValue worst;
    for (const QJsonValue &item : status["health"].toArray())
        if (severity(item) > severity(worst))
            worst = item;
    return worst.toObject();
}

} // namespace

DaemonLink::DaemonLink(const QString &address, QObject *parent)
    : QObject(parent)
    , address_(address) {
    connect(&client_, &Client::connected, this, &DaemonLink::onConnected);
    connect(&client_, &Client::disconnected, this, [this] {
        isPolling_ = false;
        Q_EMIT changed();
    });
    connect(&timer_, &QTimer::timeout, this, &DaemonLink::poll);
    timer_.start(pollPeriod);
    client_.connectTo(address);
    client_.subscribe("status", {}, [this](const TopicUpdate &update) { onStatus(update.data.toObject()); });
}

QString DaemonLink::name() const {
    if (isKnown())
        return info_["name"].toString();
    const quint16 port = address_.section(':', -1).toUShort();
    for (const QString &known : daemonNames())
        if (defaultPort(known) == port)
            return known;
    return address_;
}

QString DaemonLink::title() const {
    const QString title = info_["title"].toString();
    return title.isEmpty() ? name() : title;
}

Condition DaemonLink::condition() const {
    if (!isConnected())
        return Condition::Unreachable;
    const QString state = status_["state"].toString();
    const int worst = severity(worstItem(status_));
    if (state == "fault" || worst == 3)
        return Condition::Fault;
    if (state == "degraded" || worst > 0)
        return Condition::Warning;
    return state == "ready" || state == "running" ? Condition::Ready : Condition::Busy;
}

QString DaemonLink::conditionWord() const {
    const Condition now = condition();
    if (now == Condition::Unreachable)
        return tr("unreachable");
    const QString state = status_["state"].toString();
    if (now == Condition::Warning && state != "degraded")
        return tr("warning");
    if (now == Condition::Fault && state != "fault")
        return tr("error");
    return state.isEmpty() ? tr("connecting") : state;
}

QString DaemonLink::reason() const {
    if (!isConnected())
        return client_.lastError();
    const QJsonObject item = worstItem(status_);
    return item.isEmpty() ? QString() : item["name"].toString() + ": " + item["message"].toString();
}

QJsonObject DaemonLink::method(const QString &name) const {
    return named(description_["methods"], name);
}

bool DaemonLink::hasTopic(const QString &name) const {
    return !named(description_["x-topics"], name).isEmpty();
}

QStringList DaemonLink::topics() const {
    QStringList names;
    for (const QJsonValue &topic : description_["x-topics"].toArray())
        names.append(topic["name"].toString());
    return names;
}

void DaemonLink::call(const QString &method, const QJsonObject &params, QObject *context,
                      const Client::Callback &done) {
    client_.call(method, params, [done, guard = QPointer<QObject>(context)](const auto &result) {
        if (guard)
            done(result);
    });
}

void DaemonLink::onConnected() {
    poll();
    call("daemon.info", {}, this, [this](const Result<QJsonValue> &info) {
        if (!info)
            return;
        const bool isSame = !description_.isEmpty() &&
                            (*info)["description_hash"] == info_["description_hash"] &&
                            info_.contains("description_hash");
        info_ = info->toObject();
        Q_EMIT changed();
        if (isSame) {
            Q_EMIT ready();
            return;
        }
        call("rpc.discover", {}, this, [this](const Result<QJsonValue> &description) {
            if (!description)
                return;
            description_ = description->toObject();
            Q_EMIT described();
            Q_EMIT ready();
        });
    });
}

void DaemonLink::onStatus(const QJsonObject &status) {
    status_ = status;
    Q_EMIT changed();
}

void DaemonLink::poll() {
    if (!isConnected() || isPolling_)
        return;
    isPolling_ = true;
    QElapsedTimer time;
    time.start();
    call("daemon.status", {}, this, [this, time](const Result<QJsonValue> &status) {
        isPolling_ = false;
        if (!status)
            return;
        latency_ms_ = double(time.nsecsElapsed()) * 1e-6;
        onStatus(status->toObject());
    });
}

} // namespace hermes
