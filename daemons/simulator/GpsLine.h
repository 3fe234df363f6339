#pragma once

#include "daemons/simulator/DeviceLine.h"

namespace hermes::simulator {

/// The line of the GPS receiver; bytes sent, and those that no program has read in time.
struct GpsLineState {
    LineState line;
    qint64 bytes = 0, unreadLost = 0;
};

/// The serial line of the simulated GPS receiver: a pseudo-terminal under a link that stays the same.
class GpsLine {
public:
    /// Error names what cannot be made.
    Result<void> open(const QString &link);
    void close() { pty_.reset(); }

    /// Sends it. What no program has read is lost when a later message finds more than some seconds of it.
    void send(const QByteArray &sentences);
    /// As when the cable is pulled: device and link vanish. Put back, there is a new device under the link.
    void setPulled(bool pulled);
    const GpsLineState &state();

private:
    /// At 10 Hz it is 1.4 s, at 1 Hz it is 14 s.
    static constexpr qint64 mostUnread = 2048;

    std::shared_ptr<PtyInterface> pty_;
    GpsLineState state_;
};

} // namespace hermes::simulator
