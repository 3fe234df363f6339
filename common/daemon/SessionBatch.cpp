// Batches of a session: one message a turn, and the reply when all have answered.
#include "common/daemon/Session.h"

#include "common/Time.h"

#include <QPointer>

namespace hermes {

void Session::begin(const QJsonArray &messages, const QByteArray &key) {
    if (messages.size() > limits_.batch) {
        replies_.forget(key);
        return refuse(RpcError(ErrorCode::OverLimit, QString("a batch of %1 messages; at most %2 are allowed")
                                                         .arg(messages.size())
                                                         .arg(limits_.batch)));
    }
    batch_ = std::make_shared<Batch>(messages, channel_->arrived(), key);
    updateReceiving();
}

bool Session::runNextOfBatch() {
    batchInTurns_ = false;
    if (!batch_ || isOverPending())
        return false;
    const std::shared_ptr<Batch> now = batch_;
    const int i = now->takeNext();
    const QPointer<Session> alive(this);
    const RpcMessage message = readFrame(QJsonArray{now->message(i)}).messages.front();
    process(message, now->arrived, [this, now, i](const QJsonValue &reply) {
        QByteArray frame;
        const bool isWanted = channel_->isOpen() && !now->isTooLarge(); // to encode it may take long
        if (!reply.isUndefined() && isWanted) {
            EncodedFrame encoded = channel_->codec().encode(reply);
            if (encoded.error) {
                ++counts_.errors;
                encoded = channel_->codec().encode(
                    makeError(reply.toObject().value(QStringLiteral("id")), *encoded.error));
            }
            frame = encoded.bytes;
        }
        now->answer(i, frame);
        if (now->isDone())
            finish(now);
    });
    if (!alive || batch_ != now)
        return false;
    if (now->isBegun()) {
        batch_.reset();
        if (ended_)
            Q_EMIT closed(*std::exchange(ended_, std::nullopt));
    }
    if (alive)
        updateReceiving();
    return false;
}

void Session::finish(const std::shared_ptr<Batch> &done) {
    if (done->isTooLarge()) {
        ++counts_.errors;
        const RpcError error(
            ErrorCode::OverLimit,
            QString("the replies to the batch are larger than %1 bytes together").arg(Batch::maxBytes));
        return send(makeError(QJsonValue(), error), done->key);
    }
    if (!makeRoom())
        return;
    const std::vector<QByteArray> pieces = done->take(channel_->codec());
    if (!channel_->isLossy()) {
        for (const QByteArray &piece : pieces)
            channel_->write(piece);
        return;
    }
    Sent reply;
    for (const QByteArray &piece : pieces)
        reply.frame += piece;
    reply.ticket =
        reply.frame.isEmpty() ? 0 : channel_->write(reply.frame, Channel::Rank::Assured).value_or(0);
    replies_.answer(done->key, reply, Channel::Rank::Assured, monotonicNow());
}

} // namespace hermes
