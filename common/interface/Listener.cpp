#include "common/interface/Listener.h"

namespace hermes {

SinglePeerListener::SinglePeerListener(Interface *onlyCarrier, QObject *parent)
    : Listener(parent)
    , carrier(onlyCarrier) {
    carrier->setParent(this);
}

Result<void> SinglePeerListener::listen() {
    QString failure;
    const auto connection =
        connect(carrier, &Interface::closed, this, [&failure](const QString &reason) { failure = reason; });
    carrier->open();
    disconnect(connection);
    if (!failure.isEmpty())
        return Error(ErrorCode::InputOutput, failure);
    lastAddress = carrier->name();
    Q_EMIT accepted(carrier);
    return {};
}

void SinglePeerListener::close() {
    if (carrier)
        carrier->close();
}

QString SinglePeerListener::address() const {
    return lastAddress;
}

} // namespace hermes
