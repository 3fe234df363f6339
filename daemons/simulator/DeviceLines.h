#pragma once

#include "common/Result.h"
#include "common/interface/PtyInterface.h"
#include "common/interface/TcpServerInterface.h"
#include "daemons/simulator/MotorEmulator.h"

#include <QPointer>
#include <QStringList>

#include <functional>
#include <memory>
#include <vector>

namespace hermes::simulator {

/// A simulated device's serial line: the link under which programs find it, if any, and the device. Or where
/// it listens.
struct LineState {
    QString link, device; ///< no device while it is pulled
};

/// The far end of a simulated device's serial line, open; link: where programs find it, none when empty.
/// Error names what cannot be made.
Result<std::shared_ptr<PtyInterface>> openDeviceLine(const QString &link);

/// The line of a sensor; bytes sent, and those that no program has read in time.
struct SensorLineState {
    LineState line;
    qint64 bytes = 0, unreadLost = 0;
};

/// The serial line of a simulated sensor: a pseudo-terminal under a link that stays the same. Or its network:
/// a TCP port to which one program at a time can connect.
class SensorLine {
public:
    /// Of what comes from the program; nothing: it has closed its connection.
    using Receiver = std::function<void(const QByteArray &)>;

    /// baud: a program that sets another one gets garbage, and its bytes do not arrive; 0: any will do.
    /// patience_s: so long a program may be behind.
    Result<void> open(
        const QString &link, int baud = 0, double patience_s = 0,
        const Receiver &received = [](const QByteArray &) {});
    /// Listens on this port of 127.0.0.1.
    Result<void> listen(std::uint16_t port, const Receiver &received);
    void close() {
        pty_.reset();
        server_.reset();
    }

    /// Sends it. What no program has read is lost when a program is behind for too long.
    void send(QByteArray bytes);
    /// As when the cable is pulled: device and link vanish, or the connection ends and nobody can connect.
    /// Put back, there is a new device under the link.
    void setPulled(bool pulled);
    const SensorLineState &state();

private:
    /// More than so many bytes: a program is behind. Of a GPS receiver at 10 Hz it is 1.4 s.
    static constexpr qint64 maxUnread = 2048;
    /// Over a network the system keeps some, too.
    static constexpr qint64 maxUnsent = 64 << 10;

    bool isGarbled() const { return baud_ > 0 && pty_->baud() != baud_; }
    void take(Interface *program, const Receiver &received);

    std::shared_ptr<PtyInterface> pty_;
    std::unique_ptr<TcpServerInterface> server_;
    QPointer<Interface> program_; ///< on the network
    bool pulled_ = false;         ///< from it
    SensorLineState state_;
    int baud_ = 0;
    double patience_s_ = 0;
    double behindSince_ = 0; ///< monotonic; of bytes that no program has read:
    qint64 behind_ = 0;
    std::minstd_rand garbage_;
};

/// The serial lines of the simulated motor controllers: pseudo-terminals under links that stay the same.
class MotorLines : public QObject {
public:
    /// What the controllers on a line (0 or 1) answer to bytes that came now (seconds, monotonic).
    using Device =
        std::function<std::vector<MotorEmulator::Answer>(int line, const QByteArray &bytes, double now)>;

    explicit MotorLines(Device device)
        : device_(std::move(device)) {}

    /// One line for each link; an empty text makes a line without link. Error names what cannot be made.
    /// baud: at another one all bytes are garbage, both ways; 0: any will do.
    Result<void> open(const QStringList &links, int baud = 0);
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
    int baud_ = 0;
    std::minstd_rand garbage_;
};

} // namespace hermes::simulator
