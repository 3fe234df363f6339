#pragma once

#include "common/Time.h"
#include "daemons/softwaretrigger/SoftwareTrigger.h"
#include "tests/support/DaemonClient.h"

/// A daemon that triggers may watch and call.
class TargetDaemon : public hermes::Daemon {
public:
    TargetDaemon()
        : Daemon({"target", "Target", "For tests", 1}) {
        using namespace hermes;
        using namespace hermes::softwaretrigger;
        addTopic(Topic("readings", "Readings"));
        addTopic(Topic("odometry", "As that of the motor control"));
        addCommand(Command("count", "Counts its calls")
                       .param(Field::any("value", "Anything").byDefault(QJsonValue()))
                       .handler([this](const Call &call) {
                           values.append(call.value("value"));
                           return QJsonValue(values.size());
                       }));
        addCommand(Command("refuse", "Fails").handler([](const Call &) -> Result<QJsonValue> {
            return Error(ErrorCode::DeviceFault, "it is broken");
        }));
        addCommand(Command("hang", "Never answers").asyncHandler([this](const Call &, const Reply &reply) {
            kept.push_back(reply);
        }));
    }
    using Daemon::publish;

    QJsonArray values;
    std::vector<hermes::Reply> kept;
};

/// A software trigger in this process, a daemon for it to work with, and a client that hears each firing.
class TriggerFixture : protected DaemonClient {
protected:
    static QJsonObject period(double seconds) { return {{"kind", "period"}, {"period_s", seconds}}; }
    static QJsonObject after(const QString &id) { return {{"kind", "trigger"}, {"trigger", id}}; }
    static QJsonObject byCommand() { return {{"kind", "command"}}; }
    QJsonObject callTarget(const QString &method, double timeout_s = 2) const {
        return {{"do", "call"}, {"daemon", targetAddress_}, {"method", method}, {"timeout_s", timeout_s}};
    }
    QJsonObject condition(const QString &path, const QString &op, const QJsonValue &value) const {
        return {{"kind", "condition"},
                {"daemon", targetAddress_},
                {"topic", "readings"},
                {"path", path},
                {"op", op},
                {"value", value}};
    }

    void setUp(const QStringList &settings = {}) {
        startTarget("127.0.0.1:0");
        targetAddress_ = target_->server().addresses().value(0).section("//", 1).section('?', 0, 0);
        startTrigger(settings);
    }
    void startTarget(const QString &address) {
        target_ = std::make_unique<TargetDaemon>();
        launch(*target_, {}, "tcp://" + address);
    }
    void stopTarget() {
        target_->shutDown();
        target_.reset();
    }
    void startTrigger(const QStringList &settings = {}) {
        trigger_ = std::make_unique<hermes::softwaretrigger::SoftwareTrigger>();
        launch(*trigger_, settings, "tcp://127.0.0.1:0",
               config_.isEmpty() ? QStringList() : QStringList{"--config", config_});
        fired_.clear();
        connectTo(*trigger_);
        client_->subscribe("fired", {{"queue", 10000}}, [this](const hermes::TopicUpdate &update) {
            fired_[update.json()["id"].toString()].append(update.json());
        });
    }
    void tearDown() {
        client_.reset();
        if (trigger_)
            trigger_->shutDown();
        trigger_.reset();
        if (target_)
            stopTarget();
        config_.clear();
    }

    void define(const QString &id, const QJsonObject &when, const QJsonArray &actions = {}) {
        const auto result = client_->callAndWait(
            "trigger.define", QJsonObject{{"id", id}, {"when", when}, {"actions", actions}});
        QVERIFY2(result.ok(), result ? "" : qPrintable(result.error().message));
    }
    QJsonValue fire(const QString &id) { return call("trigger.fire", {{"id", id}}); }
    QJsonValue listed(const QString &id) {
        for (const QJsonValue &one : call("trigger.list").toArray())
            if (one["id"] == id)
                return one;
        return QJsonValue(QJsonValue::Undefined);
    }
    /// Until the trigger hears what the target publishes.
    void waitSubscribed(const QString &topic) { QTRY_VERIFY(target_->hasSubscribers(topic)); }

    std::unique_ptr<TargetDaemon> target_;
    QString targetAddress_, config_;
    std::unique_ptr<hermes::softwaretrigger::SoftwareTrigger> trigger_;
    QMap<QString, QList<QJsonValue>> fired_; ///< by id, in the order of their ends
};
