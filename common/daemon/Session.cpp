#include "common/daemon/Session.h"

#include "common/Log.h"
#include "common/Time.h"
#include "common/Turns.h"

#include <QPointer>
#include <algorithm>

namespace hermes {
namespace {

constexpr int largestUrgentBytes = 4 << 10;
// In the parameters of one request, where commands are urgent: to check more takes long.
constexpr int mostValues = 1000;
constexpr int largeFrameBytes = 16 << 10; // takes half a millisecond to read
// What a client has sent before a gap may lie on its side, or in a tunnel, and come afterwards.
constexpr double settling_s = 0.25;

// Takes one from left for each value.
void countValues(const QJsonValue &value, int &left) {
    --left;
    if (value.isArray()) {
        const QJsonArray array = value.toArray();
        for (int i = 0; i < array.size() && left >= 0; ++i)
            countValues(array.at(i), left);
    } else if (value.isObject()) {
        const QJsonObject object = value.toObject();
        for (auto member = object.begin(); member != object.end() && left >= 0; ++member)
            countValues(member.value(), left);
    }
}

} // namespace

Session::Session(quint64 id, Channel *theChannel, const CommandRegistry &registry,
                 const SessionLimits &theLimits, GapWatch &watch, QObject *parent)
    : QObject(parent)
    , number(id)
    , channel(theChannel)
    , commands(registry)
    , limits(theLimits)
    , gaps(watch)
    , queue(*channel, limits.topicBytes, this)
    , lastSign(monotonicNow()) {
    channel->setParent(this);
    channel->codec().setFrameLimit(limits.frameBytes);
    channel->setLargeFrame(largeFrameBytes);
    if (!commands.urgent().isEmpty())
        channel->setUrgent([this](const QByteArray &frame) { return isUrgent(frame); });
    // It may have come, and spoken, while the program stood still.
    gaps.look();
    freshFor = gaps.sinceLast() < settling_s ? 0 : gaps.count();
    connect(channel, &Channel::message, this, &Session::receive);
    connect(channel, &Channel::malformed, this, &Session::refuse);
    connect(channel, &Channel::closed, this, &Session::end);
    connect(&channel->interface(), &Interface::closed, this, &Session::updateReceiving);
    connect(&channel->interface(), &Interface::received, this, [this] { lastSign = monotonicNow(); });
    connect(&channel->interface(), &Interface::drained, this, [this] { lastSign = monotonicNow(); });
}

void Session::checkIdle() {
    const bool waitsForTopics = !queue.isEmpty() && channel->interface().bytesToWrite() == 0;
    if (limits.idle_s > 0 && !waitsForTopics && monotonicNow() - lastSign > limits.idle_s)
        expel(QStringLiteral("no sign of life for %1 s").arg(limits.idle_s));
}

void Session::close(const QString &reason) {
    batch.reset(); // nobody wants the rest
    if (ended)
        Q_EMIT closed(*std::exchange(ended, std::nullopt));
    else
        channel->close(reason);
}

void Session::expel(const QString &reason) {
    logWarning(QStringLiteral("server"), QStringLiteral("closing client %1: %2").arg(name(), reason));
    close(reason);
}

void Session::end(const QString &reason) {
    if (!batch)
        Q_EMIT closed(reason);
    else
        ended = reason;
}

void Session::refuse(const RpcError &error) {
    ++counts.errors;
    send(makeError(QJsonValue(), error));
}

void Session::becomeFresh() {
    if (freshFor != gaps.count() && gaps.sinceLast() >= settling_s && !batch && channel->isQuiet())
        freshFor = gaps.count();
}

bool Session::isUrgent(const RpcMessage &message) const {
    const auto *request = std::get_if<RpcRequest>(&message);
    const Command *command = request ? commands.find(request->method) : nullptr;
    return command && command->isUrgent();
}

bool Session::isUrgent(const QByteArray &frame) const {
    if (frame.size() > largestUrgentBytes || pendingStops >= limits.pending)
        return false;
    const auto isNamed = [&frame](const QString &name) { return frame.contains(name.toUtf8()); };
    // A name may be written with escapes, too.
    if (!frame.contains('\\') && std::none_of(commands.urgent().begin(), commands.urgent().end(), isNamed))
        return false;
    const CodecItem item = channel->codec().read({frame, std::nullopt});
    return item.message.isObject() && isUrgent(readFrame(item.message).messages.front());
}

void Session::receive(const QJsonValue &value) {
    if (value.isArray() && !value.toArray().isEmpty())
        return begin(value.toArray());
    process(readFrame(value).messages.front(), channel->arrived(), [this](const QJsonValue &reply) {
        if (!reply.isUndefined())
            send(reply);
    });
}

void Session::begin(const QJsonArray &messages) {
    if (messages.size() > limits.batch) {
        return refuse(
            RpcError(ErrorCode::OverLimit, QStringLiteral("a batch of %1 messages; at most %2 are allowed")
                                               .arg(messages.size())
                                               .arg(limits.batch)));
    }
    batch = std::make_shared<Batch>(messages, channel->arrived());
    updateReceiving();
}

bool Session::runNextOfBatch() {
    batchInTurns = false;
    if (!batch || isOverPending())
        return false;
    const std::shared_ptr<Batch> now = batch;
    const int i = now->takeNext();
    const QPointer<Session> alive(this);
    const RpcMessage message = readFrame(QJsonArray{now->message(i)}).messages.front();
    process(message, now->arrived, [this, now, i](const QJsonValue &reply) {
        QByteArray frame;
        if (!reply.isUndefined()) {
            EncodedFrame encoded = channel->codec().encode(reply);
            if (encoded.error) {
                ++counts.errors;
                encoded = channel->codec().encode(
                    makeError(reply.toObject().value(QStringLiteral("id")), *encoded.error));
            }
            frame = encoded.bytes;
        }
        now->answer(i, frame);
        if (now->isDone())
            finish(now);
    });
    if (!alive || batch != now)
        return false;
    if (now->isBegun()) {
        batch.reset();
        if (ended)
            Q_EMIT closed(*std::exchange(ended, std::nullopt));
    }
    if (alive)
        updateReceiving();
    return false;
}

void Session::finish(const std::shared_ptr<Batch> &done) {
    if (done->isTooLarge()) {
        return refuse(RpcError(ErrorCode::OverLimit,
                               QStringLiteral("the replies to the batch are larger than %1 bytes together")
                                   .arg(Batch::mostBytes)));
    }
    if (!makeRoom())
        return;
    for (const QByteArray &piece : done->take(channel->codec()))
        channel->interface().write(piece);
}

void Session::process(const RpcMessage &message, double arrived, const Answer &answer) {
    if (const auto *request = std::get_if<RpcRequest>(&message)) {
        run(*request, arrived, answer);
    } else if (const auto *invalid = std::get_if<RpcInvalid>(&message)) {
        ++counts.errors;
        answer(makeError(invalid->id, invalid->error));
    } else {
        ++counts.ignored;
        answer(QJsonValue::Undefined);
    }
}

std::optional<Error> Session::refusal(const RpcRequest &request) const {
    const Command *command = commands.find(request.method);
    if (isRestricted() && !(command && command->isUrgent())) {
        return Error(ErrorCode::OverLimit, restrictedFor + QStringLiteral("; this place is kept for ") +
                                               commands.urgent().join(QStringLiteral(" and ")));
    }
    if (command && command->needsFresh() && freshFor != gaps.count()) {
        return Error(ErrorCode::NotReady,
                     gaps.text() + QStringLiteral("; what was received in that time is void"));
    }
    int left = mostValues;
    countValues(request.params, left);
    if (left < 0 && !commands.urgent().isEmpty()) {
        return Error(ErrorCode::OverLimit,
                     QStringLiteral("the parameters hold more than %1 values").arg(mostValues));
    }
    return std::nullopt;
}

void Session::run(const RpcRequest &request, double arrived, const Answer &answer) {
    ++counts.requests;
    gaps.look();
    Call call;
    call.client = number;
    call.clientName = name();
    call.time = arrived;
    const bool isStop = isUrgent(RpcMessage(request));
    const QPointer<Session> alive(this);
    // Many answers that come later come at once: each in its turn, but for those to stops.
    const auto atOnce = std::make_shared<bool>(true);
    const Reply reply(
        [this, alive, atOnce, isStop, id = request.id, answer](const Result<QJsonValue> &result) {
            if (!alive)
                return;
            const auto give = [this, alive, isStop, id, answer, result] {
                --(isStop ? pendingStops : pending);
                counts.errors += !result.ok();
                if (id.isUndefined())
                    answer(QJsonValue::Undefined);
                else
                    answer(result ? makeResult(id, *result) : makeError(id, result.error()));
                if (alive && isStop)
                    channel->interface().flush();
                if (alive)
                    updateReceiving();
                return false;
            };
            if (*atOnce || isStop)
                give();
            else
                Turns::ofThread().add(this, give);
        });
    ++(isStop ? pendingStops : pending);
    if (const auto refused = refusal(request))
        reply.error(*refused);
    else
        commands.execute(request, call, reply);
    *atOnce = false;
    if (alive)
        updateReceiving();
}

bool Session::isOverPending() const {
    return std::max(pending, pendingStops) >= limits.pending && channel->isOpen();
}

void Session::updateReceiving() {
    channel->setReceiving(!batch && !isOverPending());
    if (!batch || batchInTurns || isOverPending())
        return;
    batchInTurns = true;
    Turns::ofThread().add(this, [this] { return runNextOfBatch(); });
}

bool Session::makeRoom() {
    if (!channel->isOpen())
        return false;
    Interface &carrier = channel->interface();
    if (carrier.bytesToWrite() > limits.replyBytes)
        carrier.flush();
    if (carrier.bytesToWrite() <= limits.replyBytes)
        return true;
    expel(QStringLiteral("does not read its replies: %1 bytes are unsent (limits.reply_bytes)")
              .arg(carrier.bytesToWrite()));
    return false;
}

void Session::send(const QJsonValue &reply) {
    if (!makeRoom())
        return;
    const auto sent = channel->send(reply);
    if (sent)
        return;
    logError(name(), QStringLiteral("reply not sent: ") + sent.error().message);
    ++counts.errors;
    channel->send(makeError(reply.toObject().value(QStringLiteral("id")), sent.error()));
}

} // namespace hermes
