#include "common/interface/Listener.h"

#include "common/Log.h"

#include <sys/resource.h>

namespace hermes {

bool Listener::isScarce(qintptr descriptor) {
    constexpr rlim_t spareDescriptors = 8;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || rlim_t(descriptor) + spareDescriptors < limit.rlim_cur)
        return false;
    logWarning(QStringLiteral("server"),
               QStringLiteral("a client is turned away: the file descriptors are nearly used up"));
    return true;
}

SinglePeerListener::SinglePeerListener(Interface *onlyCarrier, QObject *parent)
    : Listener(parent)
    , carrier_(onlyCarrier) {
    carrier_->setParent(this);
}

Result<void> SinglePeerListener::listen() {
    QString failure;
    const auto connection =
        connect(carrier_, &Interface::closed, this, [&failure](const QString &reason) { failure = reason; });
    carrier_->open();
    disconnect(connection);
    if (!failure.isEmpty())
        return Error(ErrorCode::InputOutput, failure);
    lastAddress_ = carrier_->name();
    Q_EMIT accepted(carrier_);
    return {};
}

void SinglePeerListener::close() {
    if (carrier_)
        carrier_->close();
}

QString SinglePeerListener::address() const {
    return lastAddress_;
}

} // namespace hermes
