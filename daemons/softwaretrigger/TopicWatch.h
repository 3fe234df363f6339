#pragma once

#include "daemons/softwaretrigger/Watch.h"

#include <QPointer>

namespace hermes::softwaretrigger {

/// Watches a topic of a daemon, across its restarts.
class TopicWatch : public QObject, public Watch {
    Q_OBJECT
public:
    TopicWatch(const TriggerDefinition &definition, Client &client, const Listener &listener);
    ~TopicWatch() override;

    QString problem() const override;
    WatchedState state() const override;

protected:
    /// Gives what is wrong with the message, or an empty text.
    virtual QString take(const TopicUpdate &update) = 0;
    virtual void interrupted() {}
    void fire(const TopicUpdate &update, quint64 missed, const FiringCause &cause);

private:
    void receive(const TopicUpdate &update);

    const QString topic_;
    QPointer<Client> client_;
    const Listener listener_;
    int handle_ = 0;
    quint64 messages_ = 0, bad_ = 0, dropped_ = 0;
    QString problem_;
};

/// Fires each distance or angle travelled.
class TravelWatch : public TopicWatch {
public:
    TravelWatch(const TriggerDefinition &definition, Client &client, const Listener &listener)
        : TopicWatch(definition, client, listener)
        , travel_(definition.cause() == Cause::Distance
                      ? Travel(Travel::Kind::Distance, definition.number("distance_m"))
                      : Travel(Travel::Kind::Angle, definition.number("angle_rad"))) {}
    WatchedState state() const override;

protected:
    QString take(const TopicUpdate &update) override;
    void interrupted() override { travel_.interrupt(); }

private:
    Travel travel_;
};

/// Fires when a condition becomes true.
class ConditionWatch : public TopicWatch {
public:
    ConditionWatch(const TriggerDefinition &definition, Client &client, const Listener &listener)
        : TopicWatch(definition, client, listener)
        , path_(definition.text("path"))
        , condition_(path_, definition.text("op"), definition.when.value("value")) {}

protected:
    QString take(const TopicUpdate &update) override;

private:
    const QString path_;
    Condition condition_;
};

} // namespace hermes::softwaretrigger
