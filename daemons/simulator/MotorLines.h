#pragma once

#include "daemons/simulator/DeviceLine.h"
#include "daemons/simulator/RoboClawEmulator.h"

#include <QStringList>
#include <functional>
#include <vector>

namespace hermes::simulator {

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
