#include "common/interface/LoopbackInterface.h"

namespace hermes {

std::pair<LoopbackInterface *, LoopbackInterface *> LoopbackInterface::pair(QObject *parent) {
    auto *first = new LoopbackInterface(parent);
    auto *second = new LoopbackInterface(parent);
    first->other = second;
    second->other = first;
    return {first, second};
}

void LoopbackInterface::doClose() {
    if (!other)
        return;
    LoopbackInterface *const end = other;
    QMetaObject::invokeMethod(
        end, [end] { end->nowClosed(QStringLiteral("closed by the peer"), false); }, Qt::QueuedConnection);
}

bool LoopbackInterface::doWrite(const QByteArray &bytes) {
    if (!other)
        return false;
    waiting += bytes.size();
    QMetaObject::invokeMethod(
        this, [this, bytes] { deliver(bytes); }, Qt::QueuedConnection);
    return true;
}

void LoopbackInterface::deliver(const QByteArray &bytes) {
    waiting -= bytes.size();
    if (other && other->isOpen())
        other->nowReceived(bytes);
    Q_EMIT drained();
}

} // namespace hermes
