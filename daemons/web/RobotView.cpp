#include "daemons/web/RobotView.h"

#include "common/Time.h"
#include "daemons/web/FoxgloveSchemas.h"
#include "daemons/web/PlainJson.h"
#include "protocol/wire/JsonText.h"

#include <QCryptographicHash>
#include <algorithm>

namespace hermes::web {
namespace {

constexpr int queueLength = 1000; // messages that wait at a daemon
constexpr std::chrono::milliseconds duePeriod{500};
const char framesChannel[] = "frames";
const char auditTopic[] = "commands"; // daemons give it to engineers alone

} // namespace

RobotView::RobotView(const QString &robot)
    : daemons_(robot) {
    connect(&daemons_, &RobotDaemons::came, this, &RobotView::come);
    connect(&daemons_, &RobotDaemons::went, this, &RobotView::go);
    connect(&due_, &QTimer::timeout, this, &RobotView::lookAround);
    due_.start(duePeriod);
}

RobotView::~RobotView() {
    daemons_.disconnect(this);
}

void RobotView::lookAround() {
    for (auto &[id, channel] : channels_)
        if (channel.subscribers > 0)
            send(id, stampNow(), channel.view->due());
    for (const auto &topic : topics_)
        if (std::exchange(topic->isRenewed, false) && topic->users > 0)
            begin(*topic);
}

void RobotView::come(RobotDaemons::Daemon *daemon) {
    for (const TopicDescription &topic : daemon->topics)
        addTopic(daemon, topic);
    for (const QJsonValue &method : daemon->methods)
        addService(daemon, method.toObject());
    settingsHandles_[daemon] = daemon->client->subscribe(
        "settings", {{"queue", queueLength}}, [this, daemon](const TopicUpdate &update) {
            if (!update.replayed)
                takeSettings(daemon, update.json().toObject());
        });
    Q_EMIT changed();
}

void RobotView::go(RobotDaemons::Daemon *daemon) {
    for (auto channel = channels_.begin(); channel != channels_.end();) {
        auto &topics = channel->second.topics;
        const auto isOf = [daemon](const Topic *topic) { return topic->daemon == daemon; };
        topics.erase(std::remove_if(topics.begin(), topics.end(), isOf), topics.end());
        channel = topics.empty() ? channels_.erase(channel) : std::next(channel);
    }
    const auto end = std::remove_if(topics_.begin(), topics_.end(), [daemon](const auto &topic) {
        if (topic->daemon == daemon && topic->handle != 0)
            daemon->client->unsubscribe(topic->handle);
        return topic->daemon == daemon;
    });
    topics_.erase(end, topics_.end());
    for (auto service = services_.begin(); service != services_.end();)
        service = service->second.daemon == daemon->name ? services_.erase(service) : std::next(service);
    daemon->client->unsubscribe(settingsHandles_[daemon]);
    settingsHandles_.erase(daemon);
    for (const QString &name : parameters_.keys())
        if (name.startsWith(daemon->name + '.'))
            parameters_.remove(name);
    Q_EMIT changed();
}

void RobotView::addTopic(RobotDaemons::Daemon *daemon, const TopicDescription &description) {
    topics_.push_back(std::make_unique<Topic>());
    Topic *const topic = topics_.back().get();
    topic->daemon = daemon;
    topic->description = description;
    const QString name = daemon->name + '/' + description.name;
    bool isReplaced = false;
    for (const ViewKind &kind : viewKinds()) {
        if (description.name != kind.topic)
            continue;
        if (QLatin1String(kind.schema) == "PointCloud")
            frames_.robot().addScanner(daemon->name, daemon->address);
        isReplaced = isReplaced || kind.suffix[0] == 0;
        join(addChannel(name + kind.suffix, QString("foxglove.") + kind.schema, foxgloveSchema(kind.schema),
                        kind.make(frames_)),
             topic);
    }
    if (!isReplaced)
        join(addChannel(name, name, plainSchema(description.schema), makePlainView()), topic);
    if (frameTopics().contains(description.name))
        join(addChannel(framesChannel, "foxglove.FrameTransforms", foxgloveSchema("FrameTransforms"),
                        makeFramesView(frames_)),
             topic);
}

quint32 RobotView::addChannel(const QString &name, const QString &schemaName, const QJsonObject &schema,
                              std::unique_ptr<View> view) {
    QJsonObject told{{"topic", name},
                     {"encoding", "json"},
                     {"schemaName", schemaName},
                     {"schemaEncoding", "jsonschema"},
                     {"schema", QString::fromUtf8(compactJson(schema))}};
    const quint32 id = idOf(told);
    Channel &channel = channels_[id];
    if (channel.view)
        return id; // of the frames
    told["id"] = double(id);
    channel.told = told;
    channel.view = std::move(view);
    return id;
}

void RobotView::join(quint32 id, Topic *topic) {
    Channel &channel = channels_[id];
    channel.topics.push_back(topic);
    topic->channels.push_back(id);
    if (topic->description.name == auditTopic)
        channel.role = Role::Engineer;
    if (channel.subscribers > 0)
        use(*topic);
}

/// The same for the same.
quint32 RobotView::idOf(const QJsonObject &told) {
    const QByteArray hash = QCryptographicHash::hash(compactJson(told), QCryptographicHash::Sha1);
    const auto known = ids_.constFind(hash);
    return known != ids_.constEnd() ? *known : *ids_.insert(hash, quint32(ids_.size()) + 1);
}

QJsonArray RobotView::channels(Role role) const {
    QJsonArray all;
    for (const auto &[id, channel] : channels_)
        if (role >= channel.role)
            all.append(channel.told);
    return all;
}

bool RobotView::has(quint32 channel, Role role) const {
    const auto found = channels_.find(channel);
    return found != channels_.end() && role >= found->second.role;
}

void RobotView::subscribe(quint32 id) {
    Channel &channel = channels_.at(id);
    const bool isFirst = channel.subscribers++ == 0;
    for (Topic *topic : channel.topics)
        if (isFirst)
            use(*topic);
        else
            topic->isRenewed = topic->description.snapshot;
}

void RobotView::unsubscribe(quint32 id) {
    const auto channel = channels_.find(id);
    if (channel == channels_.end() || --channel->second.subscribers > 0)
        return;
    for (Topic *topic : channel->second.topics)
        release(*topic);
}

void RobotView::use(Topic &topic) {
    if (topic.users++ == 0)
        begin(topic);
    else
        topic.isRenewed = topic.description.snapshot;
}

void RobotView::begin(Topic &topic) {
    Client &client = *topic.daemon->client;
    if (topic.handle != 0)
        client.unsubscribe(topic.handle);
    topic.dropped = 0;
    topic.handle = client.subscribe(topic.description.name, {{"queue", queueLength}},
                                    [this, &topic](const TopicUpdate &update) { take(topic, update); });
}

void RobotView::release(Topic &topic) {
    if (--topic.users > 0)
        return;
    topic.daemon->client->unsubscribe(topic.handle);
    topic.handle = 0;
}

void RobotView::take(Topic &topic, const TopicUpdate &update) {
    if (update.dropped > topic.dropped)
        topic.isRenewed = topic.description.snapshot; // changes were missed
    topic.dropped = update.dropped;
    for (const quint32 id : topic.channels) {
        Channel &channel = channels_.at(id);
        if (channel.subscribers == 0)
            continue;
        ReadReport report;
        const QByteArray json = channel.view->take({topic.daemon->name, update}, report);
        channel.unreadable += report.hasFailed();
        channel.problem = report.hasFailed() ? report.text().left(200) : QString();
        send(id, update.stamp, json);
    }
}

void RobotView::send(quint32 id, double stamp, const QByteArray &json) {
    if (!json.isEmpty())
        Q_EMIT message(id, stamp, json);
}

QStringList RobotView::problems() const {
    QStringList lines;
    for (const auto &[id, channel] : channels_)
        if (!channel.problem.isEmpty())
            lines.append(QString("%1: %2 messages could not be read: %3")
                             .arg(channel.told["topic"].toString())
                             .arg(channel.unreadable)
                             .arg(channel.problem));
    return lines;
}

} // namespace hermes::web
