#include "common/interface/Listener.h"

#include "common/Log.h"
#include "common/Time.h"
#include "common/interface/Descriptors.h"

#include <chrono>

namespace hermes {
namespace {

constexpr std::chrono::milliseconds retryPause{500};
constexpr double toldAgain_s = 60;

} // namespace

bool Listener::isScarce(qintptr descriptor) {
    constexpr int last = 8; // a client that comes makes another one in a kept place go before
    if (descriptorsLeftAfter(descriptor) > last)
        return false;
    static quint64 turnedAway = 0;
    static double told = -1e9; // all are in the main thread
    ++turnedAway;
    if (const double now = monotonicNow(); now - told > 1) { // many may come
        told = now;
        logWarning(QStringLiteral("server"),
                   QStringLiteral("a client is turned away: nearly no file descriptors are left; %1 in all")
                       .arg(turnedAway));
    }
    return true;
}

SinglePeerListener::SinglePeerListener(Make make, QObject *parent)
    : Listener(parent)
    , make_(std::move(make)) {
    retry_.setInterval(retryPause);
    connect(&retry_, &QTimer::timeout, this, [this] {
        if (!open())
            return;
        retry_.stop();
        logInfo(QStringLiteral("server"), QStringLiteral("listening on %1 again").arg(address_));
    });
}

Result<void> SinglePeerListener::listen() {
    if (!open())
        return Error(ErrorCode::InputOutput, failure_);
    return {};
}

bool SinglePeerListener::open() {
    auto *const carrier = make_();
    carrier->setParent(this); // until somebody takes it
    carrier_ = carrier;
    const auto failing =
        connect(carrier, &Interface::closed, this, [this](const QString &reason) { failure_ = reason; });
    carrier->open();
    disconnect(failing);
    if (carrier->state() == Interface::State::Closed) {
        carrier->deleteLater();
        return false;
    }
    failure_.clear();
    address_ = carrier->name();
    connect(carrier, &Interface::closed, this, &SinglePeerListener::lose);
    Q_EMIT accepted(carrier);
    return true;
}

void SinglePeerListener::lose(const QString &reason) {
    failure_ = reason;
    if (const double now = monotonicNow(); told_ != reason || now - toldAt_ > toldAgain_s) {
        told_ = reason;
        toldAt_ = now;
        logWarning(QStringLiteral("server"),
                   QStringLiteral("%1; no client is heard there until it can be opened again").arg(reason));
    }
    retry_.start();
}

void SinglePeerListener::close() {
    retry_.stop();
    if (!carrier_)
        return;
    disconnect(carrier_, &Interface::closed, this, nullptr);
    carrier_->close();
}

} // namespace hermes
