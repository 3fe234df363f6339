#pragma once

#include "gui/desktop/model/Fleet.h"

namespace hermes::desktop {

/// A topic of the chosen robot, from whichever of its daemons has it: subscribes when one appears, moves on
/// when the robot or its daemons change.
class TopicFeed : public QObject {
    Q_OBJECT
public:
    static constexpr std::chrono::milliseconds renewPause{200};

    /// options: as topics.subscribe takes them.
    TopicFeed(Fleet &fleet, const QString &topic, const QJsonObject &options,
              const Client::TopicCallback &callback, QObject *parent);

    /// The daemon that the messages come from; null: nobody has the topic.
    DaemonLink *source() const { return source_; }
    /// Switched off it costs nothing on the link.
    void setEnabled(bool isEnabled);
    /// Subscribes anew, for the snapshot with which the topic begins; a little later, however often it is
    /// asked for.
    void renew();

Q_SIGNALS:
    /// Another daemon, or none: what came before belongs to the old one.
    void sourceChanged();

private:
    void follow(Robot *robot);
    void update();
    void subscribeAnew();

    Fleet &fleet_;
    const QString topic_;
    const QJsonObject options_;
    const Client::TopicCallback callback_;
    QPointer<Robot> robot_;
    QPointer<DaemonLink> source_;
    Subscription subscription_;
    QTimer renewal_;
    bool isEnabled_ = true;
};

} // namespace hermes::desktop
