#include "tests/support/LoopbackInterface.h"

namespace hermes {

std::pair<LoopbackInterface *, LoopbackInterface *> LoopbackInterface::pair(QObject *parent) {
    auto *first = new LoopbackInterface(parent);
    auto *second = new LoopbackInterface(parent);
    first->other_ = second;
    second->other_ = first;
    return {first, second};
}

void LoopbackInterface::doClose() {
    if (!other_)
        return;
    LoopbackInterface *const end = other_;
    QMetaObject::invokeMethod(
        end, [end] { end->nowClosed(QStringLiteral("closed by the peer"), false); }, Qt::QueuedConnection);
}

bool LoopbackInterface::doWrite(const QByteArray &bytes) {
    if (!other_)
        return false;
    waiting_ += bytes.size();
    QMetaObject::invokeMethod(
        this, [this, bytes] { deliver(bytes); }, Qt::QueuedConnection);
    return true;
}

void LoopbackInterface::deliver(const QByteArray &bytes) {
    waiting_ -= bytes.size();
    if (other_ && other_->isOpen())
        other_->nowReceived(bytes);
    Q_EMIT drained();
}

} // namespace hermes
