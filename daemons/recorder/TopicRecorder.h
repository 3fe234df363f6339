#pragma once

#include "common/daemon/RobotDaemons.h"
#include "common/schema/Field.h"
#include "daemons/recorder/McapRecorder.h"
#include "daemons/recorder/TopicRing.h"

namespace hermes::recorder {

/// Which topics are recorded, and how much of them: the setting `topics`. The first rule that fits counts.
struct TopicRule {
    QString topic;                     ///< "velodynelogger/cloud"; * stands for any text
    double max_rate_hz = 0;            ///< 0: not recorded
    std::optional<double> max_bytes_s; ///< a second; none or 0: no limit
};

Fields<TopicRule> fieldsOf(Of<TopicRule>);
std::vector<TopicRule> topicRules(const QJsonValue &setting);
/// The setting itself.
Field topicRulesField();

/// While a session is recorded, or a ring is open: subscribes to every topic of every daemon of the robot,
/// and keeps what comes.
class TopicRecorder : public QObject {
    Q_OBJECT
public:
    TopicRecorder(RobotDaemons &daemons, McapRecorder &file);

    /// Rules for the subscriptions that follow.
    void setRules(const std::vector<TopicRule> &rules) { rules_ = rules; }
    /// What comes is written from now on; what is in the ring, too, if it is to be kept.
    void begin(bool keepsRing);
    void end();
    /// When the first of what the ring has came; nothing: it is empty.
    std::optional<Moment> ringBegin() const { return ring_.begin(); }
    /// The last seconds are kept without a recording; 0: nothing is.
    void openRing(double seconds, std::size_t maxBytes);

Q_SIGNALS:
    /// What is in the ring should be kept: why the robot stopped, or what is wrong now.
    void alarmed(const QString &why);

private:
    struct Subscribed {
        RobotDaemons::Daemon *daemon;
        int handle = 0;
        int number = 0; ///< of the topic, in topics_
        double maxBytes_s = 0, allowance = 0, filled = 0;
        quint64 dropped = 0; ///< as the daemon said last
    };

    void subscribeAll();
    void unsubscribe();
    void subscribe(RobotDaemons::Daemon *daemon);
    int numberOf(const RecordedTopic &topic);
    void take(Subscribed &topic, const TopicUpdate &update);
    static bool isAllowed(Subscribed &topic, int bytes);
    void drop(RobotDaemons::Daemon *daemon);

    RobotDaemons &daemons_;
    McapRecorder &file_;
    bool isActive_ = false;
    std::vector<TopicRule> rules_;
    std::vector<std::unique_ptr<Subscribed>> subscribed_;
    std::vector<RecordedTopic> topics_; ///< that were subscribed to, since the file was begun
    TopicRing ring_;
};

} // namespace hermes::recorder
