#pragma once

#include "common/Time.h"
#include "common/daemon/SignalWatcher.h"
#include "gui/hermesctl/Commands.h"
#include "protocol/messages/Motion.h"
#include "protocol/messages/Turns.h"
#include "protocol/wire/Fields.h"

namespace hermes::ctl {

/// All messages of a topic, as they come.
template <typename Message>
struct TopicRecord {
    struct Entry {
        double came, stamp, age; ///< by monotonicNow(); what it says itself, else its envelope; when it came
        Message data;
    };
    Client &client;
    std::vector<Entry> all{};
    QString fault{}; ///< of the last message that is none
    int handle = 0;

    TopicRecord(Client &daemon, const QString &topic)
        : client(daemon) {
        handle = client.subscribe(topic, {{"queue", 100}}, [this](const TopicUpdate &update) {
            ReadReport report;
            auto message = readMessage<Message>(update.data, report);
            double stamp = update.stamp;
            if constexpr (std::is_same_v<Message, ScanMessage>)
                stamp = message ? message->header.stamp : stamp;
            if (!message)
                fault = report.text();
            else if (!update.replayed)
                all.push_back({monotonicNow(), stamp, stampNow() - stamp, std::move(*message)});
        });
    }
    ~TopicRecord() { client.unsubscribe(handle); }
    TopicRecord(const TopicRecord &) = delete;
    TopicRecord &operator=(const TopicRecord &) = delete;

    double rate_hz() const { return double(all.size() - 1) / (all.back().came - all.front().came); }
};
using OdometryRecord = TopicRecord<OdometryMessage>;

/// Tries whether a daemon keeps a contract (docs/own-base.md), and tells line by line what it finds.
class Conformance {
protected:
    explicit Conformance(const Arguments &arguments);

    /// What has to hold, with what is expected and, where that is not clear, what was found.
    void must(const QString &what, bool holds, const QString &expected, const QString &found = {}) {
        tell(holds ? "ok" : "fail", what, expected, found);
    }
    /// The same; where it does not hold that is only a warning.
    void should(const QString &what, bool holds, const QString &expected, const QString &found = {}) {
        tell(holds ? "ok" : "warn", what, expected, found);
    }
    QJsonValue accepted(const QString &what, const Result<QJsonValue> &answer);
    void refused(const QString &what, const Result<QJsonValue> &answer, const std::vector<ErrorCode> &codes);
    /// A topic comes, so often, and can be read. False: less than three messages.
    template <typename Message>
    bool comes(const QString &topic, const TopicRecord<Message> &record, double least_hz) {
        const bool isThere = record.all.size() > 2;
        const Client::Rejected &bad = record.client.rejected();
        const QString unreadable = bad.unreadable > 0 ? "unreadable: " + bad.last : record.fault;
        must(topic, isThere && unreadable.isEmpty(), "messages as in docs/own-base.md, all numbers finite",
             unreadable.isEmpty() ? QString("%1 messages").arg(record.all.size()) : unreadable);
        if (isThere)
            must("rate of " + topic, record.rate_hz() >= least_hz, QString("%1 Hz at least").arg(least_hz),
                 QString("%1 Hz").arg(record.rate_hz(), 0, 'f', 1));
        return isThere;
    }
    /// Its stamps grow, and are of now.
    template <typename Message>
    void stamps(const TopicRecord<Message> &record, double oldest_s) {
        double step = 1e9, youngest = 1e9, sum = 0;
        for (std::size_t i = 0; i < record.all.size(); ++i) {
            step = i > 0 ? std::min(step, record.all[i].stamp - record.all[i - 1].stamp) : step;
            youngest = std::min(youngest, record.all[i].age);
            sum += record.all[i].age;
        }
        const double mean = sum / double(record.all.size());
        must("stamps", step > 0 && youngest > -0.02 && mean < oldest_s,
             QString("each later than the one before, 0 to %1 s old by the clock here").arg(oldest_s),
             QString("%1 s later at least; %2 s old, %3 s at least")
                 .arg(step, 0, 'f', 3)
                 .arg(mean, 0, 'f', 3)
                 .arg(youngest, 0, 'f', 3));
    }

    /// Connects to the daemon of that name. Error: who did not answer and why.
    Result<void> connectTo(Client &client, const QString &name);
    Result<QJsonValue> call(Client &client, const QString &method, const QJsonObject &params = {}) {
        return client.callAndWait(method, params, arguments_.timeout);
    }
    /// Lets the event loop run for so long, or until a signal asks for the end.
    void pass(double seconds);
    /// Sends a velocity 20 times a second; the wheels go on turning afterwards. Error: the first refusal.
    Result<void> driveFor(Client &client, const Twist2D &velocity, double seconds);
    /// Seconds from a moment (monotonicNow()) until the last message in which the robot moves, most_s at
    /// most.
    double standsAfter(const OdometryRecord &odometry, double since, double most_s);
    bool isEnded() const { return isEnded_; }
    /// Error: how much does not hold, or that a signal ended it.
    Result<void> result() const;

    const Arguments &arguments_;

private:
    void tell(const QString &level, const QString &what, const QString &expected, const QString &found);

    SignalWatcher signals_{nullptr};
    bool isEnded_ = false;
    QMap<QString, int> told_; ///< lines of each level
};

/// Error: the wheels are not free, or nobody can be asked.
Result<void> confirmFreeWheels(const Arguments &arguments);

} // namespace hermes::ctl
