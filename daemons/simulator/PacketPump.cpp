#include "daemons/simulator/PacketPump.h"

#include <arpa/inet.h>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <sys/socket.h>
#include <unistd.h>

namespace hermes::simulator {

Outcome<void> UdpSender::open(const std::string &host, std::uint16_t port) {
    close();
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1)
        return host + ": an IPv4 address such as 127.0.0.1 expected";
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0)
        return std::string("no UDP socket: ") + std::strerror(errno);
    const int on = 1;
    ::setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    // Connected, so that the address is not looked up for each packet. A receiver that is not there shows as
    // ECONNREFUSED of a later packet, which send() knows.
    if (::connect(socket_, reinterpret_cast<const sockaddr *>(&address), sizeof address) != 0) {
        const std::string error =
            host + ":" + std::to_string(port) + " cannot be sent to: " + std::strerror(errno);
        close();
        return error;
    }
    return {};
}

void UdpSender::close() {
    if (socket_ >= 0)
        ::close(socket_);
    socket_ = -1;
}

bool UdpSender::send(const std::uint8_t *bytes, std::size_t size) {
    ssize_t sent = ::send(socket_, bytes, size, 0);
    if (sent < 0 && errno == ECONNREFUSED) // told of an earlier packet
        sent = ::send(socket_, bytes, size, 0);
    return sent == ssize_t(size) || errno == ECONNREFUSED;
}

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

constexpr std::int64_t truthPeriod_ns = 20000000; // 50 Hz
constexpr int catchUpPackets = 4;                 // sent in a row when late
constexpr nanoseconds catchUpPause{300000};       // after them: at most seven times the rate of the sensor
constexpr nanoseconds stall = std::chrono::seconds(2);

std::int64_t utcNow_ns() {
    return std::chrono::duration_cast<nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

} // namespace

PacketPump::PacketPump(TruthSink truth, LineSink gps, LineSink scanner)
    : truth_(std::move(truth))
    , gps_(std::move(gps))
    , scanner_(std::move(scanner)) {}

PacketPump::~PacketPump() {
    stop();
}

Outcome<void> PacketPump::start(const World &world, const Simulation::Options &options,
                                const std::string &host, std::uint16_t port, std::uint16_t positionPort) {
    stop();
    Outcome<void> opened;
    if (port > 0)
        opened = data_.open(host, port);
    if (opened && port > 0 && positionPort > 0)
        opened = position_.open(host, positionPort);
    if (!opened)
        return opened;
    simulation_ = Simulation(world, options, utcNow_ns());
    random_.seed(std::minstd_rand::result_type(options.seed));
    counts_ = Counts();
    nextTruth_ns_ = simulation_.now_ns();
    sincePosition_ = sinceScanner_ = 0;
    scannerBytes_.clear();
    running_ = true;
    thread_ = std::thread([this] { run(); });
    return {};
}

void PacketPump::stop() {
    running_ = false;
    if (thread_.joinable())
        thread_.join();
    data_.close();
    position_.close();
}

void PacketPump::run() {
    Clock::time_point due = Clock::now();
    int inARow = 0;
    while (running_) {
        const nanoseconds lag = Clock::now() - due;
        if (lag < nanoseconds(0)) {
            std::this_thread::sleep_until(due);
            inARow = 0;
        } else if (++inARow > catchUpPackets) {
            std::this_thread::sleep_for(catchUpPause);
            inARow = 0;
        }
        const std::lock_guard<std::mutex> lock(mutex_);
        if (lag > stall) {
            const auto missed = std::uint64_t(lag.count() / velodyne::hdl32e.packetPeriod_ns());
            simulation_.skip(missed);
            counts_.skipped += missed;
            due += nanoseconds(std::int64_t(missed) * velodyne::hdl32e.packetPeriod_ns());
        }
        step();
        counts_.worstLag_s = std::max(counts_.worstLag_s, lag.count() * 1e-9);
        due += nanoseconds(velodyne::hdl32e.packetPeriod_ns());
    }
}

void PacketPump::step() {
    if (simulation_.now_ns() >= nextTruth_ns_) {
        truth_(simulation_.truth());
        nextTruth_ns_ += truthPeriod_ns;
        if (nextTruth_ns_ <= simulation_.now_ns()) // after a stall
            nextTruth_ns_ = simulation_.now_ns() + truthPeriod_ns;
    }
    if (const std::string_view sentences = simulation_.sentences(); !sentences.empty())
        gps_(std::string(sentences));
    scannerBytes_ += simulation_.scannerBytes();
    if (++sinceScanner_ >= packetsPerScannerBytes && !scannerBytes_.empty()) {
        scanner_(scannerBytes_);
        scannerBytes_.clear();
        sinceScanner_ = 0;
    }
    if (!data_.isOpen())
        return simulation_.skip(1);
    const auto &packet = simulation_.nextPacket();
    send(data_, packet.data(), packet.size(), counts_.sent);
    if (++sincePosition_ < packetsPerPosition)
        return;
    sincePosition_ = 0;
    if (position_.isOpen()) {
        const auto position = simulation_.positionPacket();
        send(position_, position.data(), position.size(), counts_.positions);
    }
}

void PacketPump::send(UdpSender &sender, const std::uint8_t *bytes, std::size_t size, std::uint64_t &sent) {
    if (fault_.swallows(random_))
        ++counts_.swallowed;
    else if (sender.send(bytes, size))
        ++sent;
    else
        ++counts_.sendErrors;
}

void PacketPump::with(const std::function<void(Simulation &)> &function) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (running_)
        function(simulation_);
}

void PacketPump::dropScannerBytes() {
    const std::lock_guard<std::mutex> lock(mutex_);
    scannerBytes_.clear();
}

void PacketPump::setFault(const LidarFault &fault) {
    const std::lock_guard<std::mutex> lock(mutex_);
    fault_ = fault;
}

LidarFault PacketPump::fault() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return fault_;
}

PacketPump::Counts PacketPump::counts() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return counts_;
}

} // namespace hermes::simulator
