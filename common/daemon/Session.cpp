#include "common/daemon/Session.h"
#include "common/ServiceAccount.h"

#include "common/Log.h"
#include "common/Time.h"
#include "common/Turns.h"

#include <QPointer>
#include <algorithm>

namespace hermes {
namespace {

constexpr int largestUrgentBytes = 4 << 10;
constexpr int maxValuesBesideUrgent = 1000;      // in the parameters of one request
constexpr int maxValuesOfAFrame = 50000;         // the same, in a batch
constexpr qint64 largestAtOnceBytes = 128 << 10; // of a reply
constexpr int largeFrameBytes = 16 << 10;        // takes half a millisecond to read
// What a client has sent before a gap may lie on its side, or in a tunnel, and come afterwards.
constexpr double settling_s = 0.25;
constexpr double maxUnderWay =
    4096; // requests of a client over a line; an id farther off is another client's

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

/// That it names; empty where there is none.
QString methodOf(const RpcMessage &message) {
    if (const auto *request = std::get_if<RpcRequest>(&message))
        return request->method;
    const auto *invalid = std::get_if<RpcInvalid>(&message);
    return invalid ? invalid->method : QString();
}

/// Of a client on this computer.
QString userText(const Peer &peer) {
    if (peer.place != Peer::Place::Computer)
        return {};
    return QString(" (user %1)")
        .arg(peer.user ? ServiceAccount::nameOf(*peer.user) : QStringLiteral("unknown"));
}

} // namespace

Session::Session(quint64 id, Channel *theChannel, const CommandRegistry &registry,
                 const SessionLimits &theLimits, GapWatch &watch, Audit &audit, QObject *parent)
    : QObject(parent)
    , number_(id)
    , channel_(theChannel)
    , commands_(registry)
    , limits_(theLimits)
    , gaps_(watch)
    , audit_(audit)
    , queue_(*channel_, limits_.topicBytes, this)
    , lastHeard_(monotonicNow())
    , who_(channel_->interface().peer())
    , user_(userText(who_)) {
    channel_->setParent(this);
    channel_->codec().setFrameLimit(limits_.frameBytes);
    channel_->setLargeFrame(largeFrameBytes);
    if (!commands_.urgent().isEmpty()) {
        channel_->codec().setValueLimit(maxValuesOfAFrame);
        channel_->setUrgent(
            [this](const QByteArray &frame, const QStringList &had) { return urgentName(frame, had); });
    }
    // It may have come, and spoken, while the program stood still.
    gaps_.look();
    freshFor_ = gaps_.sinceLast() < settling_s ? 0 : gaps_.count();
    connect(channel_, &Channel::message, this, &Session::receive);
    connect(channel_, &Channel::malformed, this, &Session::refuse);
    connect(channel_, &Channel::foreign, this, &Session::foreign);
    connect(channel_, &Channel::closed, this, &Session::end);
    connect(&channel_->interface(), &Interface::closed, this, &Session::updateReceiving);
    connect(&channel_->interface(), &Interface::received, this, [this] { lastHeard_ = monotonicNow(); });
    connect(&channel_->interface(), &Interface::drained, this, [this] { lastWritten_ = monotonicNow(); });
}

QString Session::name() const {
    return channel_->interface().name() + user_;
}

qint64 Session::heldBytes() const {
    return channel_->bytesToWrite() + channel_->bytesToRead() + queue_.bytes() +
           (batch_ ? batch_->bytes() : 0);
}

void Session::checkIdle() {
    const bool waitsForTopics = !queue_.isEmpty() && channel_->bytesToWrite() == 0;
    // A line has nobody else to make place for; closed it would be deaf to a stop.
    if (limits_.idle_s > 0 && !waitsForTopics && !channel_->isLine() &&
        monotonicNow() - lastSignOfLife() > limits_.idle_s)
        expel(QString("nothing came for %1 s").arg(limits_.idle_s));
}

void Session::close(const QString &reason) {
    batch_.reset(); // nobody wants the rest
    if (ended_)
        Q_EMIT closed(*std::exchange(ended_, std::nullopt));
    else
        channel_->close(reason);
}

void Session::expel(const QString &reason) {
    logWarning(QStringLiteral("server"), QString("closing client %1: %2").arg(name(), reason));
    if (channel_->bytesToWrite() <= limits_.replyBytes)
        channel_->send(makeError(QJsonValue(), RpcError(ErrorCode::OverLimit, reason)));
    close(reason);
}

void Session::end(const QString &reason) {
    if (!batch_)
        Q_EMIT closed(reason);
    else
        ended_ = reason;
}

void Session::refuse(const RpcError &error) {
    ++counts_.errors;
    send(makeError(QJsonValue(), error));
}

Result<void> Session::useProtocol(const QString &name) {
    if (!makeCodec(name))
        return invalidParams({{QStringLiteral("name"), name,
                               QStringLiteral("one of ") + codecNames().join(QStringLiteral(", "))}});
    if (channel_->isLossy()) // the reply would be in the one framing or the other
        return Error(ErrorCode::NotReady, QStringLiteral("the framing of a line cannot be changed"));
    if (batch_ || pending_ + pendingStops_ > 1 || !queue_.isEmpty())
        return Error(
            ErrorCode::NotReady,
            QStringLiteral("a client changes its framing before it subscribes, and while it waits for "
                           "nothing else"));
    const auto change = [this, name] { channel_->setCodec(makeCodec(name)); };
    QMetaObject::invokeMethod(channel_, change, Qt::QueuedConnection); // the reply has gone by then
    return {};
}

void Session::becomeFresh() {
    if (freshFor_ != gaps_.count() && gaps_.sinceLast() >= settling_s && !batch_ && channel_->isQuiet())
        freshFor_ = gaps_.count();
}

bool Session::isUrgent(const RpcMessage &message) const {
    const Command *command = commands_.find(methodOf(message));
    return command && command->isUrgent();
}

QString Session::urgentName(const QByteArray &frame, const QStringList &had) const {
    if (frame.size() > largestUrgentBytes || pendingStops_ >= limits_.pending)
        return {};
    const auto isNamed = [&](const QString &name) {
        return !had.contains(name) && frame.contains(name.toUtf8());
    };
    // A name may be written with escapes, too, in CBOR in pieces.
    constexpr char textInPieces = 0x7f;
    if (!frame.contains('\\') && !frame.contains(textInPieces) &&
        std::none_of(commands_.urgent().begin(), commands_.urgent().end(), isNamed))
        return {};
    const CodecItem item = channel_->codec().read({frame, std::nullopt});
    const RpcMessage message =
        item.message.isObject() ? readFrame(item.message).messages.front() : RpcMessage();
    return isUrgent(message) && !had.contains(methodOf(message)) ? methodOf(message) : QString();
}

void Session::receive(const QJsonValue &value) {
    const bool isBatch = value.isArray() && !value.toArray().isEmpty();
    const RpcMessage message = isBatch ? RpcMessage() : readFrame(value).messages.front();
    // A stop stops each time that it comes, whatever has been since.
    const bool mayBeRepeat = channel_->isLossy() && !isUrgent(message);
    const QByteArray key = mayBeRepeat ? ReplyCache::keyOf(value, channel_->digest()) : QByteArray();
    if (!key.isEmpty() && isRepeat(key, value))
        return stopAgain(value.toArray());
    if (isBatch)
        return begin(value.toArray(), key);
    process(message, channel_->arrived(), [this, key, rank = rankOf(message)](const QJsonValue &reply) {
        if (!reply.isUndefined())
            send(reply, key, rank);
    });
}

// What came in pieces is not soon sent again; so its reply must arrive.
Channel::Rank Session::rankOf(const RpcMessage &message) const {
    using Rank = Channel::Rank;
    return isUrgent(message) ? Rank::Urgent : channel_->arrivedInPieces() ? Rank::Assured : Rank::Usual;
}

bool Session::isRepeat(const QByteArray &key, const QJsonValue &value) {
    const ReplyCache::Known known = replies_.begin(key, *channel_, monotonicNow());
    if (known == ReplyCache::Known::Lost) {
        channel_->send(
            makeError(value.isObject() ? value.toObject().value(QStringLiteral("id")) : QJsonValue(),
                      RpcError(ErrorCode::OverLimit,
                               QStringLiteral("this was carried out; the reply is not kept any more"))));
    }
    return known != ReplyCache::Known::New;
}

void Session::stopAgain(const QJsonArray &batch) {
    if (commands_.urgent().isEmpty())
        return;
    for (const QJsonValue &one : batch) {
        const RpcMessage message = readFrame(QJsonArray{one}).messages.front();
        if (isUrgent(message))
            process(message, channel_->arrived(), [](const QJsonValue &) {});
    }
}

void Session::noteStop(const QJsonValue &id) {
    if (id.isDouble() && !isBeforeStop(id))
        lastStop_ = id.toDouble();
}

// Over a line the first copy of a request may be lost, and a repeat come after the stop that its client sent
// later. Clients count their ids up, from a random number on.
bool Session::isBeforeStop(const QJsonValue &id) const {
    const double before = lastStop_ && id.isDouble() ? *lastStop_ - id.toDouble() : 0;
    return before > 0 && before < maxUnderWay;
}

void Session::process(const RpcMessage &message, const Arrival &arrived, const Answer &answer) {
    if (const auto *request = std::get_if<RpcRequest>(&message)) {
        run(*request, arrived, answer);
    } else if (const auto *invalid = std::get_if<RpcInvalid>(&message)) {
        if (isUrgent(message)) // a stop is never refused for its form
            return run({invalid->id, invalid->method, {}}, arrived, answer);
        ++counts_.errors;
        answer(makeError(invalid->id, invalid->error));
    } else {
        ++counts_.ignored;
        answer(QJsonValue::Undefined);
    }
}

std::optional<Error> Session::refusal(const RpcRequest &request) const {
    const Command *command = commands_.find(request.method);
    if (isRestricted() && !(command && command->isUrgent())) {
        return Error(ErrorCode::OverLimit, restrictedFor_ + QStringLiteral("; this place is kept for ") +
                                               commands_.urgent().join(QStringLiteral(" and ")));
    }
    if (command && command->needsFresh() && freshFor_ != gaps_.count()) {
        return Error(ErrorCode::NotReady,
                     gaps_.text() + QStringLiteral("; what was received in that time is void"));
    }
    if (command && command->needsFresh() && isBeforeStop(request.id))
        return Error(ErrorCode::NotReady,
                     QStringLiteral("by its id this is older than a stop that has come: it is void"));
    if (!command || command->isUrgent())
        return std::nullopt;
    const int most = commands_.urgent().isEmpty() ? command->maxValues() : maxValuesBesideUrgent;
    int left = most;
    countValues(request.params, left);
    if (left < 0)
        return Error(ErrorCode::OverLimit, QString("the parameters hold more than %1 values").arg(most));
    return std::nullopt;
}

void Session::run(const RpcRequest &request, const Arrival &arrived, const Answer &answer) {
    ++counts_.requests;
    gaps_.look();
    Call call;
    call.client = number_;
    call.clientName = name();
    call.role = role_;
    call.moreRights = more_;
    call.time = arrived.time;
    call.earliest = arrived.earliest;
    const bool isStop = isUrgent(RpcMessage(request));
    if (isStop && channel_->isLossy())
        noteStop(request.id);
    const QPointer<Session> alive(this);
    const auto note = [audit = QPointer<Audit>(&audit_), call, command = commands_.find(request.method),
                       params = request.params](const Result<QJsonValue> &result) {
        if (audit && command && command->isAudited())
            audit->note(call, *command, params, result);
    };
    // Many answers that come later come at once: each in its turn, but for those to stops.
    const auto atOnce = std::make_shared<bool>(true);
    const Reply reply(
        [this, alive, atOnce, isStop, id = request.id, answer, note](const Result<QJsonValue> &result) {
            note(result);
            if (!alive)
                return;
            const auto give = [this, alive, isStop, id, answer, result] {
                --(isStop ? pendingStops_ : pending_);
                counts_.errors += !result.ok();
                if (id.isUndefined())
                    answer(QJsonValue::Undefined);
                else
                    answer(result ? makeResult(id, *result) : makeError(id, result.error()));
                if (alive && isStop)
                    channel_->flush();
                if (alive)
                    updateReceiving();
                return false;
            };
            if (*atOnce || isStop)
                give();
            else
                Turns::ofThread().add(this, give);
        });
    ++(isStop ? pendingStops_ : pending_);
    if (const auto refused = refusal(request))
        reply.error(*refused);
    else
        commands_.execute(request, call, reply);
    *atOnce = false;
    if (alive)
        updateReceiving();
}

bool Session::isOverPending() const {
    return std::max(pending_, pendingStops_) >= limits_.pending && channel_->isOpen();
}

void Session::updateReceiving() {
    channel_->setReceiving(!batch_ && !isOverPending());
    if (!batch_ || batchInTurns_ || isOverPending())
        return;
    batchInTurns_ = true;
    Turns::ofThread().add(this, [this] { return runNextOfBatch(); });
}

bool Session::makeRoom() {
    if (!channel_->isOpen())
        return false;
    if (channel_->bytesToWrite() > limits_.replyBytes)
        channel_->flush();
    if (channel_->bytesToWrite() <= limits_.replyBytes || channel_->isLine())
        return true;
    expel(QString("does not read its replies: %1 bytes are unsent (limits.reply_bytes)")
              .arg(channel_->bytesToWrite()));
    return false;
}

// Closed it would be deaf.
std::optional<Error> Session::overfull() const {
    if (!channel_->isLine() || channel_->bytesToWrite() <= limits_.replyBytes)
        return std::nullopt;
    return Error(
        ErrorCode::OverLimit,
        QString("%1 bytes of replies wait to be sent (limits.reply_bytes)").arg(channel_->bytesToWrite()));
}

void Session::send(const QJsonValue &reply, const QByteArray &key, Channel::Rank rank) {
    if (!makeRoom())
        return;
    const bool isAlone = channel_->bytesToWrite() == 0 && !channel_->hasWaiting() && !channel_->isLine();
    const auto full = overfull();
    auto sent = full ? Result<Sent>(*full) : channel_->send(reply, rank);
    if (!sent) {
        logError(name(), QStringLiteral("reply not sent: ") + sent.error().message);
        ++counts_.errors;
        sent = channel_->send(makeError(reply.toObject().value(QStringLiteral("id")), sent.error()), rank);
    }
    if (!key.isEmpty() && sent)
        replies_.answer(key, *sent, rank, monotonicNow());
    // Who waits for this one has it before the others' turns; many replies go out together, a large one bit
    // by bit.
    if (isAlone && channel_->bytesToWrite() <= largestAtOnceBytes)
        channel_->flush();
}

} // namespace hermes
