#include "daemons/softwaretrigger/TopicWatch.h"

#include "common/schema/SchemaText.h"

namespace hermes::softwaretrigger {
namespace {

constexpr int queueLength = 1000; // messages that wait here rather than being thinned

} // namespace

TopicWatch::TopicWatch(const TriggerDefinition &definition, Client &client, const Listener &listener)
    : topic_(definition.text("topic"))
    , client_(&client)
    , listener_(listener) {
    handle_ = client.subscribe(topic_, {{"queue", queueLength}},
                               [this](const TopicUpdate &update) { receive(update); });
    connect(&client, &Client::subscriptionFailed, this, [this](int handle, const RpcError &error) {
        if (handle == handle_)
            problem_ = error.message;
    });
    connect(&client, &Client::disconnected, this, [this] {
        dropped_ = 0; // the daemon counts anew
        interrupted();
    });
}

TopicWatch::~TopicWatch() {
    if (client_)
        client_->unsubscribe(handle_);
}

QString TopicWatch::problem() const {
    if (client_ && client_->isBeginning())
        return {};
    if (!client_ || !client_->isConnected())
        return client_ ? "not connected: " + client_->problem() : QString("not connected");
    return problem_;
}

WatchedState TopicWatch::state() const {
    return {messages_, bad_, {}, {}};
}

void TopicWatch::receive(const TopicUpdate &update) {
    if (update.replayed) // it moves nothing, and the way meanwhile is not known
        return interrupted();
    ++messages_;
    problem_ = take(update);
    if (!problem_.isEmpty()) {
        ++bad_;
        problem_ = "topic " + topic_ + ": " + problem_;
    } else if (update.dropped > dropped_) {
        problem_ = QString("topic %1: %2 messages were lost on the way").arg(topic_).arg(update.dropped);
    }
    dropped_ = update.dropped;
}

void TopicWatch::fire(const TopicUpdate &update, quint64 missed, const FiringCause &cause) {
    listener_.fire({{}, update.stamp, missed, cause});
}

WatchedState TravelWatch::state() const {
    WatchedState state = TopicWatch::state();
    state.travelled = travel_.total();
    state.jumps = travel_.jumps();
    return state;
}

QString TravelWatch::take(const TopicUpdate &update) {
    const auto passed = travel_.add(update.data);
    if (!passed)
        return passed.error().message;
    if (!*passed)
        return {};
    FiringCause cause;
    cause.n = (*passed)->n;
    cause.travelled = travel_.total();
    cause.pose = (*passed)->pose;
    fire(update, (*passed)->missed, cause);
    return {};
}

QString ConditionWatch::take(const TopicUpdate &update) {
    const QJsonValue data = update.json();
    const auto becomesTrue = condition_.becomesTrue(data);
    const QJsonValue value = lookUp(data, path_);
    if (!becomesTrue)
        return value.isUndefined() ? "there is no " + path_
                                   : QString("%1 is %2, not a number").arg(path_, shown(value));
    if (!*becomesTrue)
        return {};
    FiringCause cause;
    cause.value = value;
    fire(update, 0, cause);
    return {};
}

} // namespace hermes::softwaretrigger
