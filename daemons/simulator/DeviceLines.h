#pragma once

#include "common/Result.h"
#include "common/interface/PtyInterface.h"
#include "daemons/simulator/RoboClawEmulator.h"

#include <QStringList>

#include <functional>
#include <vector>

namespace hermes::simulator {

/// A simulated device's serial line: the link under which programs find it, if any, and the device.
struct LineState {
    QString link, device; ///< no device while it is pulled
};

/// The far end of a simulated device's serial line, open; link: where programs find it, none when empty.
/// Error names what cannot be made.
Result<std::shared_ptr<PtyInterface>> openDeviceLine(const QString &link);

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
    static constexpr qint64 maxUnread = 2048;

    std::shared_ptr<PtyInterface> pty_;
    GpsLineState state_;
};

/// The serial lines of the simulated motor controllers: pseudo-terminals under links that stay the same.
class MotorLines : public QObject {
public:
    /// What the controllers on a line (0 or 1) answer to bytes that came now (seconds, monotonic).
    using Device =
        std::function<std::vector<RoboClawEmulator::Answer>(int line, const QByteArray &bytes, double now)>;

    explicit MotorLines(Device device)
        : device_(std::move(device)) {}

    /// One line for each link; an empty text makes a line without link. Error names what cannot be made.
    Result<void> open(const QStringList &links);
    void close();

    int count() const { return int(lines_.size()); }
    /// As when the cable is pulled: device and link vanish. Put back, there is a new device under the link.
    void setPulled(int line, bool pulled);
    /// Link and device of each; no device while it is pulled.
    std::vector<LineState> state() const;

private:
    struct Line {
        QString link;
        std::shared_ptr<PtyInterface> pty;
    };

    void receive(int line, const QByteArray &bytes);

    Device device_;
    std::vector<Line> lines_;
};

} // namespace hermes::simulator
