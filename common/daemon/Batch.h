#pragma once

#include "common/channel/Channel.h"

#include <QJsonArray>

namespace hermes {

/// A batch on its way: the messages, and the replies as they come in, each in its place and encoded at once,
/// so that no step of it takes long.
class Batch {
public:
    /// More bytes of replies are too much for one frame.
    static constexpr qint64 maxBytes = 8 << 20;

    Batch(const QJsonArray &requests, const Arrival &when, const QByteArray &knownBy)
        : arrived(when)
        , key(knownBy)
        , messages_(requests)
        , frames_(size_t(requests.size()))
        , missing_(requests.size()) {}
    ~Batch();

    const Arrival arrived;
    const QByteArray key; ///< of the ReplyCache

    bool isBegun() const { return next_ == messages_.size(); } ///< all of it
    bool isDone() const { return missing_ == 0; }
    int takeNext() { return next_++; }
    QJsonValue message(int i) const { return messages_.at(i); }
    /// frame: empty for a notification.
    void answer(int i, const QByteArray &frame);
    qint64 bytes() const { return bytes_; }
    bool isTooLarge() const { return bytes_ > maxBytes; }
    /// The pieces of the frame; none when nothing is to be said.
    std::vector<QByteArray> take(const Codec &codec);

private:
    QJsonArray messages_;
    std::vector<QByteArray> frames_;
    int next_ = 0;
    int missing_;
    qint64 bytes_ = 0;
};

} // namespace hermes
