#include "gui/desktop/model/TopicFeed.h"

namespace hermes::desktop {

TopicFeed::TopicFeed(Fleet &fleet, const QString &topic, const QJsonObject &options,
                     const Client::TopicCallback &callback, QObject *parent)
    : QObject(parent)
    , fleet_(fleet)
    , topic_(topic)
    , options_(options)
    , callback_(callback) {
    renewal_.setSingleShot(true);
    renewal_.setInterval(renewPause);
    connect(&renewal_, &QTimer::timeout, this, &TopicFeed::subscribeAnew);
    connect(&fleet, &Fleet::robotChosen, this, &TopicFeed::follow);
    follow(fleet.robot());
}

void TopicFeed::setEnabled(bool isEnabled) {
    isEnabled_ = isEnabled;
    update();
}

void TopicFeed::renew() {
    if (!renewal_.isActive())
        renewal_.start();
}

void TopicFeed::subscribeAnew() {
    subscription_.reset();
    if (source_)
        subscription_ = source_->subscribe(topic_, options_, callback_);
}

void TopicFeed::follow(Robot *robot) {
    if (robot_)
        robot_->disconnect(this);
    robot_ = robot;
    if (robot)
        connect(robot, &Robot::capabilitiesChanged, this, &TopicFeed::update);
    update();
}

void TopicFeed::update() {
    // A source that is away is kept, whoever else has the topic: its client subscribes again by itself.
    const bool stays = isEnabled_ && source_ && robot_ && robot_->has(source_) &&
                       (!source_->isConnected() || source_->hasTopic(topic_));
    DaemonLink *const found = stays                  ? source_.data()
                              : robot_ && isEnabled_ ? robot_->withTopic(topic_)
                                                     : nullptr;
    if (found == source_)
        return;
    source_ = found;
    subscribeAnew();
    Q_EMIT sourceChanged();
}

} // namespace hermes::desktop
