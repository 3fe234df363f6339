#include "daemons/recorder/TopicRecorder.h"

#include "common/Time.h"
#include "daemons/recorder/SessionReader.h"
#include "protocol/wire/Fields.h"
#include "protocol/wire/JsonText.h"
#include "protocol/wire/JsonWriters.h"

#include <QRegularExpression>
#include <algorithm>

namespace hermes::recorder {
namespace {

constexpr int queueLength = 1000; // messages of a topic that may wait at its daemon

const TopicRule *ruleOf(const std::vector<TopicRule> &rules, const QString &topic) {
    for (const TopicRule &rule : rules)
        if (QRegularExpression(topicPattern(rule.topic)).match(topic).hasMatch())
            return &rule;
    return nullptr;
}

std::map<std::string, std::string> metadataOf(const RobotDaemons::Daemon &daemon, const QString &topic) {
    std::map<std::string, std::string> data{
        {"daemon", daemon.name.toStdString()},
        {"topic", topic.toStdString()},
        {"address", daemon.address.toStdString()},
        {"version", daemon.info["version"].toString().toStdString()},
    };
    if (const QJsonObject robot = daemon.info["robot"].toObject(); !robot.isEmpty()) {
        data["robot"] = robot["name"].toString().toStdString();
        data["robot_id"] = robot["id"].toString().toStdString();
    }
    return data;
}

} // namespace

Fields<TopicRule> fieldsOf(Of<TopicRule>) {
    return Fields<TopicRule>()
        .add("topic", &TopicRule::topic, "DAEMON/TOPIC; * stands for any text")
        .add("max_rate_hz", &TopicRule::max_rate_hz, "Messages a second; 0: not recorded")
        .with("minimum", 0)
        .add("max_bytes_s", &TopicRule::max_bytes_s, "Bytes a second; 0: no limit")
        .with("minimum", 0);
}

Field topicRulesField() {
    return Field::array("topics", "Topics of which not all is recorded; the first rule that fits counts",
                        schemaOf<TopicRule>())
        .with("maxItems", 100)
        .group("Topics")
        .byDefault(QJsonArray{QJsonObject{{"topic", "*/cloud"}, {"max_rate_hz", 0}}});
}

std::vector<TopicRule> topicRules(const QJsonValue &setting) {
    ReadReport report;
    return readMessage<std::vector<TopicRule>>(WireValue(setting), report).value_or(std::vector<TopicRule>());
}

TopicRecorder::TopicRecorder(RobotDaemons &daemons, McapRecorder &file)
    : daemons_(daemons)
    , file_(file) {
    connect(&daemons, &RobotDaemons::came, this, &TopicRecorder::subscribe);
    connect(&daemons, &RobotDaemons::went, this, &TopicRecorder::drop);
}

void TopicRecorder::begin(bool keepsRing) {
    if (!keepsRing) {
        unsubscribe(); // so that all begin with their snapshots
        topics_.clear();
    }
    isActive_ = true;
    for (const RecordedTopic &topic : topics_)
        file_.addTopic(topic);
    if (!keepsRing)
        subscribeAll();
    for (const KeptMessage &message : keepsRing ? ring_.messages() : std::vector<KeptMessage>())
        file_.write(message);
}

void TopicRecorder::end() {
    isActive_ = false;
    unsubscribe();
}

void TopicRecorder::openRing(double seconds, std::size_t maxBytes) {
    if (isActive_)
        return; // opened when that has ended
    unsubscribe();
    topics_.clear();
    ring_.open(seconds, maxBytes);
    if (ring_.isOpen())
        subscribeAll();
}

void TopicRecorder::subscribeAll() {
    for (const auto &[address, daemon] : daemons_.all())
        if (daemon->isKnown)
            subscribe(daemon.get());
}

void TopicRecorder::unsubscribe() {
    for (const auto &topic : subscribed_)
        topic->daemon->client->unsubscribe(topic->handle);
    subscribed_.clear();
}

/// The same as in the file.
int TopicRecorder::numberOf(const RecordedTopic &topic) {
    for (std::size_t i = 0; i < topics_.size(); ++i)
        if (topics_[i].topic == topic.topic && topics_[i].schema == topic.schema)
            return int(i);
    topics_.push_back(topic);
    if (isActive_)
        file_.addTopic(topic);
    return int(topics_.size()) - 1;
}

// Of a daemon whose connection is a new one, too: then it may describe its topics otherwise.
void TopicRecorder::subscribe(RobotDaemons::Daemon *daemon) {
    if (!isActive_ && !ring_.isOpen())
        return;
    drop(daemon);
    for (const TopicDescription &topic : daemon->topics) {
        const QString name = daemon->name + '/' + topic.name;
        const TopicRule *const rule = ruleOf(rules_, name);
        if (rule && rule->max_rate_hz <= 0)
            continue;
        const int number = numberOf({name, compactJson(topic.schema), metadataOf(*daemon, topic.name)});
        subscribed_.push_back(std::make_unique<Subscribed>());
        Subscribed &one = *subscribed_.back();
        one.daemon = daemon;
        one.number = number;
        one.maxBytes_s = one.allowance = rule ? rule->max_bytes_s.value_or(0) : 0;
        one.filled = monotonicNow();
        QJsonObject options{{"queue", queueLength}};
        if (rule)
            options.insert("max_rate_hz", rule->max_rate_hz);
        one.handle = daemon->client->subscribe(
            topic.name, options, [this, &one](const TopicUpdate &update) { take(one, update); });
    }
}

void TopicRecorder::take(Subscribed &topic, const TopicUpdate &update) {
    if (update.replayed) { // it is no part of what happens now
        if (isActive_)
            Q_EMIT daemons_.missed(QString("%1/%2: somebody replays it; what is live is not recorded then")
                                       .arg(topic.daemon->name, update.topic));
        return;
    }
    if (update.dropped > topic.dropped && isActive_)
        file_.noteLost(topic.number, update.dropped - topic.dropped);
    topic.dropped = update.dropped;
    JsonTextWriter text;
    update.data.write(text);
    const KeptMessage message{topic.number, update.seq, update.stamp, Moment::now(), text.take()};
    const bool isTaken = isAllowed(topic, message.json.size());
    if (isActive_ && isTaken)
        file_.write(message);
    else if (isActive_)
        file_.noteLost(topic.number, 1);
    if (isActive_ || !ring_.isOpen() || !isTaken)
        return;
    ring_.add(message);
    const QString why = ring_.alarm(topics_[std::size_t(topic.number)].topic, update.data);
    if (!why.isEmpty())
        Q_EMIT alarmed(why);
}

bool TopicRecorder::isAllowed(Subscribed &topic, int bytes) {
    if (topic.maxBytes_s <= 0)
        return true;
    const double now = monotonicNow();
    topic.allowance = std::min(topic.maxBytes_s, topic.allowance + (now - topic.filled) * topic.maxBytes_s);
    topic.filled = now;
    if (topic.allowance <= 0)
        return false;
    topic.allowance -= bytes;
    return true;
}

void TopicRecorder::drop(RobotDaemons::Daemon *daemon) {
    const auto isOf = [daemon](const auto &topic) {
        if (topic->daemon != daemon)
            return false;
        daemon->client->unsubscribe(topic->handle);
        return true;
    };
    subscribed_.erase(std::remove_if(subscribed_.begin(), subscribed_.end(), isOf), subscribed_.end());
}

} // namespace hermes::recorder
