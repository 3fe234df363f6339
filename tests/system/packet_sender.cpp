// Sends data packets of an HDL-32E to a port of this host, each with its number, as evenly as the host
// allows, and prints how many it sent: packet_sender PORT RATE_HZ SECONDS FIRST_NUMBER [POSITION_PORT]. The
// first eight returns hold the number; the stamps follow it, whatever the rate. With a position port every
// 14th packet is followed by a position packet.
#include "protocol/velodyne/DataPacket.h"
#include "protocol/velodyne/Hdl32e.h"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

using namespace hermes::velodyne;

namespace {

volatile std::sig_atomic_t ended = 0;

void write(int socket, int port, const std::uint8_t *bytes, std::size_t size) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(std::uint16_t(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::sendto(socket, bytes, size, 0, reinterpret_cast<const sockaddr *>(&to), sizeof to) !=
        ssize_t(size)) {
        std::perror("packet_sender: sendto");
        std::exit(1);
    }
}

/// Every laser sees something, so that there is much to decode.
DataPacketWriter fullPacket() {
    DataPacketWriter packet;
    for (int block = 0; block < blocksPerPacket; ++block)
        for (int slot = 0; slot < hdl32e.lasers; ++slot)
            packet.setReturn(block, slot, std::uint16_t(2500 + 10 * slot), 100);
    return packet;
}

void sendPacket(int socket, int port, long number) {
    static DataPacketWriter packet = fullPacket();
    for (int block = 0; block < blocksPerPacket; ++block)
        packet.setAzimuth(block, std::uint16_t((number * blocksPerPacket + block) * 17 % azimuthSteps));
    for (int i = 0; i < 8; ++i)
        packet.setReturn(0, i, 2500, std::uint8_t(number >> (8 * i)));
    packet.setTail(std::uint32_t(number * hdl32e.packetPeriod_ns() / 1000 % stampPeriod_us));
    write(socket, port, packet.bytes().data(), packet.bytes().size());
}

double now() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

} // namespace

int main(int argc, char **argv) {
    if (argc < 5) {
        std::fprintf(stderr, "packet_sender PORT RATE_HZ SECONDS FIRST_NUMBER [POSITION_PORT]\n");
        return 2;
    }
    using Clock = std::chrono::steady_clock;
    const int port = std::atoi(argv[1]), positionPort = argc > 5 ? std::atoi(argv[5]) : 0;
    const double rate = std::atof(argv[2]);
    const long first = std::atol(argv[4]), count = long(rate * std::atof(argv[3]));
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    const std::array<std::uint8_t, positionPacketSize> position{};
    const Clock::time_point begin = Clock::now();
    long positions = 0;
    std::vector<double> times;
    times.reserve(std::size_t(count));
    std::signal(SIGTERM, [](int) { ended = 1; });
    for (long sent = 0; sent < count && !ended; ++sent) {
        std::this_thread::sleep_until(begin + std::chrono::duration_cast<Clock::duration>(
                                                  std::chrono::duration<double>(double(sent) / rate)));
        times.push_back(now());
        sendPacket(socket, port, first + sent);
        if (positionPort != 0 && sent % 14 == 13) {
            write(socket, positionPort, position.data(), position.size());
            ++positions;
        }
    }
    if (ended)
        for (const double time : times)
            std::printf("%.6f\n", time);
    else
        std::printf("%ld %ld %.3f\n", count, positions,
                    std::chrono::duration<double>(Clock::now() - begin).count());
    return 0;
}
