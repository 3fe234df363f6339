#pragma once

#include "protocol/jsonrpc/Codec.h"

#include <QJsonArray>

namespace hermes {

/// A batch on its way: the messages, and the replies as they come in, each in its place and encoded at once,
/// so that no step of it takes long.
class Batch {
public:
    /// More bytes of replies are too much for one frame.
    static constexpr qint64 mostBytes = 8 << 20;

    Batch(const QJsonArray &requests, double when)
        : arrived(when)
        , messages(requests)
        , frames(size_t(requests.size()))
        , missing(requests.size()) {}
    ~Batch();

    const double arrived; ///< Channel::arrived()

    bool isBegun() const { return next == messages.size(); } ///< all of it
    bool isDone() const { return missing == 0; }
    int takeNext() { return next++; }
    QJsonValue message(int i) const { return messages.at(i); }
    /// frame: empty for a notification.
    void answer(int i, const QByteArray &frame);
    bool isTooLarge() const { return bytes > mostBytes; }
    /// The pieces of the frame; none when nothing is to be said.
    std::vector<QByteArray> take(const Codec &codec);

private:
    QJsonArray messages;
    std::vector<QByteArray> frames;
    int next = 0;
    int missing;
    qint64 bytes = 0;
};

} // namespace hermes
