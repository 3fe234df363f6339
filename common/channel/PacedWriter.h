#pragma once

#include "common/interface/Interface.h"
#include "protocol/jsonrpc/Codec.h"

#include <QObject>
#include <QTimer>
#include <memory>

namespace hermes {

/// Writes what a link has to say to its carrier: only so much at a time that what is urgent does not wait
/// behind it. Where the carrier knows its rate, that is what goes out within some milliseconds, whatever the
/// buffers below would take.
class PacedWriter : public QObject {
    Q_OBJECT
public:
    /// codec: one that has a link.
    PacedWriter(Interface &carrier, const std::shared_ptr<Codec> &codec, QObject *parent);

    SerialLink &link() { return link_; }
    /// Tells the link the time and writes what may go now; to be called after each change of the link.
    void pump();
    /// The same, and tells that there may be room.
    void resume();

Q_SIGNALS:
    void resumed();

private:
    bool mayWrite(double now) const;
    double lag(double now) const;
    void schedule(double now);

    Interface &carrier_;
    const std::shared_ptr<Codec> codec_; // keeps the link
    SerialLink &link_;
    QTimer timer_;
    double busyUntil_ = 0; // the line, if it is as fast as the carrier says; monotonic
    bool pumping_ = false;
};

} // namespace hermes
