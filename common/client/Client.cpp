#include "common/client/Client.h"

#include <QEventLoop>
#include <QRandomGenerator>
#include <QTimer>
#include <algorithm>

namespace hermes {
namespace {

// A daemon that is slow to agree changes its framing nevertheless: there is no going on without its answer.
constexpr std::chrono::hours longestAgreement{24};

constexpr int maxOfBatch = 1000; // each of its messages takes far more memory than it has bytes

constexpr std::chrono::seconds lookPeriod{5};

} // namespace

Client::Client(QObject *parent)
    : QObject(parent) {
    lookTimer_.setInterval(lookPeriod);
    connect(&lookTimer_, &QTimer::timeout, this, &Client::lookWhoIsThere);
}

Client::~Client() {
    if (channel_)
        channel_->disconnect(this);
}

Result<void> Client::connectTo(const QString &address) {
    const auto made = Channel::make(address, this);
    if (!made)
        return made.error();
    connectTo(*made);
    return {};
}

void Client::connectTo(Channel *newChannel) {
    close();
    channel_ = newChannel;
    channel_->setParent(this);
    channel_->interface().setReconnecting(true);
    channel_->codec().setFrameLimit(frameBytes_);
    connect(channel_, &Channel::opened, this, &Client::onOpened);
    connect(channel_, &Channel::closed, this, &Client::onClosed);
    connect(channel_, &Channel::message, this, &Client::onMessage);
    connect(channel_, &Channel::malformed, this, &Client::refuse);
    firstAttempt_.start();
    channel_->open();
}

void Client::setFrameLimit(int bytes) {
    frameBytes_ = bytes;
    if (channel_)
        channel_->codec().setFrameLimit(bytes);
}

void Client::close() {
    if (!channel_)
        return;
    Channel *const old = channel_;
    const bool open = old->isOpen() && !agreeing_;
    agreeing_ = false;
    old->disconnect(this);
    old->interface().setReconnecting(false);
    old->close(QStringLiteral("closed by this client"));
    old->deleteLater();
    channel_ = nullptr;
    if (open || !waiting_.isEmpty())
        onClosed(QStringLiteral("closed by this client"));
}

QString Client::address() const {
    return channel_ ? channel_->interface().name() : QString();
}

void Client::call(const QString &method, const QJsonValue &params, const Callback &callback,
                  std::chrono::milliseconds timeout, Repeats repeats) {
    send(method, params, callback, timeout, isConnected(), repeats);
}

void Client::send(const QString &method, const QJsonValue &params, const Callback &callback,
                  std::chrono::milliseconds timeout, bool mayBeSent, Repeats repeats) {
    const Channel::Rank rank = repeats == Repeats::AtOnce ? Channel::Rank::Urgent : Channel::Rank::Usual;
    const qint64 id = ++lastId_;
    waiting_.insert(id, callback);
    if (mayBeSent && repeats == Repeats::AtOnce)
        channel_->dropShortWaiting(); // a stop overtakes it, and a set-point must not come after its stop
    const bool wouldBeLate = mayBeSent && repeats == Repeats::None && channel_->hasShortWaiting();
    const auto sent =
        wouldBeLate
            ? Result<Sent>(Error(ErrorCode::OverLimit,
                                 QString("%1: not sent, the line is too slow for so many").arg(method)))
        : mayBeSent ? channel_->send(makeRequest(id, method, params), rank)
                    : Result<Sent>(Error(ErrorCode::Disconnected,
                                         QString("%1: not connected: %2").arg(method, problem())));
    if (!sent) {
        QMetaObject::invokeMethod(
            this, [this, id, error = sent.error()] { finish(id, error); }, Qt::QueuedConnection);
        return;
    }
    if (channel_->isLossy() && repeats != Repeats::None)
        repeater_.add(*channel_, id, *sent, rank);
    QTimer::singleShot(timeout, this, [this, id, method, timeout] {
        finish(id,
               Error(ErrorCode::TimedOut,
                     QString("%1: no reply within %2 s").arg(method).arg(double(timeout.count()) / 1000)));
    });
    if (rank == Channel::Rank::Urgent) { // before whatever this program computes next, such as a picture
        flushing_ = true;
        channel_->flush();
        flushing_ = false;
    }
}

void Client::callForMuch(const QString &method, const QJsonValue &params, const Callback &callback,
                         std::chrono::milliseconds timeout) {
    ++largeCalls_;
    if (channel_)
        channel_->codec().setFrameLimit(qMax(frameBytes_, largeFrame));
    const auto done = [this, callback](const Result<QJsonValue> &result) {
        if (--largeCalls_ == 0)
            setFrameLimit(frameBytes_);
        callback(result);
    };
    call(method, params, done, timeout);
}

bool Client::notify(const QString &method, const QJsonValue &params) {
    return isConnected() && channel_->send(makeNotification(method, params)).ok();
}

Result<QJsonValue> Client::callAndWait(const QString &method, const QJsonValue &params,
                                       std::chrono::milliseconds timeout, Repeats repeats) {
    QEventLoop loop;
    Result<QJsonValue> answer{QJsonValue()};
    call(
        method, params,
        [&](const Result<QJsonValue> &result) {
            answer = result;
            loop.quit();
        },
        timeout, repeats);
    loop.exec();
    return answer;
}

Result<void> Client::waitConnected(std::chrono::milliseconds timeout) {
    if (isConnected())
        return {};
    QEventLoop loop;
    QTimer limit;
    connect(this, &Client::connected, &loop, &QEventLoop::quit);
    connect(&limit, &QTimer::timeout, &loop, &QEventLoop::quit);
    limit.start(timeout);
    loop.exec();
    if (isConnected())
        return {};
    return Error(ErrorCode::Disconnected, problem());
}

QString Client::problem() const {
    return failure_.isEmpty() ? QString("%1: no answer").arg(address()) : failure_;
}

bool Client::isBeginning() const {
    constexpr qint64 longest_ms = 3000;
    return channel_ && firstAttempt_.isValid() && !firstAttempt_.hasExpired(longest_ms);
}

void Client::onOpened() {
    refused_ = {};
    preferred_.isEmpty() || channel_->isLossy() ? begin() : agree();
}

void Client::agree() {
    agreeing_ = true;
    failure_ = QString("%1: no answer yet").arg(address());
    const auto done = [this](const Result<QJsonValue> &result) {
        agreeing_ = false;
        if (!channel_ || !channel_->isOpen())
            return;
        if (auto codec = makeCodec(preferred_); result && codec)
            channel_->setCodec(std::move(codec));
        begin();
    };
    send(QStringLiteral("protocol.use"), QJsonObject{{QStringLiteral("name"), preferred_}}, done,
         longestAgreement, true);
}

void Client::begin() {
    firstAttempt_.invalidate();
    failure_.clear();
    if (channel_
            ->isLossy()) // whoever spoke here before may have had the first ids, and their replies are kept
        lastId_ = qint64(QRandomGenerator::system()->generate());
    daemonStarted_ = 0;
    for (const auto &subscription : subscriptions_)
        sendSubscription(subscription.first);
    Q_EMIT connected();
}

void Client::onClosed(const QString &reason) {
    if (flushing_) { // no call fails before it has returned
        const auto later = [this, closed = channel_, reason] {
            if (channel_ == closed)
                onClosed(reason);
        };
        QMetaObject::invokeMethod(this, later, Qt::QueuedConnection);
        return;
    }
    firstAttempt_.invalidate();
    failure_ = reason;
    for (auto &subscription : subscriptions_)
        subscription.second.id = 0;
    repeater_.clear();
    lookTimer_.stop();
    early_.clear();
    const auto calls = std::exchange(waiting_, {});
    for (const Callback &callback : calls)
        callback(Error(ErrorCode::Disconnected, reason));
    Q_EMIT disconnected(reason);
}

void Client::onMessage(const QJsonValue &message, const WireValue &topicData) {
    if (const int size = message.toArray().size(); size > maxOfBatch)
        return refuse({ErrorCode::OverLimit,
                       QString("a batch of %1 messages, expected %2 at most").arg(size).arg(maxOfBatch)});
    for (const RpcMessage &one : readFrame(message).messages) {
        if (const auto *response = std::get_if<RpcResponse>(&one))
            onResponse(*response);
        else if (const auto *request = std::get_if<RpcRequest>(&one))
            onNotification(*request, topicData);
        else
            refuse(std::get<RpcInvalid>(one).error);
    }
}

void Client::refuse(const RpcError &error) {
    ++refused_.unreadable;
    refused_.last = error.message;
    if (error.is(ErrorCode::OverLimit) || error.is(ErrorCode::ParseError))
        failFirst(
            Error(ErrorCode(error.code), QStringLiteral("what came is no usable reply: ") + error.message));
}

// What is too large or nested too deeply is not read, here or there, and so not even whose it is. Without
// topics, over a connection, it is that of the first call.
void Client::failFirst(const Error &error) {
    if (!channel_ || channel_->isLossy() || !subscriptions_.empty() || waiting_.isEmpty())
        return;
    const auto ids = waiting_.keys();
    finish(*std::min_element(ids.begin(), ids.end()), error);
}

void Client::onResponse(const RpcResponse &response) {
    const qint64 id = toCount(response.id);
    if (!waiting_.contains(id))
        ++refused_.unasked;
    if (response.failed && response.id.isNull())
        return failFirst(response.error);
    repeater_.end(id, true);
    if (waiting_.contains(id))
        finish(id, response.failed ? Result<QJsonValue>(response.error) : response.result);
}

void Client::finish(qint64 id, const Result<QJsonValue> &result) {
    repeater_.end(id, false);
    if (const Callback callback = waiting_.take(id))
        callback(result);
}

} // namespace hermes
