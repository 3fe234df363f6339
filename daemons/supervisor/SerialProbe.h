#pragma once

#include "daemons/supervisor/SerialCandidates.h"
#include "protocol/drive/MotorDevice.h"
#include "protocol/messages/Setup.h"

#include <QElapsedTimer>
#include <atomic>
#include <optional>
#include <string_view>
#include <termios.h>

namespace hermes::supervisor {

/// Looks what is at the far end of one serial line, in a thread that may wait. It listens first; only a line
/// that is silent is asked: for the version of a RoboClaw (command 21, two bytes), which moves nothing, then
/// whether it is a motor controller of another kind, or a scanner of those that are asked. A line that
/// another program has open is left alone.
class SerialProbe {
public:
    /// What may be asked for: without either nothing is sent. What scanners are asked would turn the motors
    /// of a RoboClaw in simple serial mode.
    struct Permission {
        bool controller = false, others = false;
    };

    /// isCancelled: gives up soon when it becomes true.
    SerialProbe(const SerialCandidate &candidate, Permission mayAsk, const std::atomic<bool> &isCancelled)
        : candidate_(candidate)
        , mayAsk_(mayAsk)
        , isCancelled_(isCancelled) {}

    /// Fifteen seconds at most.
    FoundSerial run();

private:
    /// Why it cannot be used, with the kind that tells so; an empty text: it is open.
    QString open();
    void close();
    void setBaud(int baud);
    /// What comes until something satisfies, or for so long.
    template <typename Enough>
    QByteArray receive(int most_ms, const Enough &enough);
    /// True: somebody talks by themselves, and found_ says who.
    bool listen();
    void ask();
    void send(std::string_view bytes);
    void setDtr(bool on);
    bool askOthers();
    bool askAs(const char *kind, int baud, drive::MotorDevice &device, const drive::Command &question,
               std::size_t zeros = 0);
    void findScanner(bool isOneWay);
    bool askAt(int baud, int timeout_ms);

    const SerialCandidate candidate_;
    const Permission mayAsk_;
    const std::atomic<bool> &isCancelled_;
    FoundSerial found_;
    QElapsedTimer begun_;
    int port_ = -1;
    bool isGone_ = false;
    std::optional<termios> before_; // its settings
};

} // namespace hermes::supervisor
