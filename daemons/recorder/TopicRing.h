#pragma once

#include "daemons/recorder/McapRecorder.h"
#include "protocol/wire/WireValue.h"

#include <deque>
#include <map>

namespace hermes::recorder {

/// The last messages of all topics, as a car's black box keeps them: those of so many seconds, and the newest
/// before that of each topic. Tells when they are to be kept for good.
class TopicRing {
public:
    /// seconds: 0: keeps nothing. maxBytes: the oldest go when there are more.
    void open(double seconds, std::size_t maxBytes);
    bool isOpen() const { return seconds_ > 0; }

    void add(const KeptMessage &message);
    /// When the first of those seconds came; nothing: it is empty.
    std::optional<Moment> begin() const;
    /// In the order in which they came.
    std::vector<KeptMessage> messages() const;

    /// Why the robot stopped, or what is wrong since this message; empty: nothing new. topic: "DAEMON/TOPIC".
    QString alarm(const QString &topic, const WireView &data);

private:
    double seconds_ = 0;
    std::size_t maxBytes_ = 0, bytes_ = 0;
    std::deque<KeptMessage> messages_;
    std::map<int, KeptMessage> before_; ///< by topic
    std::map<QString, QString> wrong_;  ///< by topic, and the name of a health item
};

} // namespace hermes::recorder
