#include "common/daemon/ReplyCache.h"

#include <QJsonArray>
#include <QJsonObject>
#include <algorithm>

namespace hermes {
namespace {

bool wantsReply(const QJsonValue &message) {
    const QJsonValue id = message.toObject().value(QStringLiteral("id"));
    return !id.isUndefined() && !id.isNull() && message.toObject().contains(QStringLiteral("method"));
}

} // namespace

QByteArray ReplyCache::keyOf(const QJsonValue &message, const QByteArray &digest) {
    const QJsonArray batch = message.toArray();
    if (!wantsReply(message) && std::none_of(batch.begin(), batch.end(), wantsReply))
        return {};
    return digest;
}

ReplyCache::Known ReplyCache::begin(const QByteArray &key, Channel &channel, double now) {
    limit(now);
    if (const auto known = entries_.find(key); known != entries_.end()) {
        ++repeats_;
        Entry &entry = **known;
        entry.wantedAt = now;
        if (!entry.answered)
            return Known::Repeat;
        answered_.splice(answered_.end(), answered_, *known);
        return repeat(entry, channel);
    }
    Entry entry;
    entry.key = key;
    entry.wantedAt = now;
    entries_.insert(key, running_.insert(running_.end(), entry));
    return Known::New;
}

ReplyCache::Known ReplyCache::repeat(Entry &entry, Channel &channel) {
    if (channel.isUnderWay(entry.reply.ticket))
        return Known::Repeat;
    if (entry.reply.frame.isEmpty())
        return Known::Lost;
    if (const auto ticket = channel.write(entry.reply.frame, entry.rank))
        entry.reply.ticket = *ticket;
    return Known::Repeat;
}

void ReplyCache::answer(const QByteArray &key, const Sent &reply, Channel::Rank rank, double now) {
    const auto known = entries_.find(key);
    if (known == entries_.end() || (*known)->answered)
        return;
    Entry &entry = **known;
    entry.reply = reply;
    entry.rank = rank;
    entry.answered = true;
    entry.wantedAt = now;
    if (reply.frame.size() > largestReply)
        entry.reply.frame.clear();
    bytes_ += entry.reply.frame.size();
    answered_.splice(answered_.end(), running_, *known);
    limit(now);
}

void ReplyCache::forget(const QByteArray &key) {
    if (const auto known = entries_.find(key); known != entries_.end())
        erase(*known);
}

void ReplyCache::limit(double now) {
    while (!answered_.empty() &&
           (entries_.size() > maxEntries || now - answered_.front().wantedAt > longestAge_s))
        erase(answered_.begin());
    for (auto oldest = answered_.begin(); bytes_ > maxBytes; ++oldest) {
        bytes_ -= oldest->reply.frame.size();
        oldest->reply.frame.clear();
    }
}

void ReplyCache::erase(Place place) {
    bytes_ -= place->reply.frame.size();
    entries_.remove(place->key);
    (place->answered ? answered_ : running_).erase(place);
}

} // namespace hermes
