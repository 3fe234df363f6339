#pragma once

#include "common/client/Client.h"

#include <QTimer>
#include <optional>

namespace hermes::desktop {

/// Passes the newest message on, and no more of them than one a period, whatever the daemon sends. For topics
/// of which each message says everything.
class NewestOnly : public QObject {
    Q_OBJECT
public:
    NewestOnly(std::chrono::milliseconds period, Client::TopicCallback callback, QObject *parent);

    void take(const TopicUpdate &update);
    /// Nothing passes any more.
    void close() { isClosed_ = true; }

private:
    void pass();

    const Client::TopicCallback callback_;
    bool isClosed_ = false;
    QTimer timer_; // runs while nothing may pass
    std::optional<TopicUpdate> newest_;
};

} // namespace hermes::desktop
