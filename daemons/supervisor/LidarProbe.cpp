#include "daemons/supervisor/LidarProbe.h"

#include "daemons/supervisor/PortUsers.h"
#include "protocol/velodyne/SensorModel.h"

#include <QElapsedTimer>
#include <QHostAddress>
#include <QMap>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace hermes::supervisor {
namespace {

constexpr int listenForTurns_ms = 1500, pollTurns_ms = 50;
constexpr std::size_t modelByte = velodyne::packetSize - 1;

/// A UDP port, closed with it.
class Port {
public:
    explicit Port(quint16 number)
        : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
        sockaddr_in local{};
        local.sin_family = AF_INET;
        local.sin_port = htons(number);
        if (socket_ < 0 || ::bind(socket_, reinterpret_cast<const sockaddr *>(&local), sizeof local) != 0)
            failure_ = errno;
    }
    ~Port() {
        if (socket_ >= 0)
            ::close(socket_);
    }
    Port(const Port &) = delete;
    Port &operator=(const Port &) = delete;

    int failure() const { return failure_; }
    int descriptor() const { return failure_ == 0 ? socket_ : -1; }

    /// The size of the next datagram that waits, or -1.
    ssize_t next(std::array<std::uint8_t, 2048> &bytes, QString &sender) const {
        sockaddr_in from{};
        socklen_t size = sizeof from;
        const auto count = ::recvfrom(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                      reinterpret_cast<sockaddr *>(&from), &size);
        if (count >= 0)
            sender = QHostAddress(ntohl(from.sin_addr.s_addr)).toString();
        return count;
    }

private:
    const int socket_;
    int failure_ = 0;
};

QString problemOf(const Port &port, quint16 number) {
    if (port.failure() != EADDRINUSE)
        return QString("UDP port %1 cannot be opened: %2").arg(number).arg(std::strerror(port.failure()));
    return QString("UDP port %1 is in use by %2; lidars are not searched there")
        .arg(number)
        .arg(PortUsers::ofUdpPort(number));
}

void tellModel(FoundLidar &lidar, std::uint8_t byte) {
    if (const auto *model = velodyne::findSensorModel(velodyne::Model(byte))) {
        lidar.model = model->name;
        lidar.key = model->key;
    }
}

} // namespace

std::vector<FoundLidar> LidarProbe::run(QStringList &problems) {
    const Port data(dataPort_), position(positionPort_);
    if (data.failure() != 0)
        problems.append(problemOf(data, dataPort_));
    if (position.failure() != 0)
        problems.append(problemOf(position, positionPort_));
    QMap<QString, FoundLidar> lidars;
    QMap<QString, bool> positions;
    QElapsedTimer listening;
    listening.start();
    // Also of who sends faster than this reads.
    const auto goesOn = [this, &listening] {
        return listening.elapsed() < listenForTurns_ms && !isCancelled_;
    };
    while (goesOn()) {
        pollfd ready[] = {{data.descriptor(), POLLIN, 0}, {position.descriptor(), POLLIN, 0}};
        ::poll(ready, 2, pollTurns_ms);
        std::array<std::uint8_t, 2048> bytes{};
        QString sender;
        while (data.failure() == 0 && goesOn()) {
            const auto size = data.next(bytes, sender);
            if (size < 0)
                break;
            if (size != ssize_t(velodyne::packetSize))
                continue;
            FoundLidar &lidar = lidars[sender];
            lidar.address = sender;
            lidar.port = dataPort_;
            lidar.rate_hz += 1; // the packets, as yet
            tellModel(lidar, bytes[modelByte]);
        }
        while (position.failure() == 0 && goesOn() && position.next(bytes, sender) >= 0)
            positions[sender] = true;
    }
    std::vector<FoundLidar> found;
    for (FoundLidar lidar : lidars) {
        lidar.rate_hz = std::round(lidar.rate_hz * 1000 / double(listening.elapsed()));
        lidar.positions = positions.value(lidar.address);
        found.push_back(lidar);
    }
    return found;
}

} // namespace hermes::supervisor
