#pragma once

#include "common/interface/Interface.h"

#include <QPointer>
#include <utility>

namespace hermes {

/// Two ends in memory: what one writes the other receives, from the event loop, never inside write().
class LoopbackInterface : public Interface {
    Q_OBJECT
public:
    /// A connected pair; open both. Closing one closes the other.
    static std::pair<LoopbackInterface *, LoopbackInterface *> pair(QObject *parent);

    QString name() const override { return QStringLiteral("loopback"); }
    qint64 bytesToWrite() const override { return waiting_; }

protected:
    void doOpen() override { nowOpen(); }
    void doClose() override;
    bool doWrite(const QByteArray &bytes) override;

private:
    explicit LoopbackInterface(QObject *parent)
        : Interface(parent) {}
    void deliver(const QByteArray &bytes);

    QPointer<LoopbackInterface> other_;
    qint64 waiting_ = 0;
};

} // namespace hermes
