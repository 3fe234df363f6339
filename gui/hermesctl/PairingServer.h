#pragma once

#include "gui/hermesctl/PairingStream.h"

#include <QStringList>
#include <chrono>
#include <functional>
#include <list>

namespace hermes::ctl {

/// Waits for the one computer that proves the code; others are heard beside it, each for at most 5 s.
class PairingServer {
public:
    static constexpr int maxWrong = 3;

    struct Joined {
        std::unique_ptr<PairingStream> stream;
        QString address;
    };
    struct Listener {
        std::function<void(std::chrono::seconds left)> waiting; ///< about once a second
        std::function<void(const QString &address, int attemptsLeft)> wrong;
    };

    explicit PairingServer(const PairingSecret &secret)
        : secret_(secret) {}
    ~PairingServer();
    PairingServer(const PairingServer &) = delete;
    PairingServer &operator=(const PairingServer &) = delete;

    /// On all addresses of this computer.
    Result<void> listen(quint16 port);
    /// Error: nobody came in time, or the code was wrong three times. Then nobody is heard any more.
    Result<Joined> wait(std::chrono::milliseconds howLong, const Listener &listener);

private:
    struct Guest {
        std::unique_ptr<PairingStream> stream;
        QString address;
        QDeadlineTimer deadline;
        bool isReady = true; ///< as last looked; what it says is there already, perhaps
    };

    void close();
    void look(int most_ms);
    void accept();
    Result<void> advance(const Listener &listener);

    const PairingSecret secret_;
    sockets::Socket listening_ = sockets::none;
    int wrong_ = 0;
    std::list<Guest> guests_; // in their handshakes, the oldest first
    std::unique_ptr<Joined> joined_;
};

/// Where others on the network can reach this computer, IPv4 first; loopback where there is no other.
QStringList ownAddresses();

} // namespace hermes::ctl
