#pragma once

#include "common/Time.h"
#include "common/daemon/SignalWatcher.h"
#include "gui/hermesctl/Commands.h"
#include "protocol/messages/Motion.h"
#include "protocol/wire/Fields.h"

namespace hermes::ctl {

/// All messages of a topic, as they come.
template <typename Message>
struct TopicRecord {
    struct Entry {
        double came, age, stamp; ///< by monotonicNow(); at its coming, in seconds; of the message
        Message data;
    };
    std::vector<Entry> all;
    QString fault; ///< what is wrong with the last message that is none

    TopicRecord(Client &client, const QString &topic) {
        client.subscribe(topic, {{"queue", 100}}, [this](const TopicUpdate &update) {
            ReadReport report;
            auto message = readMessage<Message>(update.data, report);
            if (!message)
                fault = report.text();
            else if (!update.replayed)
                all.push_back({monotonicNow(), stampNow() - update.stamp, update.stamp, std::move(*message)});
        });
    }
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
    void must(const QString &what, bool holds, const QString &expected, const QString &found = {});
    /// The same; where it does not hold that is only a warning.
    void should(const QString &what, bool holds, const QString &expected, const QString &found = {});
    QJsonValue accepted(const QString &what, const Result<QJsonValue> &answer);
    void refused(const QString &what, const Result<QJsonValue> &answer, const std::vector<ErrorCode> &codes);
    /// A topic has come and can be read. False: less than three messages.
    template <typename Message>
    bool comes(const QString &topic, const Client &client, const TopicRecord<Message> &record) {
        const Client::Rejected &bad = client.rejected();
        must(topic, record.fault.isEmpty() && bad.unreadable == 0 && record.all.size() > 2,
             "messages as in docs/own-base.md, all numbers finite",
             bad.unreadable > 0       ? "unreadable: " + bad.last
             : record.fault.isEmpty() ? QString("%1 messages").arg(record.all.size())
                                      : record.fault);
        return record.all.size() > 2;
    }
    /// Stamps in the order of coming, and how old (seconds) each was then.
    void stamps(const std::vector<double> &stamps, std::vector<double> ages, double oldest_s);

    /// Connects to the daemon of that name. Error: who did not answer and why.
    Result<void> connectTo(Client &client, const QString &name);
    Result<QJsonValue> call(Client &client, const QString &method, const QJsonObject &params = {});
    /// Lets the event loop run for so long, or until a signal asks for the end.
    void pass(double seconds);
    /// Sends a velocity 20 times a second; the wheels go on turning afterwards. Error: the first refusal.
    Result<void> driveFor(Client &client, const Twist2D &velocity, double seconds);
    /// Seconds from a moment (monotonicNow()) until the last message in which the robot moves; most_s where
    /// it still moves then.
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
