#include "common/daemon/Session.h"

#include "common/Log.h"
#include "common/Time.h"

#include <QPointer>

namespace hermes {
namespace {

// The replies of a batch as they come in, each in its place.
struct Batch {
    std::vector<QJsonValue> replies;
    size_t missing = 0;

    QJsonArray toArray() const {
        QJsonArray array;
        for (const QJsonValue &reply : replies) {
            if (!reply.isUndefined())
                array.append(reply);
        }
        return array;
    }
};

} // namespace

Session::Session(quint64 id, Channel *theChannel, const CommandRegistry &registry,
                 const SessionLimits &theLimits, QObject *parent)
    : QObject(parent)
    , number(id)
    , channel(theChannel)
    , commands(registry)
    , limits(theLimits)
    , queue(*channel, limits.topicBytes, this)
    , lastSign(monotonicNow()) {
    channel->setParent(this);
    channel->codec().setFrameLimit(limits.frameBytes);
    connect(channel, &Channel::message, this, &Session::receive);
    connect(channel, &Channel::malformed, this, &Session::refuse);
    connect(channel, &Channel::closed, this, &Session::closed);
    connect(&channel->interface(), &Interface::received, this, [this] { lastSign = monotonicNow(); });
    connect(&channel->interface(), &Interface::drained, this, [this] { lastSign = monotonicNow(); });
}

void Session::checkIdle() {
    const bool waitsForTopics = !queue.isEmpty() && channel->interface().bytesToWrite() == 0;
    if (limits.idle_s > 0 && !waitsForTopics && monotonicNow() - lastSign > limits.idle_s)
        expel(QStringLiteral("no sign of life for %1 s").arg(limits.idle_s));
}

void Session::expel(const QString &reason) {
    logWarning(QStringLiteral("server"), QStringLiteral("closing client %1: %2").arg(name(), reason));
    close(reason);
}

void Session::refuse(const RpcError &error) {
    ++counts.errors;
    send(makeError(QJsonValue(), error));
}

void Session::receive(const QJsonValue &value) {
    const RpcFrame frame = readFrame(value);
    if (frame.batch)
        return receiveBatch(frame.messages);
    process(frame.messages.front(), [this](const QJsonValue &reply) {
        if (!reply.isUndefined())
            send(reply);
    });
}

void Session::receiveBatch(const std::vector<RpcMessage> &messages) {
    if (messages.size() > size_t(limits.batch)) {
        return refuse(
            RpcError(ErrorCode::OverLimit, QStringLiteral("a batch of %1 messages; at most %2 are allowed")
                                               .arg(messages.size())
                                               .arg(limits.batch)));
    }
    const auto batch = std::make_shared<Batch>();
    batch->replies.resize(messages.size(), QJsonValue::Undefined);
    batch->missing = messages.size();
    for (size_t i = 0; i < messages.size(); ++i) {
        process(messages[i], [this, batch, i](const QJsonValue &reply) {
            batch->replies[i] = reply;
            if (--batch->missing > 0)
                return;
            const QJsonArray replies = batch->toArray();
            if (!replies.isEmpty())
                send(replies);
        });
    }
}

void Session::process(const RpcMessage &message, const Answer &answer) {
    if (const auto *request = std::get_if<RpcRequest>(&message)) {
        run(*request, answer);
    } else if (const auto *invalid = std::get_if<RpcInvalid>(&message)) {
        ++counts.errors;
        answer(makeError(invalid->id, invalid->error));
    } else {
        ++counts.ignored;
        answer(QJsonValue::Undefined);
    }
}

void Session::run(const RpcRequest &request, const Answer &answer) {
    ++counts.requests;
    Call call;
    call.client = number;
    call.clientName = name();
    const QPointer<Session> alive(this);
    const Reply reply([this, alive, id = request.id, answer](const Result<QJsonValue> &result) {
        if (!alive)
            return;
        --pending;
        channel->setReceiving(pending < limits.pending);
        counts.errors += !result.ok();
        if (id.isUndefined())
            answer(QJsonValue::Undefined);
        else
            answer(result ? makeResult(id, *result) : makeError(id, result.error()));
    });
    ++pending;
    channel->setReceiving(pending < limits.pending);
    commands.execute(request, call, reply);
}

void Session::send(const QJsonValue &reply) {
    if (!channel->isOpen())
        return;
    Interface &carrier = channel->interface();
    if (carrier.bytesToWrite() > limits.replyBytes)
        carrier.flush();
    if (carrier.bytesToWrite() > limits.replyBytes) {
        return expel(QStringLiteral("does not read its replies: %1 bytes are unsent (limits.reply_bytes)")
                         .arg(carrier.bytesToWrite()));
    }
    const auto sent = channel->send(reply);
    if (sent)
        return;
    logError(name(), QStringLiteral("reply not sent: ") + sent.error().message);
    ++counts.errors;
    if (reply.isObject())
        channel->send(makeError(reply.toObject().value(QStringLiteral("id")), sent.error()));
    else
        channel->send(makeError(QJsonValue(), sent.error()));
}

} // namespace hermes
