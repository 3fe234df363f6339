#include "gui/desktop/model/NewestOnly.h"

#include <utility>

namespace hermes::desktop {

NewestOnly::NewestOnly(std::chrono::milliseconds period, Client::TopicCallback callback, QObject *parent)
    : QObject(parent)
    , callback_(std::move(callback)) {
    timer_.setSingleShot(true);
    timer_.setInterval(period);
    connect(&timer_, &QTimer::timeout, this, &NewestOnly::pass);
}

void NewestOnly::take(const TopicUpdate &update) {
    newest_ = update;
    if (!timer_.isActive())
        pass();
}

void NewestOnly::pass() {
    if (!newest_ || isClosed_)
        return;
    timer_.start();
    callback_(*std::exchange(newest_, std::nullopt)); // may end the subscription
}

} // namespace hermes::desktop
