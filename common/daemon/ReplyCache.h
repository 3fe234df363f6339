#pragma once

#include "common/channel/Channel.h"

#include <QByteArray>
#include <QHash>
#include <list>

namespace hermes {

/// The replies to a client that repeats its requests, since a line may lose them and their replies: a
/// repeated one is not carried out again. A repeat is the same frame, byte for byte. Bounded in count,
/// age, and bytes of replies; what is being carried out is always known.
class ReplyCache {
public:
    /// Beyond these the oldest is forgotten: a repeat of it is a new request.
    static constexpr int maxEntries = 1024;
    static constexpr double longestAge_s = 300; ///< since it was wanted last
    /// Beyond it the oldest reply is forgotten, not that there was one.
    static constexpr qint64 maxBytes = 1 << 20;
    static constexpr qint64 largestReply = 512 << 10; ///< that is kept

    enum class Known {
        New,
        Repeat, ///< has been seen to
        Lost    ///< was carried out, but the reply is gone
    };

    /// What a repeat is known by: its frame, whose digest this is. Empty: nothing in the message has an id to
    /// answer to.
    static QByteArray keyOf(const QJsonValue &message, const QByteArray &digest);

    /// Begins a request; the reply to a repeat is written again, if there is one and it is not on its way.
    Known begin(const QByteArray &key, Channel &channel, double now);
    /// The reply was sent.
    void answer(const QByteArray &key, const Sent &reply, Channel::Rank rank, double now);
    /// It was not carried out, or has no reply.
    void forget(const QByteArray &key);
    quint64 repeats() const { return repeats_; }
    int size() const { return entries_.size(); }
    qint64 bytes() const { return bytes_; } ///< of replies

private:
    struct Entry {
        QByteArray key;
        Sent reply;
        Channel::Rank rank = Channel::Rank::Usual;
        bool answered = false;
        double wantedAt = 0;
    };
    using Place = std::list<Entry>::iterator;

    Known repeat(Entry &entry, Channel &channel);
    void limit(double now);
    void erase(Place place);

    std::list<Entry> answered_; // wanted last stands last
    std::list<Entry> running_;
    QHash<QByteArray, Place> entries_;
    qint64 bytes_ = 0;
    quint64 repeats_ = 0;
};

} // namespace hermes
